// pair_atoms.cpp: pairs atoms one to one if the order matches, otherwise by name within paired residues.
#include "align/pair_atoms.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "align/pair_residues.h"
#include "align/residue_names.h"
#include "base/error.h"
#include "base/molecule/residue_label.h"

namespace espdiff {
namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::size_t kMinPairs = 3;
constexpr std::size_t kMaxExamples = 4;

template <std::size_t Size>
bool is_one_of(const std::array<std::string_view, Size>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool same_residue(const Residue& a, const Residue& b) {
  return a.number == b.number && a.insertion_code == b.insertion_code && same_residue_name(a.name, b.name);
}

/// Whether both molecules list the same atoms in the same order; chain names may differ.
bool same_order(const Molecule& source, const Molecule& target) {
  if (source.size() != target.size() || source.residues.size() != target.residues.size()) return false;
  for (std::size_t r = 0; r < source.residues.size(); ++r) {
    if (!same_residue(source.residues[r], target.residues[r])) return false;
  }
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Atom &a = source.atoms[i], &b = target.atoms[i];
    if (a.residue != b.residue) return false;
    if (a.name != b.name && normalized_atom_name(a.name) != normalized_atom_name(b.name)) return false;
  }
  return true;
}

AtomPairing pair_in_order(const Molecule& source) {
  AtomPairing pairing;
  pairing.method = "same order";
  pairing.n_aligned_residues = source.residues.size();
  for (std::size_t i = 0; i < source.size(); ++i) pairing.pairs.emplace_back(i, i);
  return pairing;
}

/// Atoms that any two different residues share.
bool is_shared_by_all(const std::string& name, ResidueKind kind) {
  static constexpr std::array<std::string_view, 8> kProtein = {"N", "H", "CA", "HA", "C", "O", "OXT", "CB"};
  if (kind == ResidueKind::kAminoAcid) return is_one_of(kProtein, name);
  return name == "P" || name == "OP1" || name == "OP2" || name.find('\'') != std::string::npos;
}

/// A hydrogen's name without its number: HB for HB2. Other atoms keep their names.
std::string hydrogen_stem(const std::string& name) {
  const bool numbered = name.size() > 1 && name[0] == 'H' && name.back() >= '0' && name.back() <= '9';
  return numbered ? name.substr(0, name.size() - 1) : name;
}

/// Atoms of one residue by name. Atoms with the same name (alternate locations) are in file order.
using NamedAtoms = std::map<std::string, std::vector<std::size_t>>;

/// [stem] named atoms of a residue.
std::map<std::string, NamedAtoms> group_by_stem(const ResidueView& view, std::size_t residue) {
  std::map<std::string, NamedAtoms> groups;
  const char letter = residue_letter(view.molecule->residues[residue].name);
  for (const std::size_t i : view.atoms[residue]) {
    const std::string name = normalized_atom_name(view.molecule->atoms[i].name, letter);
    groups[hydrogen_stem(name)][name].push_back(i);
  }
  return groups;
}

void pair_firsts(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b, IndexPairs& pairs) {
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) pairs.emplace_back(a[k], b[k]);
}

/// Pairs atoms of one stem by name. Naming schemes may number the same atoms differently (CHARMM's HB1, HB2 are HB3,
/// HB2 elsewhere; its HT1, HT2, HT3 are H, H2, H3), so the remaining atoms pair in order if their counts agree.
void pair_stem(const NamedAtoms& source, const NamedAtoms& target, IndexPairs& pairs) {
  std::vector<const std::vector<std::size_t>*> source_left, target_left;
  for (const auto& [name, atoms] : source) {
    const auto same = target.find(name);
    if (same != target.end()) {
      pair_firsts(atoms, same->second, pairs);
    } else {
      source_left.push_back(&atoms);
    }
  }
  if (source.size() != target.size()) return;
  for (const auto& [name, atoms] : target) {
    if (source.find(name) == source.end()) target_left.push_back(&atoms);
  }
  for (std::size_t k = 0; k < source_left.size(); ++k) pair_firsts(*source_left[k], *target_left[k], pairs);
}

/// Pairs the atoms of two corresponding residues by name.
void pair_residue_atoms(const ResidueView& source, std::size_t a, const ResidueView& target, std::size_t b,
                        bool substituted, IndexPairs& pairs) {
  const auto source_groups = group_by_stem(source, a);
  const auto target_groups = group_by_stem(target, b);
  for (const auto& [stem, atoms] : source_groups) {
    const auto same = target_groups.find(stem);
    if (same == target_groups.end() || (substituted && !is_shared_by_all(stem, source.kinds[a]))) continue;
    pair_stem(atoms, same->second, pairs);
  }
}

std::string atom_label(const Molecule& molecule, std::size_t i) {
  const Atom& atom = molecule.atoms[i];
  return atom.name + " of " + residue_label(molecule.residues[static_cast<std::size_t>(atom.residue)]);
}

/// "source a.pqr: 80 atoms in 5 residues (such as ALA 1, GLY 2)".
std::string describe(const char* role, const Molecule& molecule) {
  std::string text = std::string(role) + " " + molecule.name + ": " + std::to_string(molecule.size()) + " atoms in " +
                     std::to_string(molecule.residues.size()) + " residues";
  for (std::size_t r = 0; r < std::min(kMaxExamples, molecule.residues.size()); ++r) {
    text += (r == 0 ? " (such as " : ", ") + residue_label(molecule.residues[r]);
  }
  return molecule.residues.empty() ? text : text + ")";
}

