// map_texture.h: a potential map as a texture on the GPU.
#pragma once

#include <vtkNew.h>
#include <vtkTextureObject.h>

#include <memory>

#include "base/types.h"

class vtkOpenGLRenderWindow;
class vtkWindow;

namespace espdiff {

/// One map, uploaded at the first drawing; all mappers of a window share it.
class MapTexture {
 public:
  /// @param map nullptr: a texture of one voxel, for shaders without lookups that must have one bound
  explicit MapTexture(std::shared_ptr<const Grid> map) : map_(std::move(map)) {}

  const Grid* map() const { return map_.get(); }
  /// Uploads the map if needed and binds it to its own texture unit.
  /// @throws DeviceError if the map is larger than the GPU allows
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
