// groups.cpp: the list of additives, the charges of haem, and what each group beside the chains gets.
#include "prepare/charges/groups.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "align/chain_links.h"
#include "align/residue_charges.h"
#include "align/residue_names.h"
#include "base/formatted.h"
#include "base/molecule/input_options.h"
#include "base/molecule/residue_label.h"
#include "base/not_a_number.h"
#include "prepare/charges/caps.h"
#include "prepare/charges/ion_table.h"
#include "prepare/charges/ligand.h"
#include "prepare/charges/modified_residues.h"
#include "prepare/charges/open_babel.h"

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

/// Older and modelled files have CO, cobalt's name as an ion, for carbon monoxide, and O2 for oxygen.
bool is_gas(const std::string& name, std::size_t n_atoms) {
  static const std::set<std::string_view> names = {"OXY", "CMO", "NO", "NMO", "N2", "XE", "KR", "AR"};
  return names.count(name) > 0 || ((name == "CO" || name == "O2") && n_atoms == 2);
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

/// Hydrogens without those that the net charge explains: bonds alone determine it, whatever is protonated.
int hydrogens_at_no_charge(std::size_t n_hydrogens, double net_charge) {
  return static_cast<int>(n_hydrogens) - static_cast<int>(std::lround(net_charge));
}

/// What the file's formula says of the hydrogens; nothing without one, or where heavy atoms are missing, as where the
/// ligand is bound to others.
std::optional<int> hydrogens_of_formula(const Molecule& molecule, const Molecule& group, const LostInChain& lost) {
  const auto found = molecule.formulas.find(group.residues.front().name);
  if (found == molecule.formulas.end()) return std::nullopt;
  ChemicalFormula formula = found->second;
  const int n_hydrogens = formula.atoms["H"] + formula.atoms["D"];
  formula.atoms["O"] -= lost.n_oxygens;
  for (const Atom& atom : group.atoms) {
    if (!is_hydrogen_atom(atom)) --formula.atoms[atom.element];
  }
  for (const auto& [element, n] : formula.atoms) {
    if (element != "H" && element != "D" && n != 0) return std::nullopt;
  }
  return n_hydrogens - formula.charge - lost.n_hydrogens;
}

std::size_t count_hydrogens(const Molecule& group) {
  return static_cast<std::size_t>(std::count_if(group.atoms.begin(), group.atoms.end(), is_hydrogen_atom));
}

/// Where the bonds of a residue are from, for people; empty where Open Babel perceived them.
std::string take_source(Groups& groups, const std::optional<LigandBonds>& bonds) {
  if (!bonds) return {};
  std::vector<std::string>& used = groups.definitions;
  if (!bonds->path.empty() && std::find(used.begin(), used.end(), bonds->path) == used.end())
    used.push_back(bonds->path);
  return bonds->in_words();
}

/// Where the right bonds are, for people.
std::string ways_to_bonds(const std::string& name, const std::string& bonds_from) {
  const std::string definition = "its definition in the Chemical Component Dictionary (" + name + ".cif)";
  if (!bonds_from.empty()) return "give a MOL2 file of it";
  const std::string files = "give a MOL2 file of it, or " + definition;
  return has_monomer_library() ? files : files + "; CCP4's library has many: " + kMonomerLibraryRemedy;
}

/// Whether the file's formula confirms the bonds. A warning says where it does not.
bool agrees_with_formula(Groups& groups, const Molecule& molecule, const Molecule& group, double net_charge,
                         const LostInChain& lost, const std::string& bonds_from) {
  const std::optional<int> wanted = hydrogens_of_formula(molecule, group, lost);
  const int found = hydrogens_at_no_charge(count_hydrogens(group), net_charge);
  if (wanted && *wanted != found)
    groups.warnings.push_back(residue_label(group.residues.front()) + " has " + std::to_string(found) +
                              " hydrogens (without charge) by the bonds " +
                              (bonds_from.empty() ? "that Open Babel perceives" : "of " + bonds_from) + ", and " +
                              std::to_string(*wanted) + " by the file's formula, so that its charges are wrong; " +
                              ways_to_bonds(group.residues.front().name, bonds_from));
  return wanted && *wanted == found;
}

/// "Gasteiger's charges, pH 7; bonds of FMN.cif, which agree with the file's formula"
std::string source_in_words(double ph, const std::string& bonds_from, bool agrees) {
  return "Gasteiger's charges, pH " + formatted("%g", ph) +
         (!bonds_from.empty() ? "; bonds of " + bonds_from + (agrees ? ", which agree with the file's formula" : "")
          : agrees            ? "; bonds agree with the file's formula"
                              : "");
}

void charge_other_ligand(Groups& groups, Molecule& group, const Molecule& molecule, std::size_t residue,
                         const std::vector<Component>& components, double ph, const Progress& progress) {
  const std::optional<LigandBonds> bonds = bonds_by_definition(group, group.size(), components);
  const std::string bonds_from = take_source(groups, bonds);
  ChargedLigand ligand = charge_by_open_babel(group, molecule, ph, bonds ? &*bonds : nullptr, progress);
  const std::size_t n_given = ligand.molecule.size() - ligand.n_hydrogens_added;
  group = std::move(ligand.molecule);
  const bool agrees = agrees_with_formula(groups, molecule, group, ligand.net_charge, {}, bonds_from);
  const std::size_t n_dropped = drop_hydrogens_at_bonds(group, n_given, molecule, residue);
  const std::optional<int> usual = charge_of_group(group.residues.front().name, group.size());
  // Gasteiger's charges of phosphates do not sum up to the whole number.
  const double whole = usual ? *usual : std::round(ligand.net_charge);
  const std::string label = residue_label(group.residues.front()), charge = in_elementary_charges(whole);
  groups.lines.push_back(
      label + ": " + charge + ", " + std::to_string(ligand.n_hydrogens_added - n_dropped) + " hydrogens added" +
      (ligand.n_hydrogens_replaced == 0 ? std::string()
                                        : " for the file's " + std::to_string(ligand.n_hydrogens_replaced)) +
      ", by Open Babel (" + source_in_words(ph, bonds_from, agrees) + ")");
  const auto n = static_cast<double>(group.size());
  for (float& q : group.charges) q += static_cast<float>((whole - ligand.net_charge) / n);
  if (!usual) {
    groups.guessed.push_back(label + " (" + charge + ")");
    return;
  }
  if (std::fabs(ligand.net_charge - *usual) <= 0.5) return;
  groups.warnings.push_back(label + " has " + in_elementary_charges(std::round(ligand.net_charge)) + " by the bonds " +
                            (bonds_from.empty() ? "that Open Babel perceives" : "of " + bonds_from) + " and usually " +
                            charge + ", to which its charges were shifted evenly; a MOL2 file of it would be exact");
}

std::string names_in_words(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string guess_in_words(const std::vector<std::string>& ligands) {
  constexpr std::size_t kMostNamed = 6;
  std::string names;
  for (std::size_t i = 0; i < std::min(ligands.size(), kMostNamed); ++i) names += (i == 0 ? "" : ", ") + ligands[i];
  if (ligands.size() > kMostNamed) names += " and " + std::to_string(ligands.size() - kMostNamed) + " more";
  return (ligands.size() == 1 ? std::string("the net charge of a ligand is")
                              : "the net charges of " + std::to_string(ligands.size()) + " ligands are") +
         " a guess by Open Babel's rules, which no other source confirms: " + names +
         "; where one is wrong, give a MOL2 file of it";
}

bool has_haem_names(const Molecule& molecule, const std::vector<std::size_t>& atoms) {
  return std::all_of(atoms.begin(), atoms.end(), [&](std::size_t i) {
    return is_hydrogen_atom(molecule.atoms[i]) || haem_atom(molecule.atoms[i].name).has_value();
  });
}

/// A chain of which more than a tenth is torn has no ends to leave out: PDB2PQR says what it lacks.
void keep_torn_chains(const std::vector<ResidueKind>& kinds, std::vector<GroupSource>& sources) {
  constexpr std::ptrdiff_t kLeastWhole = 10;
  const auto n_torn = std::count(sources.begin(), sources.end(), GroupSource::kTorn);
  if (n_torn * kLeastWhole <= std::count_if(kinds.begin(), kinds.end(), is_polymer)) return;
  std::replace(sources.begin(), sources.end(), GroupSource::kTorn, GroupSource::kNone);
}

/// Whether an ion of one charge touches nothing but the solvent: there it is part of the salt, which has no place.
bool is_free_ion(const Molecule& molecule, std::size_t ion, const std::vector<GroupSource>& sources,
                 const std::vector<ResidueKind>& kinds) {
  constexpr double kTouch_A = 5;
  const auto parameters = ion_parameters(molecule.residues[static_cast<std::size_t>(molecule.atoms[ion].residue)].name,
                                         molecule.atoms[ion].element);
  if (!parameters || std::fabs(parameters->charge) != 1) return false;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const auto r = static_cast<std::size_t>(molecule.atoms[i].residue);
    const bool holds = kinds[r] != ResidueKind::kWater && sources[r] != GroupSource::kIon &&
                       sources[r] != GroupSource::kAdditive && sources[r] != GroupSource::kGas;
    if (holds && norm(molecule.positions[i] - molecule.positions[ion]) < kTouch_A) return false;
  }
  return true;
}

/// Leaves the ions of the salt out, if there is something else.
void drop_free_ions(const Molecule& molecule, const std::vector<std::vector<std::size_t>>& atoms,
                    const std::vector<ResidueKind>& kinds, std::vector<GroupSource>& sources) {
  if (std::none_of(kinds.begin(), kinds.end(), is_polymer)) return;
  std::vector<std::size_t> free;
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] == GroupSource::kIon && is_free_ion(molecule, atoms[r].front(), sources, kinds)) free.push_back(r);
  }
  for (const std::size_t r : free) sources[r] = GroupSource::kAdditive;
}

}  // namespace

