// render_surface.h: a picture (PNG) of a mapped surface, drawn without a window on the screen.
#pragma once

#include <string>

#include "view/colour_scale.h"

namespace espdiff {

struct RenderOptions {
  RenderArray array = RenderArray::kDifference;
  double limit =
      0;  ///< end of the colour scale (potentials: both ends); 0 is automatic: 98th percentile of |value|, rounded up
  int width = 1800;   ///< pixels, 400 to 6000
  int height = 1100;  ///< pixels, 400 to 6000
  int n_views = 2;    ///< side by side, each turned on about the vertical by a full turn / n_views; 1 to 4
  std::string title;  ///< above the views; none when empty
  std::string unit;   ///< of the potential; the file's when empty
  OpacityScale opacity;
};

/// Draws the surface of an OUT.vtp that `espdiff compare` wrote: coloured by one array, fainter where the counterpart
/// is farther away, corrupt triangles and vertices without a value in grey, with colour bar, length bar and keys, on
/// white. The view is parallel, so that the length bar holds everywhere; the side with more colour is the front. The
/// PNG carries its provenance as text (Title, Software, Source, Description), and replaces `png_path` only when
/// complete.
/// @throws InputError (option out of range; array missing or without a value), IoError (file missing, output
/// unwritable),
///         FormatError (not a .vtp file), DeviceError (no X display to draw on; says how to get one)
/// Cost: about 2 s at the default size by software OpenGL. Same machine and OpenGL driver: same pixels.
void render_surface(const std::string& vtp_path, const std::string& png_path, const RenderOptions& options);

}  // namespace espdiff
