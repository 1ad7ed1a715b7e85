// picture.h: the picture that a comparison draws besides its results, where its output is named OUT.png.
#pragma once

#include <string>

namespace espdiff::cli {

/// Whether a name asks for a picture: OUT.png.
bool is_picture(const std::string& path);

/// @throws InputError (this build has no renderer), DeviceError (nothing to draw on, with the remedy)
void require_drawing(const std::string& picture);

/// As `espdiff render PREFIX -o PICTURE`, of shapes alone by displacement; notes go to standard error.
/// @throws as render_surface()
void draw_result(const std::string& prefix, const std::string& picture, bool has_potential);

}  // namespace espdiff::cli