std::vector<GroupSource> group_sources(const Molecule& molecule, const std::vector<std::int32_t>& ligand_of,
                                       const ChargeOptions& options) {
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  const bool has_open_babel = options.ligands_auto && !find_open_babel().empty();
  std::vector<GroupSource> sources(kinds.size(), GroupSource::kNone);
  for (std::size_t r = 0; r < kinds.size(); ++r) {
    const std::string& name = molecule.residues[r].name;
    if (atoms[r].empty() || ligand_of[r] >= 0 || is_cap_name(name)) continue;
    if (kinds[r] == ResidueKind::kAminoAcid) sources[r] = amino_acid_source(molecule, r, atoms[r], has_open_babel);
    if (kinds[r] == ResidueKind::kNucleotide) sources[r] = nucleotide_source(molecule, r, atoms, has_open_babel);
    if (kinds[r] != ResidueKind::kOther) continue;
    if (is_additive(name)) {
      sources[r] = GroupSource::kAdditive;
    } else if (is_gas(name, atoms[r].size())) {
      sources[r] = GroupSource::kGas;
    } else if (atoms[r].size() == 1 && ion_parameters(name, molecule.atoms[atoms[r].front()].element)) {
      sources[r] = GroupSource::kIon;
    } else if (is_haem(name) && has_haem_names(molecule, atoms[r])) {
      sources[r] = GroupSource::kHaem;
    } else if (has_open_babel) {
      const bool in_chain = peptide_backbone(molecule, r, atoms) || is_in_nucleic_chain(molecule, r, atoms);
      sources[r] = is_bound_as_cap(molecule, r, atoms) ? GroupSource::kCap
                   : in_chain                          ? GroupSource::kModified
                                                       : GroupSource::kOpenBabel;
    }
  }
  keep_torn_chains(kinds, sources);
  drop_free_ions(molecule, atoms, kinds, sources);
  return sources;
}

