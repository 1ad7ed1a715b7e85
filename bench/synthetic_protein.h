// synthetic_protein.h: generated molecules of any size with a protein's workload; fixed seeds.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/types.h"

namespace espdiff_bench {

/// A compact blob of atoms with the density, radii and rough outline of a protein.
///
/// - Number density 0.1 atoms/A^3, hydrogens included (a crystal structure with hydrogens has 0.1 to 0.12).
/// - Positions by random sequential addition with 1.6 A between centres, so that the inside has no large voids and the
///   surface no clumps. Bonded hydrogens of a real protein sit nearer (1.0 A); the surface does not see the difference.
/// - Outline: a ball whose radius is a sum of waves over the direction, long ones (lobes, clefts: 12 % of the radius)
///   and short ones of about 10 A along the surface (side chains: 1.5 A), scaled to hold n_atoms at that density.
/// - Radii after Bondi (1964) in the proportions of a protein: 50 % H 1.2, 32 % C 1.7, 9 % N 1.55, 9 % O 1.52 A.
/// - A residue is 16 consecutive atoms; charges alternate at random with mean 0.
/// The random numbers come from a fixed generator and do not depend on the standard library: the same atoms everywhere.
/// @param n_atoms at least 10
espdiff::Molecule synthetic_protein(std::size_t n_atoms, std::uint64_t seed = 1);

/// A copy of `molecule` with its atoms displaced by a smooth random field: 24 waves of 20 to 60 A, scaled to a root
/// mean square displacement of `rms_A`. Nearby atoms move alike, as in two conformations of one protein.
espdiff::Molecule displaced_smoothly(const espdiff::Molecule& molecule, double rms_A, std::uint64_t seed = 2);

/// A potential map of `n`^3 points over the molecule plus 6 A: a smooth wave of 1 kT/e, for timing only.
espdiff::Grid smooth_map(const espdiff::Molecule& molecule, int n = 97);

}  // namespace espdiff_bench
