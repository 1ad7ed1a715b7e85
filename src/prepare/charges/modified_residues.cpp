// modified_residues.cpp: what stands for modified residues in PDB2PQR's file, and takes its place again afterwards.
#include "prepare/charges/modified_residues.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "align/protonation.h"
#include "align/residue_names.h"
#include "io/molecules/select_atoms.h"
#include "prepare/charges/caps.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/preparation.h"

namespace espdiff {
namespace {

/// Amino acids with a phosphate: the residue without it, and the atom that it is bound to.
struct Phosphorylated {
  std::string_view name, parent, oxygen, carbon;
};

constexpr Phosphorylated kPhosphorylated[] = {
    {"SEP", "SER", "OG", "CB"}, {"TPO", "THR", "OG1", "CB"}, {"PTR", "TYR", "OH", "CZ"}};

/// CHARMM's phosphoserine of two charges (SEP of PDB2PQR's CHARMM.DAT).
constexpr float kEsterOxygen = -0.401F, kPhosphorus = 1.099F, kPhosphateOxygen = -0.901F;
constexpr float kEsterOxygenRadius_A = 1.77F, kPhosphorusRadius_A = 2.15F, kPhosphateOxygenRadius_A = 1.70F;
constexpr float kPhosphateCharge = -2;

const Phosphorylated* phosphorylated(const std::string& name) {
  for (const Phosphorylated& row : kPhosphorylated) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

bool is_phosphate_atom(const Atom& atom) {
  return atom.name == "P" || (atom.name.size() == 3 && atom.name[0] == 'O' && atom.name[2] == 'P');
}

bool is_proton(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

std::optional<std::size_t> atom_named(const Molecule& molecule, const std::vector<std::size_t>& atoms,
                                      std::string_view name) {
  for (const std::size_t i : atoms) {
    if (normalized_atom_name(molecule.atoms[i].name) == name) return i;
  }
  return std::nullopt;
}

std::vector<std::size_t> all_atoms(const Molecule& molecule) {
  std::vector<std::size_t> all(molecule.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

void replace_selenomethionine(Molecule& molecule, Preparation& preparation) {
  for (Residue& residue : molecule.residues) {
    if (residue.name != "MSE") continue;
    preparation.renamed.push_back(residue_in_words(residue) + " as MET");
    residue.name = "MET";
  }
  for (Atom& atom : molecule.atoms) {
    if (molecule.residues[static_cast<std::size_t>(atom.residue)].name != "MET") continue;
    atom.hetero = false;
    if (atom.name == "SE") {
      atom.name = "SD";
      atom.element = "S";
    }
  }
}

void rename_residue(Residue& residue, const std::string& name, Preparation& preparation) {
  if (residue.name == name) return;
  preparation.renamed.push_back(residue_in_words(residue) + " as " + name);
  residue.name = name;
}

/// Insight II, and the models that it made, name residues by their charges.
void name_charged_residues(Molecule& molecule, Preparation& preparation) {
  constexpr std::pair<std::string_view, const char*> kNames[] = {
      {"AR+", "ARG"}, {"LY+", "LYS"}, {"AS-", "ASP"}, {"GL-", "GLU"}};
  for (Residue& residue : molecule.residues) {
    for (const auto& [name, usual] : kNames) {
      if (residue.name == name) rename_residue(residue, usual, preparation);
    }
  }
}

/// CHARMM has one name for both sugars, as the PDB had; to residues without O2' of such a name PDB2PQR would add it.
/// Amber marks the ends of chains (G5, DC3), which PDB2PQR finds itself.
void name_nucleotides(Molecule& molecule, Preparation& preparation) {
  constexpr std::pair<std::string_view, const char*> kNames[] = {{"ADE", "A"}, {"CYT", "C"}, {"GUA", "G"},
                                                                 {"THY", "T"}, {"URA", "U"}, {"URI", "U"}};
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  for (std::size_t r = 0; r < atoms.size(); ++r) {
    std::string name = molecule.residues[r].name;
    if (name.size() > 1 && (name.back() == '5' || name.back() == '3') && residue_letter(name) != '?') name.pop_back();
    for (const auto& [charmm, usual] : kNames) {
      if (name == charmm && kinds[r] == ResidueKind::kNucleotide) name = usual;
    }
    if ((name == "A" || name == "C" || name == "G" || name == "T") && atom_named(molecule, atoms[r], "C1'") &&
        !atom_named(molecule, atoms[r], "O2'"))
      name.insert(0, "D");
    rename_residue(molecule.residues[r], name, preparation);
  }
}

/// A proton on a carboxyl group says that it is neutral. PDB2PQR takes it from residues of that name only.
void name_neutral_acids(Molecule& molecule, Preparation& preparation) {
  constexpr double kHydroxyl_A = 1.3;
  const auto atoms = atoms_of_residues(molecule);
  std::vector<bool> keep(molecule.size(), true);
  for (std::size_t r = 0; r < atoms.size(); ++r) {
    const bool is_asp = molecule.residues[r].name == "ASP";
    if (!is_asp && molecule.residues[r].name != "GLU") continue;
    for (const char* const oxygen : {is_asp ? "OD1" : "OE1", is_asp ? "OD2" : "OE2"}) {
      const std::optional<std::size_t> bound = atom_named(molecule, atoms[r], oxygen);
      for (const std::size_t i : atoms[r]) {
        if (!bound || !is_proton(molecule.atoms[i]) ||
            norm(molecule.positions[i] - molecule.positions[*bound]) > kHydroxyl_A)
          continue;
        keep[i] = false;
        rename_residue(molecule.residues[r], is_asp ? "ASH" : "GLH", preparation);
      }
    }
  }
  if (std::find(keep.begin(), keep.end(), false) != keep.end()) molecule = keep_atoms(molecule, keep);
}

/// GROMACS gives groups whose hydrogens are virtual sites their mass at places that are no atoms: MN1, MNZ2, MCB1.
void drop_mass_centres(Molecule& molecule, Preparation& preparation) {
  std::vector<bool> keep;
  std::string first;
  for (const Atom& atom : molecule.atoms) {
    const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
    keep.push_back(!atom.element.empty() || atom.name.size() < 3 || atom.name.front() != 'M' ||
                   !is_known_amino_acid(residue.name));
    if (!keep.back() && first.empty()) first = atom.name + " of " + residue_in_words(residue);
  }
  const auto n_dropped = std::count(keep.begin(), keep.end(), false);
  if (n_dropped == 0) return;
  molecule = keep_atoms(molecule, keep);
  preparation.notes.push_back(std::to_string(n_dropped) +
                              " mass centres of GROMACS, which are no atoms and have no charge, were left out (first " +
                              first + ")");
}

/// GROMACS names the oxygens at the end of a chain O1 and O2 (GROMOS, OPLS), or OC1 and OC2 (AMBER). Whatever the name,
/// a second oxygen at C is OXT.
void name_end_oxygens(Molecule& molecule) {
  constexpr double kBond_A = 1.5;
  constexpr std::pair<const char*, const char*> kNames[] = {{"O1", "O2"}, {"OC1", "OC2"}};
  const auto atoms = atoms_of_residues(molecule);
  for (std::size_t r = 0; r < atoms.size(); ++r) {
    if (!is_known_amino_acid(molecule.residues[r].name)) continue;
    if (atom_named(molecule, atoms[r], "O")) {
      const std::optional<std::size_t> c = atom_named(molecule, atoms[r], "C");
      for (const std::size_t i : atoms[r]) {
        if (c && molecule.atoms[i].element == "O" && normalized_atom_name(molecule.atoms[i].name) != "O" &&
            norm(molecule.positions[i] - molecule.positions[*c]) < kBond_A)
          molecule.atoms[i].name = "OXT";
      }
      continue;
    }
    for (const auto& [first, second] : kNames) {
      const auto o = atom_named(molecule, atoms[r], first), oxt = atom_named(molecule, atoms[r], second);
      if (!o || !oxt) continue;
      molecule.atoms[*o].name = "O";
      molecule.atoms[*oxt].name = "OXT";
    }
  }
}

/// Longer than a bond of phosphorus and oxygen, or of carbon and nitrogen.
constexpr double kChainBond_A = 1.8;

/// The atom of this name, of another residue, that is bound to an atom of this one.
std::optional<std::size_t> atom_bound_to(const Molecule& molecule, std::size_t end, const char* bound) {
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (molecule.atoms[i].residue != molecule.atoms[end].residue &&
        norm(molecule.positions[i] - molecule.positions[end]) <= kChainBond_A &&
        normalized_atom_name(molecule.atoms[i].name) == bound)
      return i;
  }
  return std::nullopt;
}

/// The same; both by name.
std::optional<std::size_t> bound_atom(const Molecule& molecule, std::size_t residue,
                                      const std::vector<std::vector<std::size_t>>& atoms, const char* own,
                                      const char* bound) {
  const std::optional<std::size_t> end = atom_named(molecule, atoms[residue], own);
  return end ? atom_bound_to(molecule, *end, bound) : std::nullopt;
}

std::vector<std::size_t> atoms_named(const Molecule& molecule, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (normalized_atom_name(molecule.atoms[i].name) == name) found.push_back(i);
  }
  return found;
}

bool is_bound(const Molecule& molecule, std::size_t atom, const std::vector<std::size_t>& others) {
  return std::any_of(others.begin(), others.end(), [&](std::size_t i) {
    return molecule.atoms[i].residue != molecule.atoms[atom].residue &&
           norm(molecule.positions[i] - molecule.positions[atom]) <= kChainBond_A;
  });
}

/// The phosphate of a chain's first nucleotide is dropped: no force field has it.
void drop_end_phosphates(Molecule& molecule, Preparation& preparation) {
  static const std::set<std::string_view> phosphate = {"P", "OP1", "OP2", "OP3", "O3P", "HOP2", "HOP3"};
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  const std::vector<std::size_t> phosphorus = atoms_named(molecule, "P"), oxygens = atoms_named(molecule, "O3'");
  std::vector<bool> keep(molecule.size(), true);
  std::string ends;
  for (const std::size_t p : phosphorus) {
    const auto r = static_cast<std::size_t>(molecule.atoms[p].residue);
    if (kinds[r] != ResidueKind::kNucleotide || is_bound(molecule, p, oxygens)) continue;
    const bool is_chain = std::any_of(oxygens.begin(), oxygens.end(), [&](std::size_t i) {
      return molecule.atoms[i].residue == molecule.atoms[p].residue && is_bound(molecule, i, phosphorus);
    });
    if (!is_chain) continue;  // a ligand such as AMP
    for (const std::size_t i : atoms[r]) keep[i] = phosphate.count(normalized_atom_name(molecule.atoms[i].name)) == 0;
    ends += (ends.empty() ? "" : ", ") + residue_in_words(molecule.residues[r]);
  }
  if (ends.empty()) return;
  molecule = keep_atoms(molecule, keep);
  preparation.warnings.push_back(
      "the phosphate at the 5' end was left out (-2 e), since no force field of PDB2PQR has it: " + ends);
}

struct Neighbours {
  std::vector<std::size_t> atoms;
  LostInChain lost;
};

/// The neighbours' atoms that stand in for the chain: C, CA and O before N, or N and CA behind C; O3' and C3' before P,
/// or P behind O3'.
Neighbours neighbours_of(const Molecule& molecule, std::size_t residue,
                         const std::vector<std::vector<std::size_t>>& atoms) {
  Neighbours cap;
  const std::optional<PeptideBackbone> backbone = peptide_backbone(molecule, residue, atoms);
  const auto add_neighbour = [&](const char* own, const char* bound, std::initializer_list<const char*> names) {
    const std::string_view end = own;
    const std::optional<std::size_t> other =
        backbone && (end == "N" || end == "C") ? atom_bound_to(molecule, end == "N" ? backbone->n : backbone->c, bound)
                                               : bound_atom(molecule, residue, atoms, own, bound);
    if (!other) return;
    ++cap.lost.n_hydrogens;
    if (end == "C" || end == "P") ++cap.lost.n_oxygens;
    const auto r = static_cast<std::size_t>(molecule.atoms[*other].residue);
    for (const char* name : names) {
      const std::optional<std::size_t> i = atom_named(molecule, atoms[r], name);
      if (i) cap.atoms.push_back(*i);
    }
  };
  add_neighbour("N", "C", {"C", "CA", "O"});
  add_neighbour("C", "N", {"N", "CA"});
  add_neighbour("P", "O3'", {"O3'", "C3'"});
  add_neighbour("O3'", "P", {"P"});
  return cap;
}

std::size_t nearest_of(const Molecule& molecule, std::size_t n_first, const Vec3d& place) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < n_first; ++i) {
    if (norm(molecule.positions[i] - place) < norm(molecule.positions[best] - place)) best = i;
  }
  return best;
}

/// Replaces the hydroxyl hydrogen of a residue that was prepared without its phosphate, which is given back.
void add_phosphate(Molecule& residue, const Molecule& before, const Phosphorylated& kind) {
  constexpr double kHydroxyl_A = 1.2;
  residue.residues.front().name = kind.name;
  const std::vector<std::size_t> own = all_atoms(residue);
  const std::optional<std::size_t> oxygen = atom_named(residue, own, kind.oxygen),
                                   carbon = atom_named(residue, own, kind.carbon);
  if (!oxygen || !carbon) return;
  float hydroxyl = residue.charges[*oxygen];
  std::vector<std::size_t> kept;
  for (const std::size_t i : own) {
    const bool is_hydroxyl =
        is_proton(residue.atoms[i]) && norm(residue.positions[i] - residue.positions[*oxygen]) < kHydroxyl_A;
    if (is_hydroxyl) hydroxyl += residue.charges[i];
    if (!is_hydroxyl) kept.push_back(i);
  }
  residue.charges[*oxygen] = kEsterOxygen;
  residue.radii[*oxygen] = kEsterOxygenRadius_A;
  residue.charges[*carbon] += hydroxyl + kPhosphateCharge - (kEsterOxygen + kPhosphorus + 3 * kPhosphateOxygen);
  residue = residue_alone(residue, 0, kept);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!is_phosphate_atom(before.atoms[i])) continue;
    const bool is_center = before.atoms[i].name == "P";
    residue.atoms.push_back(before.atoms[i]);
    residue.positions.push_back(before.positions[i]);
    residue.radii.push_back(is_center ? kPhosphorusRadius_A : kPhosphateOxygenRadius_A);
    residue.charges.push_back(is_center ? kPhosphorus : kPhosphateOxygen);
  }
}

