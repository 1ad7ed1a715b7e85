// render_window.cpp: chooses the kind of window.
#include "view/render_window.h"

#include <vtkRenderWindow.h>
#include <vtkVersionMacros.h>

#include <cstdlib>
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 4, 0)
#include <vtkOpenGLRenderWindow.h>
#define ESPDIFF_VTK_CHOOSES  // among X, EGL and OSMesa, when the program runs
#elif __has_include(<vtkEGLRenderWindow.h>)
#include <vtkEGLRenderWindow.h>
#elif __has_include(<vtkOSOpenGLRenderWindow.h>)
#include <vtkOSOpenGLRenderWindow.h>
#endif

#include "base/error.h"
#include "system/shared_library.h"
#include "system/this_process.h"
#include "view/display.h"
#include "view/vtk_messages.h"

namespace espdiff {
namespace {

#if defined(ESPDIFF_VTK_CHOOSES)
/// VTK's window ends the program if it is missing.
bool has_osmesa() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    if (load_library(name, LibraryUse::kLazy) != nullptr) return true;
  }
  return false;
}
#endif

/// Null if neither this VTK nor this machine has EGL or OSMesa.
vtkSmartPointer<vtkRenderWindow> without_display() {
#if defined(ESPDIFF_VTK_CHOOSES)
  // By default VTK would first try X, with warnings. If EGL does not work it uses OSMesa.
  set_environment_default("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow");  // only one thread draws
  const VtkMessages messages;
  vtkSmartPointer<vtkRenderWindow> window = vtkSmartPointer<vtkOpenGLRenderWindow>::New();
  window->SetShowWindow(false);
  if (window->IsA("vtkOSOpenGLRenderWindow") != 0 && !has_osmesa()) return nullptr;
  return window->SupportsOpenGL() != 0 ? window : nullptr;
#elif __has_include(<vtkEGLRenderWindow.h>)
  return vtkSmartPointer<vtkEGLRenderWindow>::New();
#elif __has_include(<vtkOSOpenGLRenderWindow.h>)
  return vtkSmartPointer<vtkOSOpenGLRenderWindow>::New();
#else
  return nullptr;
#endif
}

}  // namespace

vtkSmartPointer<vtkRenderWindow> make_hidden_window() {
  const std::string problem = display_problem();
  vtkSmartPointer<vtkRenderWindow> window =
      problem.empty() ? vtkSmartPointer<vtkRenderWindow>::New() : without_display();
  if (window == nullptr) throw DeviceError(problem);
  window->SetShowWindow(false);
  window->SetUseOffScreenBuffers(true);
  window->SetDPI(72);
  return window;
}

bool can_draw_without_display() { return without_display() != nullptr; }

}  // namespace espdiff
