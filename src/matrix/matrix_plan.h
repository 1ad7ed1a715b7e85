// matrix_plan.h: what a matrix is of: everything that its values depend on, and the names that results are written
// under.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "matrix/matrix.h"

namespace espdiff {

struct MatrixPlan {
  struct Item {
    std::string label, group;
    std::vector<InputFile> inputs;
  };

  std::string version;
  std::string device;                                         ///< the back end, whose last digits may differ
  std::vector<std::pair<std::string, std::string>> settings;  ///< every one by name
  std::string potential;                                      ///< how potentials came about; empty for none
  std::string potential_unit;                                 ///< empty for none
  std::vector<Item> variants;
};

/// @param potential in words: "maps", or "pme, grid 0.5, Ewald factor 0.25"; not counted where no variant has a map
/// @throws InputError (fewer than two variants, labels, too many)
MatrixPlan make_plan(const Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                     const std::string& potential);

nlohmann::ordered_json plan_json(const MatrixPlan& plan);
/// @throws nlohmann::json::exception when the text is something else
MatrixPlan parse_plan(const std::string& json);

/// What first makes the values of two plans differ, in words ("the setting grid-spacing is 0.8 there and 1 here");
/// empty when nothing does. Groups and the paths of files do not count: fingerprints do.
std::string plan_difference(const MatrixPlan& there, const MatrixPlan& here);

}  // namespace espdiff
