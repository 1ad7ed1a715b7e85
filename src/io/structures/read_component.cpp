// read_component.cpp: the loops _chem_comp_atom and _chem_comp_bond.
#include "io/structures/read_component.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#ifdef ESPDIFF_HAVE_GEMMI
#include <gemmi/chemcomp.hpp>
#include <gemmi/cif.hpp>

#include "io/structures/call_gemmi.h"
#endif

#include "base/error.h"
#include "io/files/read_input.h"

namespace espdiff {

const char* const kMonomerLibraryRemedy = "install it (Debian: refmac-dictionary)";

bool is_component_path(const std::string& path) {
  const auto ends = [&](const std::string& ending) {
    return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  };
  return ends(".cif") || ends(".cif.gz");
}

namespace {

/// Empty where the user wants none.
std::filesystem::path monomer_library() {
  const char* const named = std::getenv("CLIBD_MON");
  return named != nullptr ? named : "/usr/share/refmac/monomers";
}

}  // namespace

bool has_monomer_library() {
  std::error_code ignored;
  return std::filesystem::is_directory(monomer_library(), ignored);
}

#ifdef ESPDIFF_HAVE_GEMMI
namespace {

bool is_hydrogen(const gemmi::ChemComp::Atom& atom) { return atom.el == gemmi::El::H || atom.el == gemmi::El::D; }

/// Charges that no proton makes: of atoms without hydrogens that are positive (quaternary and aromatic nitrogen, the
/// nitrogen of a nitro group), and of negative ones bound to these.
void set_charges(const gemmi::ChemComp& from, const std::map<std::string, std::size_t>& places, Component& component) {
  std::map<std::string, float> charges;
  std::set<std::string> hydrogens;
  for (const gemmi::ChemComp::Atom& atom : from.atoms) {
    charges[atom.id] = atom.charge;
    if (is_hydrogen(atom)) hydrogens.insert(atom.id);
  }
  std::set<std::string> with_hydrogens;
  for (const gemmi::Restraints::Bond& bond : from.rt.bonds) {
    if (hydrogens.count(bond.id1.atom) > 0) with_hydrogens.insert(bond.id2.atom);
    if (hydrogens.count(bond.id2.atom) > 0) with_hydrogens.insert(bond.id1.atom);
  }
  const auto is_positive = [&](const std::string& name) {
    return charges[name] >= 0.5F && with_hydrogens.count(name) == 0;
  };
  for (const auto& [name, place] : places) {
    if (is_positive(name)) component.atoms[place].charge = static_cast<int>(std::lround(charges[name]));
  }
  for (const gemmi::Restraints::Bond& bond : from.rt.bonds) {
    for (const auto& [one, other] : {std::pair(bond.id1.atom, bond.id2.atom), {bond.id2.atom, bond.id1.atom}}) {
      const auto place = places.find(one);
      if (place != places.end() && charges[one] <= -0.5F && is_positive(other) && places.count(other) > 0)
        component.atoms[place->second].charge = -1;
    }
  }
}

/// A bond of a delocalized group, between the atom in its middle and another.
struct GroupBond {
  std::size_t bond;  ///< of Component::bonds
  std::size_t middle, outer;
};

/// The middle of each group, which has most of its bonds, gets one double bond: to the outer atom with fewest heavy
/// neighbours, as an ester has, and not to OXT, which is missing within chains.
void set_double_bonds(std::vector<GroupBond> groups, Component& component) {
  std::vector<int> n_delocalized(component.atoms.size(), 0), n_neighbours(component.atoms.size(), 0);
  for (const GroupBond& one : groups) ++n_delocalized[one.middle], ++n_delocalized[one.outer];
  for (const ComponentBond& bond : component.bonds) ++n_neighbours[bond.a], ++n_neighbours[bond.b];
  for (GroupBond& one : groups) {
    if (n_delocalized[one.middle] < n_delocalized[one.outer]) std::swap(one.middle, one.outer);
  }
  const auto rank = [&](const GroupBond& one) {
    return std::pair(component.atoms[one.outer].name == "OXT", n_neighbours[one.outer]);
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const GroupBond& a, const GroupBond& b) { return rank(a) < rank(b); });
  std::set<std::size_t> with_double;
  for (const GroupBond& one : groups) component.bonds[one.bond].order = with_double.insert(one.middle).second ? 2 : 1;
}

/// Nothing where a bond has no order, as those to metals have not.
std::optional<Component> component_of(const gemmi::ChemComp& from, const std::string& path) {
  Component component{path, from.name, {}, {}};
  std::map<std::string, std::size_t> places;
  for (const gemmi::ChemComp::Atom& atom : from.atoms) {
    if (is_hydrogen(atom)) continue;
    if (atom.el.is_metal() || !places.emplace(atom.id, component.atoms.size()).second) return std::nullopt;
    component.atoms.push_back({atom.id, 0});
  }
  std::vector<GroupBond> groups;
  for (const gemmi::Restraints::Bond& bond : from.rt.bonds) {
    const auto a = places.find(bond.id1.atom), b = places.find(bond.id2.atom);
    if (a == places.end() || b == places.end()) continue;
    int order = 0;
    if (bond.type == gemmi::BondType::Single) order = 1;
    if (bond.type == gemmi::BondType::Double) order = 2;
    if (bond.type == gemmi::BondType::Triple) order = 3;
    if (bond.type == gemmi::BondType::Aromatic) order = kAromaticOrder;
    if (bond.type == gemmi::BondType::Deloc) {
      groups.push_back({component.bonds.size(), a->second, b->second});
      order = 1;
    }
    if (order == 0 || a == b) return std::nullopt;
    component.bonds.push_back({a->second, b->second, order});
  }
  if (component.bonds.empty() || component.bonds.size() + 1 < component.atoms.size()) return std::nullopt;
  set_double_bonds(std::move(groups), component);
  set_charges(from, places, component);
  return component;
}

}  // namespace

