// surface_file.h: reads the mapped surface that `espdiff compare` writes, as far as drawing needs it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"
#include "scene/colour_scale.h"

namespace espdiff {

/// A mapped surface: one entry per vertex; arrays that the file lacks are empty.
struct SurfaceFile {
  std::string path;
  std::vector<Vec3d> positions;         ///< mapped, in the target's frame, Angstrom
  std::vector<Vec3d> source_positions;  ///< in the source's own frame, Angstrom
  std::vector<Vec3f> normals;           ///< unit, outward, at the mapped positions
  std::vector<Vec3f> source_normals;    ///< the same at the source's, in its frame
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> untrusted;  ///< [triangle] matched and not trusted
  std::vector<std::uint8_t> why;        ///< [triangle] code of why it is not trusted; empty in older files
  std::vector<std::uint8_t> turned;     ///< [vertex] nonzero where it turned away from its atoms; empty in older files
  std::vector<std::uint8_t> unmatched;  ///< [triangle] 1: its mapped positions are meaningless
  std::vector<float> displacement;      ///< Angstrom
  std::vector<float> slip;              ///< Angstrom; NaN where it is not known; empty in files of older versions
  std::vector<float> potential_source, potential_target, potential_difference;  ///< NaN without a value
  /// Of an ensemble: [vertex] family-wise p; 0 where a vertex was not tested, which has no values either. Empty in
  /// files of pairs.
  std::vector<float> p_family_wise;
  double alpha = 0.05;                     ///< field data `alpha`
  std::string source_group, target_group;  ///< of an ensemble, whose means the potentials are
  std::vector<float> sign_change;          ///< NaN without a value
  std::vector<float> residue_index;        ///< of the source's residues; negative: none
  std::vector<float> residue_number;       ///< as numbered in the structure file
  std::string potential_unit;              ///< field data `potential_unit`
  std::string quantity = "potential";      ///< what the potentials are; of another field its label
  bool is_signed = true;                   ///< whether its sign means something
  std::string field;                       ///< that stands in the place of the potential; empty for the potential
  std::vector<std::string> fields;         ///< names of all that the file has
  std::string written_by;                  ///< field data `written_by`
  std::string array_names;                 ///< of the point arrays in the file, for messages

  bool is_matched(std::size_t triangle) const { return unmatched.empty() || unmatched[triangle] == 0; }
  bool is_untrusted(std::size_t triangle) const { return !untrusted.empty() && untrusted[triangle] != 0; }
  /// The values that colour the surface.
  /// @throws InputError if the file lacks them, listing the arrays it has
  const std::vector<float>& values(RenderArray array) const;
  /// What makes points uncertain: of an ensemble its p, otherwise the slip, or the displacement where no slip is known.
  const std::vector<float>& uncertainty() const;
};

/// Reads a VTK XML PolyData file (.vtp).
/// @param field whose values stand in the place of the potentials; empty for the potential, or for the only field of an
///        ensemble's file OUT.NAME.vtp
/// @throws InputError (no such field, with those there are)
/// @throws IoError (missing, a directory), FormatError (not a .vtp file, truncated, no triangles, none matched)
SurfaceFile read_surface_file(const std::string& path, const std::string& field = "");

}  // namespace espdiff
