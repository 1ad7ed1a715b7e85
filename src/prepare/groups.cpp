// groups.cpp: the list of additives, the charges of haem, and what each group beside the chains gets.
#include "prepare/groups.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "align/residue_charges.h"
#include "align/residue_names.h"
#include "base/formatted.h"
#include "base/input_options.h"
#include "base/not_a_number.h"
#include "base/residue_label.h"
#include "prepare/ion_table.h"
#include "prepare/open_babel.h"

namespace espdiff {
namespace {

/// Buffers, cryoprotectants, precipitants and reducing agents, by their names in the Chemical Component Dictionary.
bool is_additive(const std::string& name) {
  static const std::set<std::string_view> names = {
      "GOL", "EDO", "PGO", "PGR", "PDO", "BU1", "BU3", "MPD", "MRD", "HEZ", "IPA", "EOH", "MOH", "POL", "TBU",
      "DIO", "DMS", "DMF", "ACN", "PEG", "PGE", "PG4", "1PE", "2PE", "P6G", "PE4", "PE5", "PE8", "PEU", "P33",
      "P4C", "12P", "15P", "7PE", "XPE", "1PG", "PG0", "PG5", "PG6", "SO4", "SUL", "PO4", "NO3", "ACT", "ACY",
      "FMT", "CIT", "FLC", "TLA", "TAR", "SRT", "MLI", "MLA", "SCN", "AZI", "CAC", "TRS", "BTB", "MES", "EPE",
      "PIN", "CXS", "BCN", "BME", "DTT", "DTV", "DTU", "IMD", "URE", "GAI", "NH4", "UNX", "UNL"};
  return names.count(name) > 0;
}

bool is_gas(const std::string& name) {
  static const std::set<std::string_view> names = {"OXY", "CMO", "NO", "NMO", "N2", "XE", "KR", "AR"};
  return names.count(name) > 0;
}

bool is_haem(const std::string& name) { return name == "HEM" || name == "HEC"; }

bool is_hydrogen_atom(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

struct HaemAtom {
  double charge, radius;
};

/// An atom of haem by its name, of which older files write the nitrogens as "N A".
std::optional<HaemAtom> haem_atom(std::string name) {
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  const std::string two = name.substr(0, 2);
  if (name == "FE") return HaemAtom{0.24, 0.65};
  if (name == "NA" || name == "NB" || name == "NC" || name == "ND") return HaemAtom{-0.18, 1.85};
  if (two == "C1" || two == "C4") return HaemAtom{0.12, 1.80};
  if (two == "C2" || two == "C3") return HaemAtom{-0.06, 1.80};
  if (two == "CH") return HaemAtom{0, 1.80};
  if (two == "CM") return HaemAtom{0, 2.06};
  if (name == "CBA" || name == "CBD") return HaemAtom{-0.10, 2.175};
  if (two == "CA" || two == "CB") return HaemAtom{0, two == "CA" ? 2.175 : 2.0};
  if (two == "CG") return HaemAtom{0.62, 2.0};
  if (two == "O1" || two == "O2") return HaemAtom{-0.76, 1.70};
  return std::nullopt;
}

/// A residue of the molecule as a molecule of its own, without charges.
Molecule alone(const Molecule& molecule, std::size_t residue, const std::vector<std::size_t>& atoms) {
  Molecule one;
  one.name = molecule.name;
  one.residues = {molecule.residues[residue]};
  for (const std::size_t i : atoms) {
    one.atoms.push_back(molecule.atoms[i]);
    one.atoms.back().residue = 0;
    one.positions.push_back(molecule.positions[i]);
    one.radii.push_back(molecule.radii[i]);
    one.charges.push_back(0);
  }
  return one;
}

void append_group(Molecule& all, const Molecule& one) {
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

std::size_t nearest_heavy_atom(const Molecule& group, const Vec3d& place) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < group.size(); ++i) {
    const double distance = norm(group.positions[i] - place);
    if (is_hydrogen_atom(group.atoms[i]) || distance >= least) continue;
    least = distance;
    best = i;
  }
  return best;
}

/// Drops the added hydrogens that lie on atoms of other residues. @returns how many
std::size_t drop_hydrogens_at_bonds(Molecule& group, std::size_t n_given, const Molecule& molecule,
                                    std::size_t residue) {
  constexpr double kBond_A = 1.6;
  std::size_t n_dropped = 0;
  for (std::size_t i = group.size(); i-- > n_given;) {
    const Vec3d place = group.positions[i];
    bool is_bond = false;
    for (std::size_t j = 0; j < molecule.size() && !is_bond; ++j) {
      if (static_cast<std::size_t>(molecule.atoms[j].residue) == residue || is_hydrogen_atom(molecule.atoms[j]))
        continue;
      is_bond = norm(molecule.positions[j] - place) < kBond_A;
    }
    if (!is_bond) continue;
    group.charges[nearest_heavy_atom(group, place)] += group.charges[i];
    const auto at = static_cast<std::ptrdiff_t>(i);
    group.atoms.erase(group.atoms.begin() + at);
    group.positions.erase(group.positions.begin() + at);
    group.radii.erase(group.radii.begin() + at);
    group.charges.erase(group.charges.begin() + at);
    ++n_dropped;
  }
  return n_dropped;
}

std::string in_elementary_charges(double q) {
  return formatted("%+.3g", std::fabs(q) < 0.005 ? 0 : std::round(100 * q) / 100) + " e";
}

void charge_haem(Molecule& group) {
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (is_hydrogen_atom(group.atoms[i])) continue;
    const HaemAtom atom = *haem_atom(group.atoms[i].name);
    group.charges[i] = static_cast<float>(atom.charge);
    group.radii[i] = static_cast<float>(atom.radius);
  }
}

void charge_other_ligand(Groups& groups, Molecule& group, const Molecule& molecule, std::size_t residue, double ph,
                         const Progress& progress) {
  const std::size_t n_given = group.size();
  ChargedLigand ligand = charge_by_open_babel(group, ph, molecule.name, progress);
  group = std::move(ligand.molecule);
  const std::size_t n_dropped = drop_hydrogens_at_bonds(group, n_given, molecule, residue);
  const std::string label = residue_label(group.residues.front());
  groups.lines.push_back(label + ": " + in_elementary_charges(ligand.net_charge) + ", " +
                         std::to_string(ligand.n_hydrogens_added - n_dropped) +
                         " hydrogens added, by Open Babel (Gasteiger's charges, pH " + formatted("%g", ph) + ")");
  const std::optional<int> usual = charge_of_group(group.residues.front().name);
  if (!usual || std::fabs(ligand.net_charge - *usual) <= 0.5) return;
  const auto n = static_cast<double>(group.size());
  for (float& q : group.charges) q += static_cast<float>((*usual - ligand.net_charge) / n);
  groups.warnings.push_back(label + " has " + in_elementary_charges(ligand.net_charge) +
                            " by the bonds that Open Babel perceives and usually " + in_elementary_charges(*usual) +
                            ", to which its charges were shifted evenly; a MOL2 file of it would be exact");
}

bool has_haem_names(const Molecule& molecule, const std::vector<std::size_t>& atoms) {
  return std::all_of(atoms.begin(), atoms.end(), [&](std::size_t i) {
    return is_hydrogen_atom(molecule.atoms[i]) || haem_atom(molecule.atoms[i].name).has_value();
  });
}

}  // namespace

