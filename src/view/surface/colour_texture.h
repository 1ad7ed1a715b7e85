// colour_texture.h: the colours of a scale as a texture on the GPU.
#pragma once

#include <vtkNew.h>
#include <vtkTextureObject.h>

#include <vector>

#include "plot/colour_map.h"

class vtkOpenGLRenderWindow;
class vtkWindow;

namespace espdiff {

/// One row of colours, uploaded at the first drawing and after each change.
class ColourTexture {
 public:
  void set(std::vector<Rgb> colours);
  /// Binds it to its own texture unit.
  /// @throws DeviceError if the GPU refuses it
  void activate(vtkOpenGLRenderWindow* window);
  void deactivate() { texture_->Deactivate(); }
  int unit() { return texture_->GetTextureUnit(); }
  void release(vtkWindow* window) { texture_->ReleaseGraphicsResources(window); }

 private:
  std::vector<Rgb> colours_;
  bool changed_ = true;
  vtkNew<vtkTextureObject> texture_;
};

}  // namespace espdiff
