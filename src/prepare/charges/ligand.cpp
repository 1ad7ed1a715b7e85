// ligand.cpp: matches residues with MOL2 files and components by atom names.
#include "prepare/charges/ligand.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "align/geometry/superpose.h"
#include "align/residue_names.h"
#include "base/error.h"
#include "base/formatted.h"
#include "io/molecules/molecule_builder.h"

namespace espdiff {
namespace {

bool describes(const Mol2File& ligand, const Molecule& molecule, const std::vector<std::size_t>& atoms) {
  return std::all_of(atoms.begin(), atoms.end(), [&](std::size_t i) {
    const Atom& atom = molecule.atoms[i];
    if (atom.element == "H" || atom.element == "D") return true;
    return std::any_of(ligand.atoms.begin(), ligand.atoms.end(),
                       [&](const Mol2Atom& other) { return other.name == atom.name; });
  });
}

/// The file's hydrogens that the residue lacks, at the residue.
std::vector<Mol2Atom> missing_hydrogens(const Mol2File& ligand, const Molecule& molecule,
                                        const std::vector<std::size_t>& atoms) {
  std::set<std::string> names;
  std::vector<Vec3d> of_file, of_residue;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::size_t i : atoms) {
    names.insert(molecule.atoms[i].name);
    for (const Mol2Atom& other : ligand.atoms) {
      if (other.name != molecule.atoms[i].name) continue;
      pairs.emplace_back(of_file.size(), of_residue.size());
      of_file.push_back(other.position);
      of_residue.push_back(molecule.positions[i]);
    }
  }
  std::vector<Mol2Atom> missing;
  for (const Mol2Atom& atom : ligand.atoms) {
    if (atom.element == "H" && names.count(atom.name) == 0) missing.push_back(atom);
  }
  if (missing.empty()) return missing;
  const RigidTransform to_residue = superpose(of_file, of_residue, pairs).transform;
  for (Mol2Atom& atom : missing) atom.position = to_residue.apply(atom.position);
  return missing;
}

/// Longer than a bond between carbon, nitrogen, oxygen and phosphorus; a carbonyl group's is shorter than the other.
constexpr double kLongestBond_A = 1.8, kLongestCarbonyl_A = 1.32;

/// Bonds of the atoms from n_own on, which are few.
void add_bonds_of_neighbours(const Molecule& fragment, std::size_t n_own, LigandBonds& known) {
  for (std::size_t b = n_own; b < fragment.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const double length = norm(fragment.positions[a] - fragment.positions[b]);
      if (length > kLongestBond_A) continue;
      const bool is_carbonyl = length <= kLongestCarbonyl_A && a >= n_own &&
                               (fragment.atoms[a].element == "O" || fragment.atoms[b].element == "O");
      known.bonds.push_back({a, b, is_carbonyl ? 2 : 1});
    }
  }
}

/// Whether just the atoms that are bound lie as near to each other as bound ones do. Names such as C1 of a ligand LIG
/// can be a component's by chance.
bool has_lengths_of_bonds(const Molecule& fragment, std::size_t n_own, const std::vector<ComponentBond>& bonds) {
  constexpr double kLongest_A = 2, kLongestOfLarge_A = 2.7, kNearest_A = 1.75;
  const auto is_small = [&](std::size_t i) {
    const std::string& element = fragment.atoms[i].element;
    return element == "C" || element == "N" || element == "O" || element == "F";
  };
  for (std::size_t b = 0; b < n_own; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const double length = norm(fragment.positions[a] - fragment.positions[b]);
      if (length > kLongestOfLarge_A) continue;
      const bool are_small = is_small(a) && is_small(b),
                 are_bound = std::any_of(bonds.begin(), bonds.end(), [&](const ComponentBond&bond) {
                   return std::minmax(bond.a, bond.b) == std::minmax(a, b);
                 });
      if (are_bound ? are_small && length > kLongest_A : are_small && length < kNearest_A) return false;
    }
  }
  return std::all_of(bonds.begin(), bonds.end(), [&](const ComponentBond& bond) {
    return norm(fragment.positions[bond.a] - fragment.positions[bond.b]) <= kLongestOfLarge_A;
  });
}

std::optional<LigandBonds> bonds_by(const Component& component, const Molecule& fragment, std::size_t n_own) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < component.atoms.size(); ++i)
    places.emplace(normalized_atom_name(component.atoms[i].name), i);
  constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
  std::vector<std::size_t> own(component.atoms.size(), kMissing);
  LigandBonds known;
  known.charges.assign(fragment.size(), 0);
  for (std::size_t i = 0; i < n_own; ++i) {
    const auto place = places.find(normalized_atom_name(fragment.atoms[i].name));
    if (place == places.end() || own[place->second] != kMissing) return std::nullopt;
    own[place->second] = i;
    known.charges[i] = component.atoms[place->second].charge;
  }
  for (const ComponentBond& bond : component.bonds) {
    const std::size_t a = own[bond.a], b = own[bond.b];
    if (a != kMissing && b != kMissing)
      known.bonds.push_back({a, b, bond.order});
    else if (bond.order != 1 && (a != kMissing || b != kMissing))
      return std::nullopt;
  }
  if (!has_lengths_of_bonds(fragment, n_own, known.bonds)) return std::nullopt;
  add_bonds_of_neighbours(fragment, n_own, known);
  return known;
}

}  // namespace

std::vector<Mol2File> read_ligands(const std::vector<std::string>& paths) {
  std::vector<Mol2File> ligands;
  for (const std::string& path : paths) {
    if (!is_component_path(path)) ligands.push_back(read_mol2(path));
  }
  return ligands;
}

