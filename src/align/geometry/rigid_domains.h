// rigid_domains.h: parts of a molecule that move as rigid bodies: its chains, domains found by a search, or residues
// that the user names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/molecule/rigid_domain.h"
#include "base/types.h"

namespace espdiff {

/// The texts without rigid domains: the superposition of the whole; a motion of its own for each residue (see
/// local_motions.h); and that only where the mapping slips otherwise (see choose_motions.h).
constexpr const char* kNoDomains = "none";
constexpr const char* kLocalMotions = "local";
constexpr const char* kLocalAsNeeded = "as-needed";

/// @throws InputError unless the text is `none`, `local`, `as-needed`, `chains`, `auto`, or ranges of residues: domains
/// separated by `/`, each of ranges CHAIN:FIRST-LAST separated by commas, such as 1-29,68-117/30-67. A chain applies to
/// the ranges after it and may be omitted.
void check_domains(const std::string& text);

/// The domains of the source that `text` asks for, with their motions. A domain with fewer than three paired atoms is
/// skipped if it is a chain, and an error if it was named.
///
/// The search (`auto`) grows short stretches of the sequence by all residues that the same rigid motion takes to within
/// 2 A of their partners, takes the largest domain, and repeats with the rest, down to 20 residues. Remaining residues
/// then join the domain whose motion fits them best. Runs shorter than 5 residues join the domain on both sides of
/// them.
/// @param pairs   the atom pairs used to fit motions
/// `local` and `as-needed` have no domains, as `none`.
/// @throws InputError as check_domains(), and if a named range has no residue or a residue is named twice
std::vector<RigidDomain> find_domains(const std::string& text, const Molecule& source, const Molecule& target,
                                      const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

/// Residues as ranges that check_domains() accepts: "A:1-29,68-117".
std::string residue_ranges(const Molecule& molecule, const std::vector<std::size_t>& residues);

}  // namespace espdiff
