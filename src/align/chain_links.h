// chain_links.h: which residue follows which in a chain, whatever the order of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "align/pair_residues.h"

namespace espdiff {

struct ChainLinks {
  std::vector<std::int32_t> next, previous;        ///< [residue] -1 for none
  std::vector<std::vector<std::size_t>> chains{};  ///< each residue once, along its chain; rings begin anywhere
};

/// Links residues by peptide and phosphodiester bonds (C-N, O3'-P) of up to 2 A, caps included. Ends of the polymer
/// that remain follow each other by number and insertion code within a chain of one name and kind; of several with one
/// number the nearest. So a link by number may span a gap, or what no chain spans. A number that falls begins another
/// chain. Neither the order of the residues nor that of their atoms matters. Time O(n log n).
ChainLinks chain_links(const ResidueView& view);

/// The atom that stands for a residue of a polymer: C-alpha or P; -1 for other residues, and where it is missing.
std::ptrdiff_t trace_atom(const ResidueView& view, std::size_t residue);

bool is_polymer(ResidueKind kind);

}  // namespace espdiff
