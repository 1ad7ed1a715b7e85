// display.h: whether VTK can open a window here; VTK itself ends the process when it cannot.
#pragma once

#include <string>

namespace espdiff {

/// Asks the X server named by $DISPLAY for a connection and for GLX, as VTK is about to do.
/// @return why drawing is not possible, with the remedy; empty where it is. Cost: one connection,
/// which stays open: a server without clients, as Xvfb is between two pictures, would start over just when VTK
/// connects.
std::string display_problem();

/// Why a picture cannot be drawn here, by a window that nobody sees (render_window.h), with the remedy; empty where it
/// can, which may be without a display.
std::string drawing_problem();

}  // namespace espdiff
