// colour_texture.cpp: uploads a row of colours.
#include "view/surface/colour_texture.h"

#include <vtkOpenGLRenderWindow.h>

#include <cstdint>
#include <utility>

#include "base/error.h"

namespace espdiff {

void ColourTexture::set(std::vector<Rgb> colours) {
  colours_ = std::move(colours);
  changed_ = true;
}

void ColourTexture::activate(vtkOpenGLRenderWindow* window) {
  if (changed_ || texture_->GetHandle() == 0 || texture_->GetContext() != window) {
    std::vector<std::uint8_t> bytes;
    for (const Rgb c : colours_) bytes.insert(bytes.end(), {c.red, c.green, c.blue, 255});
    texture_->SetContext(window);
    texture_->SetMinificationFilter(vtkTextureObject::Nearest);
    texture_->SetMagnificationFilter(vtkTextureObject::Nearest);
    if (!texture_->Create2DFromRaw(static_cast<unsigned>(colours_.size()), 1, 4, VTK_UNSIGNED_CHAR, bytes.data()))
      throw DeviceError("the colours could not be uploaded to the graphics processor; `xvfb-run -a` draws in software");
    changed_ = false;
  }
  texture_->Activate();
}

}  // namespace espdiff
