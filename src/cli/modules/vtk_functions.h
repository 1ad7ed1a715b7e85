// vtk_functions.h: what the program calls of its module with VTK.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "scene/scene.h"
#include "verify/verify.h"

namespace espdiff {

class AtomicFile;

/// The functions of the same names; the caller's request to cancel goes along, since the module has its own variables.
struct VtkFunctions {
  const char* version;
  std::string (*drawing_problem)();
  std::vector<std::string> (*render_surface)(const CancelRequest& request, const std::string& vtp_path,
                                             const std::string& png_path, const Scene& scene, AtomicFile* beside);
  void (*run_viewer)(const CancelRequest& request, const std::string& vtp_path, const Scene& scene,
                     const std::string& saved_prefix);
  Verification (*verify)(const CancelRequest& request, const std::string& prefix);
};

}  // namespace espdiff
