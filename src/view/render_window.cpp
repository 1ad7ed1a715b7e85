// render_window.cpp: picks the kind of window.
#include "view/render_window.h"

#include <vtkRenderWindow.h>
#if __has_include(<vtkEGLRenderWindow.h>)
#include <vtkEGLRenderWindow.h>
#elif __has_include(<vtkOSOpenGLRenderWindow.h>)
#include <vtkOSOpenGLRenderWindow.h>
#endif

#include "base/error.h"
#include "view/display.h"

namespace espdiff {
namespace {

vtkSmartPointer<vtkRenderWindow> without_display() {
#if __has_include(<vtkEGLRenderWindow.h>)
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

}  // namespace espdiff
