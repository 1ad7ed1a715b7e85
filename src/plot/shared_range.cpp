// shared_range.cpp: one scale for the pictures of a study.
#include "plot/shared_range.h"

#include <algorithm>

#include "base/error.h"
#include "io/vtk/read_vtp.h"

namespace espdiff {
namespace {

std::string potential_unit_of(const VtpContent& surface) {
  for (const auto& [name, text] : surface.texts) {
    if (name == "potential_unit") return text;
  }
  return "";
}

}  // namespace

std::map<std::string, double> shared_limits(const std::vector<std::string>& surfaces, double percentile) {
  std::map<std::string, double> limits;
  std::string first_unit;
  for (const std::string& path : surfaces) {
    const VtpContent surface = read_vtp(path);
    const std::string unit = potential_unit_of(surface);
    if (path == surfaces.front()) first_unit = unit;
    if (unit != first_unit)
      throw InputError(path + ": potentials in '" + unit + "', and those of " + surfaces.front() + " in '" +
                       first_unit + "'; results that share a scale have one unit");
    for (const VtpNumbers& array : surface.point_arrays) {
      if (array.n_components != 1) continue;
      double& limit = limits[array.name];
      limit = std::max(limit, automatic_limit({array.values.begin(), array.values.end()}, percentile));
    }
  }
  return limits;
}

}  // namespace espdiff