std::vector<GroupSource> group_sources(const Molecule& molecule, const std::vector<std::int32_t>& ligand_of,
                                       const ChargeOptions& options) {
  static const std::set<std::string_view> caps{"ACE", "NME", "NHE", "NH2", "N-M"};
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  std::vector<GroupSource> sources(kinds.size(), GroupSource::kNone);
  for (std::size_t r = 0; r < kinds.size(); ++r) {
    const std::string& name = molecule.residues[r].name;
    if (kinds[r] != ResidueKind::kOther || atoms[r].empty() || ligand_of[r] >= 0 || caps.count(name) > 0) continue;
    if (is_additive(name)) {
      sources[r] = GroupSource::kAdditive;
    } else if (is_gas(name)) {
      sources[r] = GroupSource::kGas;
    } else if (atoms[r].size() == 1 && ion_parameters(name, molecule.atoms[atoms[r].front()].element)) {
      sources[r] = GroupSource::kIon;
    } else if (is_haem(name) && has_haem_names(molecule, atoms[r])) {
      sources[r] = GroupSource::kHaem;
    } else if (options.ligands_auto) {
      sources[r] = GroupSource::kOpenBabel;
    }
  }
  return sources;
}

Groups charge_groups(const Molecule& molecule, const std::vector<GroupSource>& sources, const ChargeOptions& options,
                     const Progress& progress) {
  Groups groups;
  const auto atoms = atoms_of_residues(molecule);
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] == GroupSource::kNone) continue;
    Molecule group = alone(molecule, r, atoms[r]);
    const Residue& residue = molecule.residues[r];
    const std::string label = residue_label(residue);
    if (sources[r] == GroupSource::kAdditive) {
      const std::optional<int> charge = charge_of_group(residue.name);
      groups.additives.push_back({residue, group.atoms, group.positions, charge ? *charge : kNaN});
      continue;
    }
    if (sources[r] == GroupSource::kIon) {
      const IonParameters ion = *ion_parameters(residue.name, group.atoms.front().element);
      group.charges.front() = static_cast<float>(ion.charge);
      group.radii.front() = static_cast<float>(ion.radius);
      groups.lines.push_back(label + ": " + in_elementary_charges(ion.charge) + " (common oxidation state)");
    } else if (sources[r] == GroupSource::kGas) {
      groups.lines.push_back(label + ": a gas, without charges");
    } else if (sources[r] == GroupSource::kHaem) {
      charge_haem(group);
      groups.lines.push_back(label + ": -2 e (iron(II), CHARMM22's charges without hydrogens)");
    } else {
      charge_other_ligand(groups, group, molecule, r, options.ph, progress);
    }
    append_group(groups.charged, group);
  }
  return groups;
}

}  // namespace espdiff
