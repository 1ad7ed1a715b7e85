// display.cpp: tries the X server through libX11, loaded at run time so that nothing here links to it.
#include "view/display.h"

#include <cstdlib>

#include "system/shared_library.h"
#include "view/render_window.h"

namespace espdiff {
namespace {

constexpr const char* kRemedy = "put `xvfb-run -a` before the command (Debian: packages xvfb and xauth)";

/// The few Xlib functions needed; a Display is opaque here.
using OpenDisplay = void* (*)(const char*);
using CloseDisplay = int (*)(void*);
using QueryExtension = int (*)(void*, const char*, int*, int*, int*);

}  // namespace

std::string display_problem() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') {
    return std::string("drawing needs an X display and DISPLAY is not set; ") + kRemedy;
  }
  // Never closed: VTK keeps it loaded anyway, and Xlib leaves handlers that point into it.
  void* library = load_library("libX11.so.6", LibraryUse::kGlobal);
  if (library == nullptr) return "drawing needs libX11.so.6, which cannot be loaded; install it (Debian: libx11-6)";
  const auto open_display = find_function<OpenDisplay>(library, "XOpenDisplay");
  const auto close_display = find_function<CloseDisplay>(library, "XCloseDisplay");
  const auto query_extension = find_function<QueryExtension>(library, "XQueryExtension");
  if (open_display == nullptr || close_display == nullptr || query_extension == nullptr) {
    return "drawing needs libX11.so.6, and the one found lacks XOpenDisplay; install the system's (Debian: libx11-6)";
  }
  void* display = open_display(nullptr);
  if (display == nullptr) {
    return std::string("the X display '") + name + "' (DISPLAY) cannot be opened; " + kRemedy;
  }
  int opcode = 0, first_event = 0, first_error = 0;
  const bool has_glx = query_extension(display, "GLX", &opcode, &first_event, &first_error) != 0;
  // An X server restarts when its last client leaves and refuses connections meanwhile, on which VTK calls abort(). So
  // the first successful connection stays open until the process ends.
  static std::string held_name;
  if (has_glx && held_name != name) {
    held_name = name;
  } else {
    close_display(display);
  }
  if (!has_glx) return std::string("the X display '") + name + "' (DISPLAY) offers no OpenGL (GLX); " + kRemedy;
  return {};
}

std::string drawing_problem() {
  const std::string problem = display_problem();
  return problem.empty() || can_draw_without_display() ? std::string() : problem;
}

}  // namespace espdiff