/// What the net charge of a residue is beyond a whole number. AMBER's nucleotides at both ends of a chain have -0.3079
/// and -0.6921 e, together a whole number, so what stands in for one needs the same part.
double beyond_whole(const Molecule& residue) {
  double total = 0;
  for (const float charge : residue.charges) total += static_cast<double>(charge);
  return total - std::round(total);
}

/// A nucleotide of which a modified one has the ring: guanine or uracil, which have fewest atoms beside it to lose.
std::string parent_nucleotide(const Molecule& molecule, const std::vector<std::size_t>& atoms) {
  const std::string base = atom_named(molecule, atoms, "N9") ? "G" : "U";
  if (atom_named(molecule, atoms, "O2'")) return base;
  return base == "G" ? "DG" : "DC";
}

}  // namespace

Molecule residue_alone(const Molecule& molecule, std::size_t residue, const std::vector<std::size_t>& atoms) {
  Molecule one;
  one.name = molecule.name;
  one.residues = {molecule.residues[residue]};
  for (const std::size_t i : atoms) {
    one.atoms.push_back(molecule.atoms[i]);
    one.atoms.back().residue = 0;
    one.positions.push_back(molecule.positions[i]);
    one.radii.push_back(molecule.radii[i]);
    one.charges.push_back(molecule.charges.empty() ? 0 : molecule.charges[i]);
  }
  return one;
}

