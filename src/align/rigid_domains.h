// rigid_domains.h: parts of a molecule that move as rigid bodies: its chains, domains found by a search, or residues
// that the user names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "align/pair_atoms.h"

namespace espdiff {

/// Residues of the source that go to the target by one rigid motion.
struct RigidDomain {
  std::vector<std::size_t> residues;  ///< source residues, ascending
  RigidTransform motion;              ///< source -> target, each in its own frame
  std::size_t n_atoms = 0;            ///< pairs that the motion was fitted to
  double rmsd_A = 0;                  ///< of these, after the motion
};

/// @throws InputError unless the text is `none`, `chains`, `domains`, or ranges of residues: domains separated by `/`,
/// each of ranges CHAIN:FIRST-LAST separated by commas, such as 1-29,68-117/30-67; a chain holds for the ranges after
/// it and may be left out
void check_domains(const std::string& text);

/// The domains of the source that `text` asks for, with their motions. A domain that fewer than three atoms pair in is
/// left out where it is a chain, and an error where it was named.
///
/// Domains: from short stretches of the sequence, each grown by whatever residue the same rigid motion takes to within
/// 2 A of its counterpart, the largest is taken, and so on with what is left, down to 20 residues. What is in none then
/// joins the domain whose motion suits it best, and runs shorter than 5 residues the domain on both sides of them.
/// @param pairs   the atom pairs that motions are fitted to
/// @throws InputError as check_domains(), and where a named range has no residue or a residue is named twice
std::vector<RigidDomain> find_domains(const std::string& text, const Molecule& source, const Molecule& target,
                                      const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

/// Residues as ranges that check_domains() accepts: "A:1-29,68-117".
std::string residue_ranges(const Molecule& molecule, const std::vector<std::size_t>& residues);

}  // namespace espdiff
