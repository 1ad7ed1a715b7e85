// surface_scene.h: turns a surface into VTK actors and places them, with their legend, in the views of one window.
#pragma once

#include <string>

#include "view/colour_scale.h"
#include "view/render_surface.h"
#include "view/surface_file.h"

class vtkRenderWindow;

namespace espdiff {

/// Adds renderers to an empty window of the size that is drawn: one for each view, and one above them for the legend.
/// @param scale_factor pixels of the window per pixel of the final picture
void add_surface_scene(vtkRenderWindow* window, const SurfaceFile& surface, const ColourScale& scale,
                       const RenderOptions& options, const std::string& unit, double scale_factor);

}  // namespace espdiff