void append_residue(Molecule& all, const Molecule& one) {
  const auto residue = static_cast<std::int32_t>(all.residues.size());
  all.residues.push_back(one.residues.front());
  for (std::size_t i = 0; i < one.size(); ++i) {
    all.atoms.push_back(one.atoms[i]);
    all.atoms.back().residue = residue;
    all.positions.push_back(one.positions[i]);
    all.radii.push_back(one.radii[i]);
    all.charges.push_back(one.charges[i]);
  }
}

void rename_residues(Molecule& molecule, Preparation& preparation) {
  replace_selenomethionine(molecule, preparation);
  name_charged_residues(molecule, preparation);
  name_nucleotides(molecule, preparation);
  drop_mass_centres(molecule, preparation);
  name_neutral_acids(molecule, preparation);
  name_end_oxygens(molecule);
  name_caps(molecule, preparation);
  drop_end_phosphates(molecule, preparation);
}

bool is_known_amino_acid(const std::string& name) {
  static const std::set<std::string_view> modified = {"CSO", "CME", "OCS", "CSD", "PCA", "MLY", "M3L",
                                                      "KCX", "LLP", "HYP", "SEP", "TPO", "PTR", "TYS"};
  const char letter = residue_letter(name);
  return letter >= 'A' && letter <= 'Z' && modified.count(name) == 0;
}

