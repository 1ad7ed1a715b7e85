// secondary_structure.h: helices and strands of a protein from its backbone's hydrogen bonds.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace espdiff {

enum class Fold : std::uint8_t { kCoil, kHelix, kStrand };

/// Indices of a residue's backbone atoms in the molecule; -1 if absent.
struct Backbone {
  int n = -1, ca = -1, c = -1, o = -1;

  bool complete() const { return n >= 0 && ca >= 0 && c >= 0 && o >= 0; }
};

/// [residue]
std::vector<Backbone> backbone_of(const Molecule& molecule);

/// Whether a residue's C is bound to the next one's N: within 2 A; for C-alphas alone, within 4.2 A.
bool are_bound(const Molecule& molecule, const Backbone& residue, const Backbone& next);

/// [residue] fold by hydrogen bonds between backbones, with an electrostatic energy below -0.5 kcal/mol: alpha helices
/// (two consecutive 4-turns) and strands (parallel and antiparallel bridges in ladders of two or more). W. Kabsch and
/// C. Sander, Biopolymers 22, 2577 (1983). Other turns, isolated bridges, and residues without a complete backbone are
/// coil. Cost: quadratic in the residues, for pairs with C-alphas within 9 A; below 0.1 s for 2000.
std::vector<Fold> assign_folds(const Molecule& molecule, const std::vector<Backbone>& backbone);

}  // namespace espdiff
