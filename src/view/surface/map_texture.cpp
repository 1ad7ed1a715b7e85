// map_texture.cpp: uploads a map as a three-dimensional texture of floats.
#include "view/surface/map_texture.h"

#include <vtkOpenGLRenderWindow.h>

#include <algorithm>
#include <string>

#include "base/error.h"

namespace espdiff {

void MapTexture::upload(vtkOpenGLRenderWindow* window) {
  texture_->SetContext(window);
  texture_->SetMinificationFilter(vtkTextureObject::Linear);
  texture_->SetMagnificationFilter(vtkTextureObject::Linear);
  // Repeating, VTK's default, costs a software renderer more than the lookup.
  texture_->SetWrapS(vtkTextureObject::ClampToEdge);
  texture_->SetWrapT(vtkTextureObject::ClampToEdge);
  texture_->SetWrapR(vtkTextureObject::ClampToEdge);
  float nothing = 0;
  std::array<int, 3> size{1, 1, 1};
  if (map_ != nullptr) size = map_->lattice.size;
  const int largest = *std::max_element(size.begin(), size.end());
  const int limit = vtkTextureObject::GetMaximumTextureSize3D(window);
  if (limit > 0 && largest > limit) {
    throw DeviceError(map_->name + ": the map has " + std::to_string(largest) + " points along an axis, and this " +
                      "graphics processor takes " + std::to_string(limit) + "; draw with " + switched_on("per-vertex"));
  }
  // VTK's upload functions take pointers that are not const.
  void* values = map_ != nullptr ? const_cast<float*>(map_->values.data()) : &nothing;
  const bool done = texture_->Create3DFromRaw(static_cast<unsigned>(size[0]), static_cast<unsigned>(size[1]),
                                              static_cast<unsigned>(size[2]), 1, VTK_FLOAT, values);
  if (!done)
    throw DeviceError("a map could not be uploaded to the graphics processor; draw with " + switched_on("per-vertex"));
}

void MapTexture::activate(vtkOpenGLRenderWindow* window) {
  if (texture_->GetHandle() == 0 || texture_->GetContext() != window) upload(window);
  texture_->Activate();
}

}  // namespace espdiff