std::vector<std::string> foreign_atoms(const Molecule& molecule, std::size_t residue,
                                       const std::vector<std::size_t>& atoms) {
  std::vector<std::string> foreign;
  if (!is_known_amino_acid(molecule.residues[residue].name)) return foreign;
  const char letter = residue_letter(molecule.residues[residue].name);
  std::set<std::string> own;
  for (const std::size_t i : atoms) {
    const Atom& atom = molecule.atoms[i];
    if (is_proton(atom)) continue;
    const std::string name = normalized_atom_name(atom.name, letter);
    if (!is_heavy_atom_of(letter, name)) {
      foreign.push_back(atom.name);
    } else if (name != "OXT") {
      own.insert(name);
    }
  }
  return own.size() == n_heavy_atoms_of(letter) ? foreign : std::vector<std::string>();
}

GroupSource amino_acid_source(const Molecule& molecule, std::size_t residue, const std::vector<std::size_t>& atoms,
                              bool ligands_auto) {
  constexpr std::size_t kFewestPlaced = 3, kPhosphateAtoms = 4;
  const std::string& name = molecule.residues[residue].name;
  const auto count_if = [&](const auto& is) {
    return static_cast<std::size_t>(std::count_if(atoms.begin(), atoms.end(), is));
  };
  const std::size_t n_placed = count_if([&](std::size_t i) {
    static const std::set<std::string_view> backbone = {"N", "CA", "C", "O", "CB"};
    return backbone.count(molecule.atoms[i].name) > 0;
  });
  if (n_placed < kFewestPlaced) return GroupSource::kTorn;
  if (is_known_amino_acid(name) && foreign_atoms(molecule, residue, atoms).empty()) return GroupSource::kNone;
  const std::size_t n_phosphate = count_if([&](std::size_t i) { return is_phosphate_atom(molecule.atoms[i]); });
  if (phosphorylated(name) != nullptr && n_phosphate == kPhosphateAtoms) return GroupSource::kPhosphate;
  return ligands_auto ? GroupSource::kModified : GroupSource::kNone;
}

