// exported_result.h: a comparison as other programs draw it: a coloured surface, and residues with one value each.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "plot/colour_map.h"
#include "report/records/pair_files.h"

namespace espdiff {

struct ExportOptions {
  std::string array;     ///< point array to colour by; empty: the difference, or the displacement
  std::string residues;  ///< column of OUT.residues.csv; empty: the mean absolute difference, or displacement
  double limit = 0;      ///< end of the colour scale of the surface; 0: automatic (automatic_limit())
  /// Prefixes of other comparisons, whose automatic limits of surface and residues count too: the widest are taken.
  std::vector<std::string> range_of;
  std::string colours = "red-blue";  ///< diverging_map()'s names
  std::string title;                 ///< empty: the names of both structures
  bool overwrite = true;             ///< whether files of these names may be replaced
};

/// A colour scale: `limit` is its end, and for signed values `-limit` its beginning, otherwise 0.
struct ExportScale {
  std::string name, label, unit;
  double limit = 1;
  bool is_signed = false;
  std::string colours;

  double low() const { return is_signed ? -limit : 0; }
  /// kNoValueColour for NaN.
  Rgb colour(double value) const;
};

struct ExportedResult {
  PairFiles files;
  std::string title;
  ExportScale scale;           ///< of the surface
  std::vector<double> values;  ///< [vertex]
  std::vector<Rgb> colours;    ///< [vertex]
  std::vector<Vec3d> source;   ///< [vertex] on the source, superposed on the target
  CountedTriangles triangles;
  ExportScale residue_scale;
  std::vector<double> residue_values;  ///< [row of OUT.residues.csv]
  /// Name and text of what a reader has to know: title, verdict, scale, units, frame, provenance. One line each.
  std::vector<std::pair<std::string, std::string>> notes;
};

/// @param prefix OUT
/// @throws as read_pair_files(); InputError (an array or column that the result lacks, with those there are; a colour
///         map of another name; a limit that is not positive, or one beside range_of; one of range_of has another unit,
///         or lacks the column)
ExportedResult read_exported_result(const std::string& prefix, const ExportOptions& options);

/// The source in the target's frame, as it was compared, with the residues' values on its atoms; NaN where a residue
/// has none.
struct ExportedMolecule {
  Molecule molecule;
  std::vector<double> values;  ///< [atom]
};
/// @throws InputError (the structure that was compared is gone or has changed)
ExportedMolecule read_exported_molecule(const ExportedResult& result);

}  // namespace espdiff