std::vector<std::int32_t> ligands_of_residues(const Molecule& molecule, const std::vector<Mol2File>& ligands) {
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  std::vector<std::int32_t> ligand_of;
  for (std::size_t r = 0; r < atoms.size(); ++r) {
    const auto found = std::find_if(ligands.begin(), ligands.end(),
                                    [&](const Mol2File& ligand) { return describes(ligand, molecule, atoms[r]); });
    const bool is_other = kinds[r] == ResidueKind::kOther && !atoms[r].empty();
    ligand_of.push_back(is_other && found != ligands.end() ? static_cast<std::int32_t>(found - ligands.begin()) : -1);
  }
  return ligand_of;
}

Molecule add_ligand_hydrogens(const Molecule& molecule, const std::vector<Mol2File>& ligands,
                              const std::vector<std::int32_t>& ligand_of) {
  const auto atoms = atoms_of_residues(molecule);
  Molecule complete = molecule;
  for (std::size_t r = 0; r < ligand_of.size(); ++r) {
    if (ligand_of[r] < 0) continue;
    const Mol2File& ligand = ligands[static_cast<std::size_t>(ligand_of[r])];
    for (const Mol2Atom& atom : missing_hydrogens(ligand, molecule, atoms[r])) {
      if (complete.atoms.size() == kMostAtoms)
        throw InputError(ligand.path + ": with its hydrogens " + molecule.name + " has more than " +
                         std::to_string(kMostAtoms) + " atoms, which is the most that are read");
      complete.atoms.push_back({atom.name, atom.element, static_cast<std::int32_t>(r), true});
      complete.positions.push_back(atom.position);
      complete.radii.push_back(0);
    }
  }
  return complete;
}

std::vector<Component> given_components(const std::vector<std::string>& paths) {
  std::vector<Component> all;
  for (const std::string& path : paths) {
    if (!is_component_path(path)) continue;
    std::vector<Component> more = read_components(path);
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return all;
}

std::optional<LigandBonds> bonds_by_definition(const Molecule& fragment, std::size_t n_own,
                                               const std::vector<Component>& given) {
  const std::string& name = fragment.residues.front().name;
  const bool has_hydrogens = std::any_of(fragment.atoms.begin(), fragment.atoms.end(), [](const Atom& atom) {
    return atom.element.empty() || atom.element == "H" || atom.element == "D";
  });
  if (has_hydrogens || fragment.size() > kMostMolfileAtoms) return std::nullopt;
  const auto found =
      std::find_if(given.begin(), given.end(), [&](const Component& component) { return component.name == name; });
  const std::optional<Component> of_library = found == given.end() ? component_of_library(name) : std::nullopt;
  if (found == given.end() && !of_library) return std::nullopt;
  std::optional<LigandBonds> known = bonds_by(of_library ? *of_library : *found, fragment, n_own);
  if (known && !of_library) known->path = found->path;
  return known;
}

std::string LigandBonds::in_words() const {
  return path.empty() ? "CCP4's library" : std::filesystem::path(path).filename().string();
}

std::vector<bool> acylated_amidines(const Molecule& ligand, const LigandBonds& known) {
  struct Neighbour {
    std::size_t atom;
    int order;
  };
  std::vector<std::vector<Neighbour>> around(ligand.size());
  for (const ComponentBond& bond : known.bonds) {
    around[bond.a].push_back({bond.b, bond.order});
    around[bond.b].push_back({bond.a, bond.order});
  }
  const auto is = [&](std::size_t i, const char* element) { return ligand.atoms[i].element == element; };
  const auto is_carbonyl = [&](const Neighbour& neighbour) {
    const std::vector<Neighbour>& others = around[neighbour.atom];
    return is(neighbour.atom, "C") && std::any_of(others.begin(), others.end(), [&](const Neighbour& other) {
             return other.order == 2 && is(other.atom, "O");
           });
  };
  std::vector<bool> found(ligand.size(), false);
  for (std::size_t n = 0; n < ligand.size(); ++n) {
    for (const Neighbour& carbon : around[n]) {
      if (!is(n, "N") || around[n].size() != 2 || carbon.order != 2 || !is(carbon.atom, "C")) continue;
      std::vector<std::size_t> other_nitrogens;
      for (const Neighbour& other : around[carbon.atom]) {
        if (other.atom != n && is(other.atom, "N")) other_nitrogens.push_back(other.atom);
      }
      if (other_nitrogens.size() != 1) continue;  // a guanidine is more basic
      const std::vector<Neighbour>& behind = around[other_nitrogens.front()];
      found[n] = std::any_of(behind.begin(), behind.end(), is_carbonyl);
    }
  }
  return found;
}

std::string molfile_text(const Molecule& ligand, const LigandBonds& known) {
  std::string text =
      "LIG\n\n\n" + formatted("%3zu%3zu", ligand.size(), known.bonds.size()) + "  0  0  0  0  0  0  0  0999 V2000\n";
  for (std::size_t i = 0; i < ligand.size(); ++i) {
    const Vec3d& place = ligand.positions[i];
    text += formatted("%10.4f%10.4f%10.4f %-3s 0  0  0  0  0  0  0  0  0  0  0  0\n", place.x, place.y, place.z,
                      ligand.atoms[i].element.c_str());
  }
  for (const ComponentBond& bond : known.bonds)
    text += formatted("%3zu%3zu%3d  0\n", bond.a + 1, bond.b + 1, bond.order);
  for (std::size_t i = 0; i < known.charges.size(); ++i) {
    if (known.charges[i] != 0) text += formatted("M  CHG  1 %3zu %3d\n", i + 1, known.charges[i]);
  }
  return text + "M  END\n";
}

}  // namespace espdiff
