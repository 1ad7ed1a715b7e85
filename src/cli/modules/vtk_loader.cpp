// vtk_loader.cpp: the program's side of its module with VTK: loads it at the first call, and passes calls on.
#include "base/error.h"
#include "cli/modules/load_module.h"
#include "cli/modules/vtk_functions.h"
#include "view/display.h"
#include "view/render_surface.h"
#include "view/window/viewer.h"

namespace espdiff {
namespace {

/// Null where it cannot be loaded.
const VtkFunctions* vtk_functions(std::string& problem) {
  const ProgramModule module = {
      "espdiff_vtk.so", "VTK, for pictures and `verify`",
      "the libraries of VTK 9 that it was built with (Debian: libvtk9.1 or libvtk9.3, or apt install -f)"};
  return static_cast<const VtkFunctions*>(load_module(module, problem));
}

/// @throws DeviceError
const VtkFunctions& required_vtk() {
  std::string problem;
  const VtkFunctions* const functions = vtk_functions(problem);
  if (functions == nullptr) throw DeviceError(problem);
  return *functions;
}

}  // namespace

std::string drawing_problem() {
  std::string problem;
  const VtkFunctions* const functions = vtk_functions(problem);
  return functions == nullptr ? problem : functions->drawing_problem();
}

std::vector<std::string> render_surface(const std::string& vtp_path, const std::string& png_path, const Scene& scene,
                                        AtomicFile* beside) {
  return required_vtk().render_surface(CancelRequest(), vtp_path, png_path, scene, beside);
}

void run_viewer(const std::string& vtp_path, const Scene& scene, const std::string& saved_prefix) {
  required_vtk().run_viewer(CancelRequest(), vtp_path, scene, saved_prefix);
}

Verification verify(const std::string& prefix) { return required_vtk().verify(CancelRequest(), prefix); }

}  // namespace espdiff