Groups charge_groups(const Molecule& molecule, const std::vector<GroupSource>& sources, const ChargeOptions& options,
                     const Progress& progress) {
  Groups groups;
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<Component> components = given_components(options.ligands);
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (sources[r] == GroupSource::kNone) continue;
    Molecule group = residue_alone(molecule, r, atoms[r]);
    const Residue& residue = molecule.residues[r];
    const std::string label = residue_label(residue);
    if (sources[r] == GroupSource::kPhosphate) {
      groups.lines.push_back(label + ": a phosphate of -2 e (CHARMM's charges)");
      continue;
    }
    if (sources[r] == GroupSource::kModified || sources[r] == GroupSource::kCap) {
      const ChargedResidue modified = charge_modified_residue(molecule, r, components, options.ph, progress);
      const std::string charge = in_elementary_charges(modified.net_charge),
                        bonds_from = take_source(groups, modified.bonds);
      const bool agrees =
          agrees_with_formula(groups, molecule, modified.molecule, modified.net_charge,
                              sources[r] == GroupSource::kModified ? modified.lost : LostInChain(), bonds_from);
      append_residue(groups.modified, modified.molecule);
      groups.guessed.push_back(label + " (" + charge + ")");
      const std::vector<std::string> foreign = foreign_atoms(molecule, r, atoms[r]);
      groups.lines.push_back(
          label + ": " + charge + ", in its chain, by Open Babel (" + source_in_words(options.ph, bonds_from, agrees) +
          ")" + (foreign.empty() ? std::string() : ", since " + residue.name + " has no " + names_in_words(foreign)));
      continue;
    }
    if (sources[r] == GroupSource::kAdditive || sources[r] == GroupSource::kTorn) {
      const std::optional<int> charge = charge_of_group(residue.name, group.size());
      groups.additives.push_back({residue, group.atoms, group.positions, charge ? *charge : kNaN});
      continue;
    }
    if (sources[r] == GroupSource::kIon) {
      const IonParameters ion = *ion_parameters(residue.name, group.atoms.front().element);
      group.charges.front() = static_cast<float>(ion.charge);
      group.radii.front() = static_cast<float>(ion.radius);
      groups.lines.push_back(label + ": " + in_elementary_charges(ion.charge) +
                             (residue.name == "OH" ? " (hydroxide)" : " (common oxidation state)"));
    } else if (sources[r] == GroupSource::kGas) {
      groups.lines.push_back(label + ": a gas, without charges");
    } else if (sources[r] == GroupSource::kHaem) {
      charge_haem(group);
      groups.lines.push_back(label + ": -2 e (iron(II), CHARMM22's charges without hydrogens)");
    } else {
      charge_other_ligand(groups, group, molecule, r, components, options.ph, progress);
    }
    append_residue(groups.charged, group);
  }
  if (!groups.guessed.empty()) groups.warnings.push_back(guess_in_words(groups.guessed));
  return groups;
}

}  // namespace espdiff
