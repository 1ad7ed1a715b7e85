// render_window.h: an off-screen window, by whatever this build of VTK and this machine offer.
#pragma once

#include <vtkSmartPointer.h>

class vtkRenderWindow;

namespace espdiff {

/// With a display (DISPLAY): X and GLX. Without one: EGL (a GPU without a screen) or OSMesa (software), if VTK supports
/// them: 9.4 and later by default, Debian's 9.1 does not.
/// @throws DeviceError saying how to get a display
vtkSmartPointer<vtkRenderWindow> make_hidden_window();

/// Whether EGL or OSMesa is there.
bool can_draw_without_display();

}  // namespace espdiff
