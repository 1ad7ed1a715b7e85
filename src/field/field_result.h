// field_result.h: two states' values of a field at corresponding points, and what they differ by.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/molecule/quantity.h"
#include "base/types.h"
#include "engine/certificate_stage.h"

namespace espdiff {

/// Means of a quantity over a residue's trusted surface, weighted by area; NaN where it has none.
struct ResidueMeans {
  double area_A2 = 0;  ///< of trusted mapped surface with values
  double mean_abs_difference = 0;
  double mean_signed_difference = 0;  ///< target - source
  double mean_source = 0;
  double mean_target = 0;
  double sign_change_area_fraction = 0;
};

/// A file that a field's values come from.
struct FieldFile {
  std::string path, sha256;
};

/// What a field is, and where its values come from.
struct FieldDescription {
  Quantity quantity;
  std::string what;              ///< KIND or KIND:ARGUMENT
  std::string reference;         ///< of its values
  std::vector<FieldFile> files;  ///< that all states share
};

/// A field's part of a comparison's result.
struct FieldResult {
  Quantity quantity;
  std::string what;              ///< KIND or KIND:ARGUMENT
  std::string reference;         ///< of its values
  std::vector<FieldFile> files;  ///< empty for a region or patch
  Metrics metrics;               ///< over trusted triangles
  Metrics metrics_all;           ///< over all triangles with values
  /// Matched vertices without a value, which are left out.
  std::size_t n_missing_source = 0, n_missing_target = 0;
  std::vector<ResidueMeans> residues;  ///< [source residue]; empty for a region or patch
  std::vector<float> source, target;   ///< [vertex] NaN without a value; empty for a region or patch
};

/// @param weight  [vertex] from corner_areas(); vertices of weight 0 do not count
/// @param residue [vertex] -1 for none  @param source, target [vertex] finite where vertices count
std::vector<ResidueMeans> residue_means(const std::vector<double>& weight, const std::vector<std::int32_t>& residue,
                                        const std::vector<float>& source, const std::vector<float>& target,
                                        std::size_t n_residues);

}  // namespace espdiff