GroupSource nucleotide_source(const Molecule& molecule, std::size_t residue,
                              const std::vector<std::vector<std::size_t>>& atoms, bool ligands_auto) {
  const auto is_of_sugar = [&](std::size_t i) {
    static const std::set<std::string> sugar = {"C1'", "C2'", "C3'", "C4'", "O4'", "C5'", "O5'", "O3'"};
    return sugar.count(normalized_atom_name(molecule.atoms[i].name)) > 0;
  };
  constexpr std::ptrdiff_t kFewestPlaced = 3;
  const bool is_known = residue_letter(molecule.residues[residue].name) != '?';
  if (is_known && std::count_if(atoms[residue].begin(), atoms[residue].end(), is_of_sugar) < kFewestPlaced)
    return GroupSource::kTorn;
  if (is_known || !ligands_auto) return GroupSource::kNone;
  return is_in_nucleic_chain(molecule, residue, atoms) ? GroupSource::kModified : GroupSource::kOpenBabel;
}

std::optional<PeptideBackbone> peptide_backbone(const Molecule& molecule, std::size_t residue,
                                                const std::vector<std::vector<std::size_t>>& atoms) {
  const std::vector<std::size_t>& own = atoms[residue];
  // One that is named as usual is found by its names.
  if (atom_named(molecule, own, "N") || atom_named(molecule, own, "C")) return std::nullopt;
  const auto first = [&](const char* element, const auto& is) -> std::optional<std::size_t> {
    const auto found = std::find_if(own.begin(), own.end(),
                                    [&](std::size_t i) { return molecule.atoms[i].element == element && is(i); });
    return found == own.end() ? std::nullopt : std::optional(*found);
  };
  const auto is_near = [&](std::size_t other) {
    return [&molecule, other](std::size_t i) {
      return i != other && norm(molecule.positions[i] - molecule.positions[other]) <= kChainBond_A;
    };
  };
  const auto n = first("N", [&](std::size_t i) { return atom_bound_to(molecule, i, "C").has_value(); });
  const auto c = first("C", [&](std::size_t i) { return atom_bound_to(molecule, i, "N").has_value(); });
  if (!n || !c) return std::nullopt;
  const auto ca = first("C", is_near(*n)), o = first("O", is_near(*c));
  return ca && o && *ca != *c ? std::optional(PeptideBackbone{*n, *ca, *c, *o}) : std::nullopt;
}