/// Examples of unpaired atoms in paired residues.
std::string unpaired_examples(const ResidueView& source, const ResidueView& target, const IndexPairs& residues) {
  std::string text;
  for (std::size_t k = 0; k < std::min(kMaxExamples, residues.size()); ++k) {
    const auto& [a, b] = residues[k];
    if (source.atoms[a].empty() || target.atoms[b].empty()) continue;
    text += (text.empty() ? "" : ", ") + atom_label(*source.molecule, source.atoms[a].front()) + " against " +
            atom_label(*target.molecule, target.atoms[b].front());
  }
  return text;
}

[[noreturn]] void report_no_match(const ResidueView& source, const ResidueView& target, const IndexPairs& residues,
                                  std::size_t n_pairs) {
  std::string text = "only " + std::to_string(n_pairs) + " atoms of the two molecules pair, at least 3 are needed; " +
                     describe("source", *source.molecule) + "; " + describe("target", *target.molecule) + "; ";
  if (residues.empty()) {
    text += "no residues pair";
  } else {
    text += std::to_string(residues.size()) + " residues pair, but hardly any of their atom names (" +
            unpaired_examples(source, target, residues) + ")";
  }
  throw InputError(text + "; give two states of one molecule, or compare them where they lie (" +
                   option("align", "none") + " and " + option("method", "deform") + ")");
}

bool is_backbone(const std::string& name, ResidueKind kind) {
  static constexpr std::array<std::string_view, 4> kProtein = {"N", "CA", "C", "O"};
  static constexpr std::array<std::string_view, 6> kNucleic = {"P", "O3'", "C3'", "C4'", "C5'", "O5'"};
  if (kind == ResidueKind::kAminoAcid) return is_one_of(kProtein, name);
  return kind == ResidueKind::kNucleotide && is_one_of(kNucleic, name);
}

IndexPairs selected(const AtomPairing& pairing, const ResidueView& source, AlignAtoms atoms) {
  if (atoms == AlignAtoms::kAll) return pairing.pairs;
  IndexPairs chosen;
  for (const auto& pair : pairing.pairs) {
    const Atom& atom = source.molecule->atoms[pair.first];
    const ResidueKind kind = source.kinds[static_cast<std::size_t>(atom.residue)];
    const std::string name = normalized_atom_name(atom.name);
    const bool is_c_alpha = kind == ResidueKind::kAminoAcid && name == "CA";
    if (atoms == AlignAtoms::kCAlpha ? is_c_alpha : is_backbone(name, kind)) chosen.push_back(pair);
  }
  return chosen;
}

}  // namespace

AlignAtoms parse_align_atoms(const std::string& text) {
  for (const AlignAtoms atoms : {AlignAtoms::kAll, AlignAtoms::kBackbone, AlignAtoms::kCAlpha, AlignAtoms::kNone}) {
    if (text == to_string(atoms)) return atoms;
  }
  throw InputError("unknown choice of atoms to align '" + text + "'; use all, backbone, ca or none");
}

std::string to_string(AlignAtoms atoms) {
  switch (atoms) {
    case AlignAtoms::kAll: return "all";
    case AlignAtoms::kBackbone: return "backbone";
    case AlignAtoms::kCAlpha: return "ca";
    case AlignAtoms::kNone: break;
  }
  return "none";
}

AtomPairing pair_atoms(const Molecule& source, const Molecule& target, PairOthers others) {
  const bool in_order = source.size() >= kMinPairs && same_order(source, target);
  if (in_order && others == PairOthers::kByNumber) return pair_in_order(source);
  const ResidueView source_view(source), target_view(target);
  if (in_order && order_holds(source_view, target_view)) return pair_in_order(source);
  ResiduePairing by_residues = pair_residues(source_view, target_view, others);
  const IndexPairs& residues = by_residues.pairs;
  AtomPairing pairing;
  pairing.method = by_residues.by_names ? "names of residues" : "sequence alignment";
  pairing.moved = std::move(by_residues.moved);
  pairing.exchanged_chains = std::move(by_residues.exchanged_chains);
  pairing.n_aligned_residues = residues.size();
  for (const auto& [a, b] : residues) {
    const bool substituted = !same_residue_name(source.residues[a].name, target.residues[b].name);
    pairing.n_substituted_residues += substituted ? 1 : 0;
    pair_residue_atoms(source_view, a, target_view, b, substituted, pairing.pairs);
  }
  if (pairing.pairs.size() < kMinPairs) report_no_match(source_view, target_view, residues, pairing.pairs.size());
  std::sort(pairing.pairs.begin(), pairing.pairs.end());
  return pairing;
}

IndexPairs select_pairs(const AtomPairing& pairing, const Molecule& source, AlignAtoms atoms) {
  if (atoms == AlignAtoms::kNone) return {};
  const ResidueView view(source);
  IndexPairs chosen = selected(pairing, view, atoms);
  if (chosen.size() >= kMinPairs) return chosen;
  Message remedies;
  for (const AlignAtoms other : {AlignAtoms::kAll, AlignAtoms::kBackbone, AlignAtoms::kCAlpha}) {
    const std::size_t n = selected(pairing, view, other).size();
    if (n >= kMinPairs) remedies += option("align", to_string(other)) + " (" + std::to_string(n) + " pairs), ";
  }
  throw InputError(option("align", to_string(atoms)) + " selects " + std::to_string(chosen.size()) + " of " +
                   std::to_string(pairing.pairs.size()) + " paired atoms, at least 3 are needed; use " + remedies +
                   "or " + option("align", "none"));
}

}  // namespace espdiff
