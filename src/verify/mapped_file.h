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

class GaussianAtoms;

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

/// Areas, metrics (trusted, all), the trusted shares, the quantiles of slip, distortion and irregularity.
void add_mapped_lines(const MappedFile& file, const ResultRecord& record, Lines& lines);

/// The residue table against the vertices, and the correlation of its columns.
void add_residue_lines(const MappedFile& file, const ResultRecord& record, const CsvTable& table, Lines& lines);

/// Where the result is trusted, by reasons found again.
/// @param partner_of by source residue; empty where the atoms were not read
void add_trust_lines(const MappedFile& file, const CsvTable& table,
                     const std::map<std::int32_t, std::int32_t>& partner_of, Lines& lines);
/// The causes against OUT.causes.csv, where there are any.
void add_cause_lines(const std::string& prefix, const ResultRecord& record, Lines& lines);

/// Counts, and arrays that follow from others.
void add_array_lines(const MappedFile& file, Lines& lines);
/// Units, label and version, which more than one file has.
void add_text_lines(const MappedFile& file, const ResultRecord& record, Lines& lines);
/// Normals against the gradients of the atoms' density.
void add_normal_lines(const MappedFile& file, const GaussianAtoms& source, const GaussianAtoms& target, Lines& lines);
/// Names and numbers of residues against those of the source.
void add_residue_name_lines(const MappedFile& file, const CsvTable& table, const std::vector<Residue>& residues,
                            Lines& lines);

}  // namespace espdiff
