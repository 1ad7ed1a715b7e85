// vtk_module.cpp: the module with VTK: pictures, the viewer, `verify`.
#include "base/version.h"
#include "cli/modules/vtk_functions.h"
#include "view/display.h"
#include "view/render_surface.h"
#include "view/window/viewer.h"

extern "C" __attribute__((visibility("default"))) const void* espdiff_module() {
  using espdiff::CancelRequest;
  using espdiff::CancelScope;
  static constexpr espdiff::VtkFunctions kFunctions = {
      espdiff::kVersion, &espdiff::drawing_problem,
      [](const CancelRequest& request, const std::string& vtp_path, const std::string& png_path,
         const espdiff::Scene& scene, espdiff::AtomicFile* beside) {
        const CancelScope scope(request);
        return espdiff::render_surface(vtp_path, png_path, scene, beside);
      },
      [](const CancelRequest& request, const std::string& vtp_path, const espdiff::Scene& scene,
         const std::string& saved_prefix) {
        const CancelScope scope(request);
        espdiff::run_viewer(vtp_path, scene, saved_prefix);
      },
      [](const CancelRequest& request, const std::string& prefix) {
        const CancelScope scope(request);
        return espdiff::verify(prefix);
      }};
  return &kFunctions;
}
