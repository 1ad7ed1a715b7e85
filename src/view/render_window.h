// render_window.h: a window to draw into that nobody sees, on whatever this build of VTK and this machine offer.
#pragma once

#include <vtkSmartPointer.h>

class vtkRenderWindow;

namespace espdiff {

/// With a display (DISPLAY): X and GLX. Without one: EGL (a graphics processor without a screen) or OSMesa (software),
/// where VTK has them: 9.4 and later by default, Debian's 9.1 not.
/// @throws DeviceError saying how to get a display
vtkSmartPointer<vtkRenderWindow> make_hidden_window();

}  // namespace espdiff
