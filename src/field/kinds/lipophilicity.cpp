// lipophilicity.cpp: the molecular lipophilicity potential, from contributions of the atoms.
#include <map>
#include <string>

#include "align/residue_names.h"
#include "field/field.h"

namespace espdiff {
namespace {

using Contributions = std::map<std::string, float>;

/// log P that each heavy atom adds, its hydrogens included: contributions of Ghose and Crippen's atom types, summed for
/// amino acids as the program ChimeraX does (command mlp).
const Contributions kBackbone = {{"N", -0.6149F}, {"CA", -0.1571F}, {"C", -0.1002F}, {"O", -0.0233F}};

/// Kinds of carbon and its hydrogens.
constexpr float kMethyl = 0.6420F, kMethylene = 0.3212F, kNextToCarbonyl = 0.0348F, kNextToHetero = 0.0116F,
                kCarbonyl = -0.1002F, kBranched = -0.0015F, kAromaticH = 0.3050F, kAromatic = 0.1492F;

const std::map<char, Contributions>& side_chains() {
  static const std::map<char, Contributions> all = {
      {'A', {{"CB", 0.4395F}}},
      {'R',
       {{"CB", kMethylene},
        {"CG", kMethylene},
        {"CD", kNextToHetero},
        {"NE", -0.1425F},
        {"CZ", 0.5142F},
        {"NH1", -0.5995F},
        {"NH2", -0.5995F}}},
      {'N', {{"CB", kNextToCarbonyl}, {"CG", kCarbonyl}, {"OD1", -0.0233F}, {"ND2", -0.7185F}}},
      {'D', {{"CB", kNextToCarbonyl}, {"CG", kCarbonyl}, {"OD1", -0.4087F}, {"OD2", -0.4087F}}},
      {'C', {{"CB", kNextToHetero}, {"SG", 0.5110F}}},
      {'Q', {{"CB", kMethylene}, {"CG", kNextToCarbonyl}, {"CD", kCarbonyl}, {"OE1", -0.0233F}, {"NE2", -0.7185F}}},
      {'E', {{"CB", kMethylene}, {"CG", kNextToCarbonyl}, {"CD", kCarbonyl}, {"OE1", -0.4087F}, {"OE2", -0.4087F}}},
      {'G', {{"CA", -0.2018F}}},
      {'H',
       {{"CB", kNextToCarbonyl},
        {"CG", 0.2361F},
        {"ND1", -0.2660F},
        {"CD2", 0.5185F},
        {"CE1", 0.1443F},
        {"NE2", -0.2660F}}},
      {'I', {{"CB", kBranched}, {"CG1", 0.4562F}, {"CG2", kMethyl}, {"CD1", kMethyl}}},
      {'L', {{"CB", kMethylene}, {"CG", 0.0660F}, {"CD1", kMethyl}, {"CD2", kMethyl}}},
      {'K', {{"CB", kMethylene}, {"CG", 0.4562F}, {"CD", 0.4562F}, {"CE", kNextToHetero}, {"NZ", -0.8535F}}},
      {'M', {{"CB", kMethylene}, {"CG", kNextToHetero}, {"SD", 0.5906F}, {"SE", 0.6601F}, {"CE", 0.1023F}}},
      {'F',
       {{"CB", kMethylene},
        {"CG", kAromatic},
        {"CD1", kAromaticH},
        {"CD2", kAromaticH},
        {"CE1", kAromaticH},
        {"CE2", kAromaticH},
        {"CZ", kAromaticH}}},
      {'P', {{"N", -0.5113F}, {"CB", kMethylene}, {"CG", kMethylene}, {"CD", kNextToHetero}}},
      {'S', {{"CB", kNextToHetero}, {"OG", -0.4603F}}},
      {'T', {{"CB", -0.0514F}, {"OG1", -0.4603F}, {"CG2", 0.4395F}}},
      {'W',
       {{"CB", kNextToCarbonyl},
        {"CG", kAromatic},
        {"CD1", 0.5185F},
        {"CD2", kAromatic},
        {"NE1", 0.0223F},
        {"CE2", 0.1539F},
        {"CE3", kAromaticH},
        {"CZ2", kAromaticH},
        {"CZ3", kAromaticH},
        {"CH2", kAromaticH}}},
      {'Y',
       {{"CB", kMethylene},
        {"CG", kAromatic},
        {"CD1", kAromaticH},
        {"CD2", kAromaticH},
        {"CE1", kAromaticH},
        {"CE2", kAromaticH},
        {"CZ", 0.1539F},
        {"OH", -0.1163F}}},
      {'V', {{"CB", kBranched}, {"CG1", kMethyl}, {"CG2", kMethyl}}},
  };
  return all;
}

/// Times 100, the usual scale of such maps. Hydrogens, and what is no amino acid, have no value.
std::vector<float> contributions(const Molecule& molecule) {
  std::vector<float> values;
  for (const Atom& atom : molecule.atoms) {
    values.push_back(kNoValue);
    const char letter = residue_letter(molecule.residues[static_cast<std::size_t>(atom.residue)].name);
    const auto side_chain = side_chains().find(letter);
    if (side_chain == side_chains().end() || is_hydrogen(atom)) continue;
    const std::string name = normalized_atom_name(atom.name, letter);
    auto found = side_chain->second.find(name);
    if (found == side_chain->second.end()) {
      found = kBackbone.find(name);
      if (found == kBackbone.end()) continue;
    }
    values.back() = 100 * found->second;
  }
  return values;
}

}  // namespace

FieldKind lipophilicity_kind() {
  FieldKind kind = kind_of_atoms(
      {"lipophilicity", "Lipophilicity potential", "", true},
      "Molecular lipophilicity potential: the atoms' contributions to log P (times 100), each times e^(-d/A), within 5 "
      "A; of amino acids, as ChimeraX's mlp",
      "Ghose, Viswanadhan and Wendoloski, Prediction of hydrophobic (lipophilic) properties of small organic molecules "
      "using fragmental methods, J. Phys. Chem. A 102, 3762 (1998); Fauchere, Quarendon and Kaetterer, Estimating and "
      "representing hydrophobicity potential, J. Mol. Graph. 6, 203 (1988)",
      contributions);
  kind.field = [of_atoms = kind.field](const FieldKind& self, const std::string& argument) {
    Field field = of_atoms(self, argument);
    field.make = [make = field.make](const Molecule& molecule, const FieldSide& side) {
      StateField of_state = make(molecule, side);
      of_state.weight = AtomWeight::kDecaySum;
      return of_state;
    };
    return field;
  };
  return kind;
}

}  // namespace espdiff
