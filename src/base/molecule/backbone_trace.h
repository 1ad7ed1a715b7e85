// backbone_trace.h: the course of a molecule's chains, for ribbons.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Residues with a C-alpha (nucleic acids: a phosphorus), in file order.
struct BackboneTrace {
  std::vector<std::size_t> chains;  ///< residues of each unbroken stretch
  std::vector<Vec3d> points;        ///< of these atoms, Angstrom
  std::vector<Vec3d> sides;         ///< unit vectors from C to O, in which a ribbon is wide; 0 where there is none
};

BackboneTrace backbone_trace(const Molecule& molecule);

/// The trace as text to two decimals, a stretch behind the other: "2: 1.00 2.00 3.00 0.00 0.00 1.00; ...".
std::string to_text(const BackboneTrace& trace);
/// The inverse of to_text(). @throws InputError
BackboneTrace parse_backbone_trace(const std::string& text);

}  // namespace espdiff
