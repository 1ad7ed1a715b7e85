// mapped_file.h: the mapped surface of OUT.vtp, and what follows from it and OUT.residues.csv alone.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/files/read_csv.h"
#include "io/vtk/read_vtp.h"
#include "verify/lines.h"

namespace espdiff {

/// Of the array `why`: 0 for trusted, and the reasons.
constexpr int kNumberOfReasons = 9;

/// OUT.vtp with the arrays that a comparison writes.
struct MappedFile {
  std::vector<Vec3d> positions, source_positions;  ///< [vertex]
  std::vector<Triangle> triangles;
  std::vector<double> displacement, path_length, slip;     ///< [vertex]; slip is NaN where it is unknown
  std::vector<double> residue;                             ///< [vertex] index, -1 for none
  std::vector<double> potential_source, potential_target;  ///< [vertex]; empty without potentials
  std::vector<double> potential_difference, sign_change;   ///< [vertex]; empty without potentials
  std::vector<double> residue_number;                      ///< [vertex]
  std::vector<Vec3d> normals, source_normals;              ///< [vertex]
  std::vector<double> target_residue;                      ///< [vertex] index where it is mapped to, -1 for none
  std::vector<bool> is_matched, is_valid;                  ///< [triangle] matched; and not corrupt
  std::vector<double> why;                                 ///< [triangle] 0 where it is trusted
  std::vector<double> turned;                              ///< [vertex] 1 on a side chain that turned, 2 on a residue
  std::vector<bool> is_trusted;                            ///< [triangle]
  std::vector<std::pair<std::string, std::string>> texts;  ///< of the whole file: name, text
  std::vector<std::string> array_names;                    ///< all, also of arrays that are not known here

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

/// The column that begins with this name, whatever its unit; -1 if there is none.
int column(const CsvTable& table, const std::string& name);

/// The value below which this share of the weight lies; NaN without weight.
double weighted_quantile(std::vector<std::pair<double, double>> weighted, double share);

}  // namespace espdiff
