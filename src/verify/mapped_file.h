// mapped_file.h: the mapped surface of OUT.vtp, and what follows from it and OUT.residues.csv alone.
#pragma once

#include <string>
#include <vector>

#include "io/read_vtp.h"
#include "verify/lines.h"

namespace espdiff {

/// OUT.vtp with the arrays that a comparison writes.
struct MappedFile {
  std::vector<Vec3d> positions, source_positions;  ///< [vertex]
  std::vector<Triangle> triangles;
  std::vector<double> displacement, path_length, slip;     ///< [vertex]; slip is NaN where it is unknown
  std::vector<double> residue;                             ///< [vertex] index, -1 for none
  std::vector<double> potential_source, potential_target;  ///< [vertex]; empty without potentials
  std::vector<bool> is_matched, is_valid;                  ///< [triangle] matched; and not corrupt

  /// @throws FormatError (damage), InputError (an array of a comparison is missing)
  explicit MappedFile(const std::string& path);

  double area(std::size_t triangle) const;
  double source_area(std::size_t triangle) const;
  std::vector<Triangle> matched() const;
  /// [vertex] a third of the area of each of these triangles.
  std::vector<double> weights(const std::vector<bool>& counts) const;
  /// The triangles of these whose corners all have potentials.
  std::vector<bool> with_potentials(std::vector<bool> counts) const;
};

/// The value below which this share of the weight lies; NaN without weight.
double weighted_quantile(std::vector<std::pair<double, double>> weighted, double share);

/// Areas, metrics (valid, all, without slip), the quantiles of slip, distortion and irregularity.
void add_mapped_lines(const MappedFile& file, const ResultRecord& record, Lines& lines);

/// The residue table against the vertices, and the correlation of its columns.
/// @param path of OUT.residues.csv
void add_residue_lines(const MappedFile& file, const std::string& path, Lines& lines);

}  // namespace espdiff
