// display.h: whether VTK can open a window here; VTK itself ends the process when it cannot.
#pragma once

#include <string>

namespace espdiff {

/// Asks the X server named by $DISPLAY for a connection and for GLX, as VTK is about to do.
/// @return why drawing is not possible, with the remedy; empty where it is. Cost: one connection.
std::string display_problem();

}  // namespace espdiff
