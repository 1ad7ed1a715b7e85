// map_texture.h: a potential map as a texture in the memory of the graphics processor.
#pragma once

#include <vtkNew.h>
#include <vtkTextureObject.h>

#include <memory>

#include "base/types.h"

class vtkOpenGLRenderWindow;
class vtkWindow;

namespace espdiff {

/// One map, uploaded when it is first drawn; all mappers of a window share it.
class MapTexture {
 public:
  /// @param map nullptr: a texture of one voxel, for shaders that look nothing up but must have one bound
  explicit MapTexture(std::shared_ptr<const Grid> map) : map_(std::move(map)) {}

  const Grid* map() const { return map_.get(); }
  /// Uploads the map if it is not there yet, and binds it to a texture unit of its own.
  /// @throws DeviceError when the map is larger than the graphics processor takes
  void activate(vtkOpenGLRenderWindow* window);
  void deactivate() { texture_->Deactivate(); }
  int unit() { return texture_->GetTextureUnit(); }
  void release(vtkWindow* window) { texture_->ReleaseGraphicsResources(window); }

 private:
  void upload(vtkOpenGLRenderWindow* window);

  std::shared_ptr<const Grid> map_;
  vtkNew<vtkTextureObject> texture_;
};

}  // namespace espdiff
