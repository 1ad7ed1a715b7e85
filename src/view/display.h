// display.h: tests whether VTK can open a window; VTK itself ends the process if it cannot.
#pragma once

#include <string>

namespace espdiff {

/// Tries to connect to the X server named by $DISPLAY and to GLX, as VTK will.
/// @return why drawing is impossible, with the remedy; empty if it is possible. Cost: one connection, which stays open,
/// because a server without clients, such as Xvfb between two pictures, would restart just when VTK connects.
std::string display_problem();

/// Why a picture cannot be drawn here off screen (render_window.h), with the remedy; empty if it can, which may be
/// without a display.
std::string drawing_problem();

}  // namespace espdiff