std::vector<Component> read_components(const std::string& path) {
  std::string text = read_text_file(path);
  const gemmi::cif::Document document = call_gemmi(
      path, "not valid CIF: ", [&] { return gemmi::cif::read_memory(text.data(), text.size(), path.c_str()); });
  std::vector<Component> components;
  for (const gemmi::cif::Block& block : document.blocks) {
    const gemmi::ChemComp from =
        call_gemmi(path, "the components cannot be read: ", [&] { return gemmi::make_chemcomp_from_block(block); });
    if (std::optional<Component> component = component_of(from, path)) components.push_back(std::move(*component));
  }
  if (components.empty())
    throw InputError(path +
                     ": no chemical component with atoms and bonds (_chem_comp_atom, _chem_comp_bond), and without "
                     "metals, is in it; give a ligand's file of the Chemical Component Dictionary, or a MOL2 file");
  return components;
}

std::optional<Component> component_of_library(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path folder = monomer_library();
  const bool is_name =
      !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
  if (folder.empty() || !is_name) return std::nullopt;
  const std::string letter(1, static_cast<char>(std::tolower(static_cast<unsigned char>(name.front()))));
  // Names that Windows keeps for devices are doubled there: CON_CON.cif.
  for (const std::string& file : {name + ".cif", name + '_' + name + ".cif"}) {
    const fs::path path = folder / letter / file;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) continue;
    try {
      for (Component& component : read_components(path.string())) {
        if (component.name == name) return std::move(component);
      }
    } catch (const Error&) {
      // What cannot be read tells no bonds.
    }
  }
  return std::nullopt;
}
#else
std::vector<Component> read_components(const std::string& path) {
  throw InputError(path + ": this build reads no CIF, since gemmi was not found when it was made; give a MOL2 file");
}

std::optional<Component> component_of_library(const std::string& /*name*/) { return std::nullopt; }
#endif

}  // namespace espdiff
