// ligand_bonds.cpp: matches a residue's atoms with a component's by their names.
#include "prepare/charges/ligand_bonds.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "align/residue_names.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

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
