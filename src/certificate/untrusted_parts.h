// untrusted_parts.h: the parts of a surface that are not trusted, by name.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

struct MappedSurface;
struct Molecule;
struct ResidueRow;
struct SurfaceAreas;

/// The parts that are not trusted, by residues and secondary structure (assign_folds()), largest first: "loop GLY 47 to
/// SER 51 of chain A (230 A^2): slipped". At most six are named. @param rows the residues to look at
std::vector<std::string> untrusted_parts(const MappedSurface& surface, const SurfaceAreas& areas,
                                         const std::vector<ResidueRow>& rows, const Molecule& source);

}  // namespace espdiff