bool is_in_nucleic_chain(const Molecule& molecule, std::size_t residue,
                         const std::vector<std::vector<std::size_t>>& atoms) {
  return bound_atom(molecule, residue, atoms, "P", "O3'") || bound_atom(molecule, residue, atoms, "O3'", "P");
}

ChargedResidue charge_modified_residue(const Molecule& molecule, std::size_t residue,
                                       const std::vector<Component>& components, double ph, const Progress& progress) {
  const auto atoms = atoms_of_residues(molecule);
  std::vector<std::size_t> own;
  for (const std::size_t i : atoms[residue]) {
    if (!is_proton(molecule.atoms[i])) own.push_back(i);
  }
  const std::size_t n_own = own.size();
  std::vector<std::size_t> with_cap = own;
  const Neighbours cap = neighbours_of(molecule, residue, atoms);
  with_cap.insert(with_cap.end(), cap.atoms.begin(), cap.atoms.end());
  Molecule fragment = residue_alone(molecule, residue, with_cap);
  // The next phosphate would be one more charge: a methyl group stands in for it.
  for (std::size_t i = n_own; i < with_cap.size(); ++i) {
    if (fragment.atoms[i].element == "P") fragment.atoms[i].name = fragment.atoms[i].element = "C";
  }
  const std::optional<LigandBonds> bonds = bonds_by_definition(fragment, n_own, components);
  const ChargedLigand ligand = charge_by_open_babel(fragment, molecule, ph, bonds ? &*bonds : nullptr, progress);
  std::vector<std::size_t> kept;
  double sum = 0;
  for (std::size_t i = 0; i < ligand.molecule.size(); ++i) {
    const bool is_heavy = i < with_cap.size();
    if ((is_heavy ? i : nearest_of(ligand.molecule, with_cap.size(), ligand.molecule.positions[i])) >= n_own) continue;
    kept.push_back(i);
    sum += static_cast<double>(ligand.molecule.charges[i]);
  }
  ChargedResidue charged{residue_alone(ligand.molecule, 0, kept), static_cast<int>(std::lround(ligand.net_charge)),
                         bonds, cap.lost};
  for (float& q : charged.molecule.charges)
    q += static_cast<float>((charged.net_charge - sum) / static_cast<double>(kept.size()));
  return charged;
}

