// matrix_plan.h: everything that a matrix's values depend on, and the names in its results.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "field/field_result.h"
#include "matrix/matrix.h"

namespace espdiff {

struct MatrixPlan {
  struct Item {
    std::string label, group;
    std::vector<InputFile> inputs;
  };

  std::string version;
  std::string device;                                         ///< the back end; last digits may differ between them
  std::vector<std::pair<std::string, std::string>> settings;  ///< all settings by name
  std::string potential;                                      ///< origin of the potentials; empty for none
  std::string potential_unit;                                 ///< empty for none
  std::string radii_note;                                     ///< why all radii were replaced; may be empty
  std::vector<Item> variants;
  std::vector<FieldDescription> fields{};  ///< besides the potential

  /// Region and patches of the pairs, by the settings; see part_names(). @throws InputError (damaged settings)
  std::vector<std::string> parts() const;
  /// With the fields.
  PartsAndFields compared() const;
};

/// @param potential  description: "maps", or "pme, grid 0.5, Ewald factor 0.25"; ignored if no variant has a map
/// @param radii_note of set_surface_radii()
/// @throws InputError (fewer than two variants, labels, too many)
MatrixPlan make_plan(const Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                     const std::string& potential, const std::string& radii_note);

nlohmann::ordered_json plan_json(const MatrixPlan& plan);
/// @throws nlohmann::json::exception if the text is not a plan
MatrixPlan parse_plan(const std::string& json);

/// The first difference of two plans that changes the values ("the setting grid-spacing is 0.8 there and 1 here");
/// empty if there is none. Groups and file paths are ignored; SHA-256 values are compared.
std::string plan_difference(const MatrixPlan& there, const MatrixPlan& here);

}  // namespace espdiff
