// molecule_builder.cpp: residues, checks and filters that all structure formats share.
#include "io/molecules/molecule_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "base/molecule/water.h"
#include "io/molecules/elements.h"
#include "io/molecules/select_atoms.h"

namespace espdiff {
namespace {

template <std::size_t N>
bool is_one_of(const std::string& name, const std::array<const char*, N>& names) {
  return std::any_of(names.begin(), names.end(), [&](const char* other) { return name == other; });
}

std::string element_of(const AtomEntry& entry) {
  return entry.element.empty() ? element_from_atom_name(entry.name, entry.residue_name) : entry.element;
}

}  // namespace

std::string chain_letter(std::size_t chain) {
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
  return chain < letters.size() ? letters.substr(chain, 1) : std::to_string(chain + 1);
}

bool is_standard_residue(const std::string& residue_name) {
  static constexpr std::array<const char*, 60> kNames = {
      "ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS", "MET", "PHE", "PRO",
      "SER", "THR", "TRP", "TYR", "VAL", "ASH", "GLH", "LYN", "LYP", "ARN", "TYM", "CYX", "CYM", "HID", "HIE",
      "HIP", "HSD", "HSE", "HSP", "MSE", "NTE", "CTE", "ACE", "NME", "NMA", "A",   "C",   "G",   "U",   "T",
      "DA",  "DC",  "DG",  "DT",  "DU",  "RA",  "RC",  "RG",  "RU",  "ADE", "CYT", "GUA", "THY", "URA", "ASX"};
  return is_one_of(residue_name, kNames);
}

MoleculeBuilder::MoleculeBuilder(std::string path, const StructureOptions& options)
    : path_(std::move(path)), options_(options) {
  molecule_.name = path_;
}

void MoleculeBuilder::reserve(std::size_t n_atoms) {
  molecule_.atoms.reserve(n_atoms);
  molecule_.positions.reserve(n_atoms);
  molecule_.radii.reserve(n_atoms);
}

bool MoleculeBuilder::wants(const std::string& residue_name, bool hetero) {
  if (!options_.include_water && is_water_name(residue_name)) {
    ++n_water_;
    return false;
  }
  // The Orientations of Proteins in Membranes database marks the membrane's planes by thousands of these.
  if (hetero && residue_name == "DUM") return false;
  if (!options_.include_hetero && hetero && !is_water_name(residue_name)) {
    ++n_hetero_;
    return false;
  }
  return true;
}

std::int32_t MoleculeBuilder::find_residue(const AtomEntry& entry) {
  std::vector<Residue>& residues = molecule_.residues;
  std::string identity = entry.chain + '\n' + std::to_string(entry.residue_number) + entry.insertion_code + '\n';
  identity += entry.residue_name;
  const auto [found, is_new] = latest_residue_.emplace(std::move(identity), static_cast<std::int32_t>(residues.size()));
  if (!is_new) {
    const auto& atoms = residue_atoms_[static_cast<std::size_t>(found->second)];
    const bool is_last = static_cast<std::size_t>(found->second) + 1 == residues.size();
    const bool has_name = !is_last && std::any_of(atoms.begin(), atoms.end(), [&](std::size_t atom) {
      return molecule_.atoms[atom].name == entry.name;
    });
    if (!has_name) return found->second;
    found->second = static_cast<std::int32_t>(residues.size());
  }
  residues.push_back({entry.residue_name, entry.chain, entry.residue_number, entry.insertion_code});
  residue_atoms_.emplace_back();
  return found->second;
}

/// Two atoms of one name and residue at one place are one atom, written twice.
void MoleculeBuilder::refuse_double(const AtomEntry& entry) {
  std::size_t place = 0;
  for (int axis = 0; axis < 3; ++axis) place = 31 * place + std::hash<double>()(entry.position[axis]);
  const auto [begin, end] = at_place_.equal_range(place);
  for (auto at = begin; at != end; ++at) {
    const auto& [line, index] = at->second;
    const Atom& other = molecule_.atoms[index];
    const Residue& residue = molecule_.residues[static_cast<std::size_t>(other.residue)];
    if (!(molecule_.positions[index] == entry.position) || other.name != entry.name ||
        residue.name != entry.residue_name || residue.chain != entry.chain || residue.number != entry.residue_number ||
        residue.insertion_code != entry.insertion_code)
      continue;
    throw FormatError(path_, entry.line,
                      "atom '" + entry.name + "' of " + entry.residue_name + " " +
                          std::to_string(entry.residue_number) + " is the one of line " + std::to_string(line) +
                          " again, at the same place; its charge would count twice: remove one of them");
  }
  at_place_.emplace(place, std::pair(entry.line, molecule_.atoms.size()));
}

void MoleculeBuilder::append(const AtomEntry& entry, const std::string& element, float radius) {
  constexpr double kFarthest = 1e6;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = entry.position[axis];
    if (std::isfinite(x) && std::abs(x) <= kFarthest) continue;
    throw FormatError(path_, entry.line,
                      std::string(1, "xyz"[axis]) + " coordinate of atom '" + entry.name + "' is " + formatted(x) +
                          "; a number of Angstrom between -1e6 and 1e6 was expected");
  }
  if (molecule_.atoms.size() == kMostAtoms)
    throw InputError(path_ + ": has more than " + std::to_string(kMostAtoms) +
                     " atoms, which is the most that are read");
  constexpr std::size_t kLook = 1 << 18;
  constexpr double kBytesOfAtom = 500;  // with the residues' indices, the places, and room for growth
  if (molecule_.atoms.size() % kLook == kLook - 1) require_memory(kBytesOfAtom * kLook, path_);
  const std::int32_t residue = find_residue(entry);
  residue_atoms_[static_cast<std::size_t>(residue)].push_back(molecule_.atoms.size());
  molecule_.atoms.push_back(
      {entry.name, element, residue, entry.hetero, entry.b_factor, entry.occupancy, entry.has_alternates});
  molecule_.positions.push_back(entry.position);
  molecule_.radii.push_back(radius);
}

void MoleculeBuilder::add(const AtomEntry& entry) {
  const std::string element = element_of(entry);
  append(entry, element, element_radius(element));
  molecule_.radii_origin = ValueOrigin::kElement;
}

void MoleculeBuilder::add(const AtomEntry& entry, double charge, double radius) {
  if (!(std::abs(charge) <= kLargestCharge)) {
    throw FormatError(path_, entry.line,
                      "charge of atom '" + entry.name + "' is " + formatted(charge) +
                          "; elementary charges between -1e6 and 1e6 were expected");
  }
  if (!(radius <= kLargestRadius_A)) {
    throw FormatError(
        path_, entry.line,
        "radius of atom '" + entry.name + "' is " + formatted(radius) + "; at most 1000 Angstrom were expected");
  }
  if (radius < 0) {
    throw FormatError(path_, entry.line,
                      "radius of atom '" + entry.name + "' is " + formatted(radius) +
                          "; 0 or more was expected (are charge and radius swapped?)");
  }
  refuse_double(entry);
  append(entry, element_of(entry), static_cast<float>(radius));
  molecule_.charges.push_back(static_cast<float>(charge));
  molecule_.radii_origin = ValueOrigin::kFile;
}

Molecule MoleculeBuilder::finish() {
  if (molecule_.atoms.empty()) {
    if (n_water_ + n_hetero_ == 0) throw InputError(path_ + ": has no atoms; give a structure with atoms");
    refuse_left_out(path_, n_water_, n_hetero_);
  }
  return std::move(molecule_);
}

}  // namespace espdiff