Molecule with_known_residues(const Molecule& molecule, const std::vector<GroupSource>& sources) {
  static const std::set<std::string_view> glycine = {"N", "CA", "C", "O", "OXT"};
  static const std::set<std::string_view> nucleotide = {"P",   "OP1", "OP2", "O5'", "C5'", "C4'", "O4'",
                                                        "C3'", "O3'", "C2'", "O2'", "C1'", "N1",  "C2",
                                                        "N3",  "C4",  "C5",  "C6",  "N7",  "C8",  "N9"};
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  Molecule known = molecule;
  std::vector<bool> keep(molecule.size(), true);
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] != GroupSource::kPhosphate && sources[r] != GroupSource::kModified) continue;
    const bool is_modified = sources[r] == GroupSource::kModified,
               is_base = kinds[r] == ResidueKind::kNucleotide ||
                         (kinds[r] == ResidueKind::kOther && is_in_nucleic_chain(molecule, r, atoms));
    const std::set<std::string_view>& parent = is_base ? nucleotide : glycine;
    known.residues[r].name = !is_modified ? std::string(phosphorylated(molecule.residues[r].name)->parent)
                             : is_base    ? parent_nucleotide(molecule, atoms[r])
                                          : "GLY";
    for (const std::size_t i : atoms[r]) {
      const Atom& atom = molecule.atoms[i];
      keep[i] = is_modified ? parent.count(normalized_atom_name(atom.name)) > 0
                            : !is_phosphate_atom(atom) && !is_proton(atom);
      known.atoms[i].hetero = false;
    }
    const std::optional<PeptideBackbone> backbone = peptide_backbone(molecule, r, atoms);
    if (!is_modified || is_base || !backbone) continue;
    for (const std::size_t i : atoms[r]) keep[i] = false;
    for (const auto& [i, name] :
         {std::pair(backbone->n, "N"), {backbone->ca, "CA"}, {backbone->c, "C"}, {backbone->o, "O"}}) {
      known.atoms[i].name = name;
      keep[i] = true;
    }
  }
  return std::find(keep.begin(), keep.end(), false) == keep.end() ? known : keep_atoms(known, keep);
}

void restore_residues(Molecule& prepared, const Molecule& before, const std::vector<GroupSource>& sources,
                      const Molecule& modified) {
  std::map<ResidueKey, std::size_t> of_before, of_modified;
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] == GroupSource::kPhosphate || sources[r] == GroupSource::kModified)
      of_before[key_of(before.residues[r])] = r;
  }
  if (of_before.empty()) return;
  for (std::size_t r = 0; r < modified.residues.size(); ++r) of_modified[key_of(modified.residues[r])] = r;
  const Molecule known = with_known_residues(before, sources);
  const auto atoms = atoms_of_residues(prepared), atoms_before = atoms_of_residues(before),
             atoms_modified = atoms_of_residues(modified);
  Molecule restored;
  restored.name = prepared.name;
  restored.radii_origin = prepared.radii_origin;
  restored.left_out = prepared.left_out;
  for (std::size_t r = 0; r < prepared.residues.size(); ++r) {
    Molecule one = residue_alone(prepared, r, atoms[r]);
    auto found = of_before.find(key_of(prepared.residues[r]));
    // Another molecule under the chain's name may have the number.
    if (found != of_before.end() && prepared.residues[r].name != known.residues[found->second].name)
      found = of_before.end();
    if (found != of_before.end() && sources[found->second] == GroupSource::kPhosphate) {
      const std::size_t b = found->second;
      add_phosphate(one, residue_alone(before, b, atoms_before[b]), *phosphorylated(before.residues[b].name));
    } else if (found != of_before.end()) {
      const std::size_t m = of_modified.at(found->first);
      const double part = beyond_whole(one);
      one = residue_alone(modified, m, atoms_modified[m]);
      for (float& charge : one.charges) charge += static_cast<float>(part / static_cast<double>(one.size()));
    }
    append_residue(restored, one);
  }
  prepared = std::move(restored);
}

}  // namespace espdiff
