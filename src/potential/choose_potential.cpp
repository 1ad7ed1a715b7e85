// choose_potential.cpp: the rule by which potentials are chosen.
#include "potential/choose_potential.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "base/molecule/water.h"

namespace espdiff {

bool has_charges(const Molecule& molecule) {
  return std::any_of(molecule.charges.begin(), molecule.charges.end(), [](float q) { return q != 0; });
}

std::vector<bool> salt_ions(const Molecule& molecule) {
  constexpr double kLeastCharge = 0.5, kMostCharge = 1.2;  // some force fields scale them
  std::vector<std::size_t> n_atoms(molecule.residues.size(), 0);
  for (const Atom& atom : molecule.atoms) ++n_atoms[static_cast<std::size_t>(atom.residue)];
  std::vector<bool> ions;
  for (std::size_t i = 0; i < molecule.atoms.size(); ++i) {
    const auto residue = static_cast<std::size_t>(molecule.atoms[i].residue);
    const double q = molecule.charges.empty() ? 0 : std::fabs(static_cast<double>(molecule.charges[i]));
    ions.push_back(n_atoms[residue] == 1 && q > kLeastCharge && q < kMostCharge &&
                   !is_water_name(molecule.residues[residue].name));
  }
  return ions;
}

PotentialFacts potential_facts(const Molecule& everything, const std::optional<UnitCell>& cell) {
  PotentialFacts facts{everything.name, has_charges(everything)};
  if (!facts.has_charges || !cell) return facts;
  std::vector<bool> has_charge(everything.residues.size(), false);
  for (std::size_t i = 0; i < everything.atoms.size(); ++i) {
    if (everything.charges[i] != 0) has_charge[static_cast<std::size_t>(everything.atoms[i].residue)] = true;
  }
  for (std::size_t r = 0; r < everything.residues.size(); ++r)
    facts.n_waters += has_charge[r] && is_water_name(everything.residues[r].name) ? 1 : 0;
  facts.has_solvent = facts.n_waters > 0;
  if (!facts.has_solvent) return facts;
  const std::vector<bool> ions = salt_ions(everything);
  for (std::size_t i = 0; i < ions.size(); ++i) {
    if (!ions[i]) continue;
    const double q = static_cast<double>(everything.charges[i]);
    ++facts.n_ions;
    facts.ion_squares += q * q;
  }
  return facts;
}

PotentialChoice choose_potential(const std::string& asked, const std::string& cell,
                                 const std::vector<PotentialFacts>& molecules, bool averaged) {
  if (cell != "auto" && cell != "own" && cell != "box")
    throw InputError("the cell of pme: '" + cell + "' is not auto, own or box");
  PotentialChoice choice;
  if (asked == "none") return choice;
  const bool all_solvated =
      std::all_of(molecules.begin(), molecules.end(), [](const PotentialFacts& m) { return m.has_solvent; });
  choice.own_cell = cell == "own" || (cell == "auto" && all_solvated);
  if (asked != "auto") {
    choice.method = parse_potential_method(asked);
    return choice;
  }
  const auto without =
      std::find_if(molecules.begin(), molecules.end(), [](const PotentialFacts& m) { return !m.has_charges; });
  if (without != molecules.end()) {
    choice.because = without->name + " has no charges";
    return choice;
  }
  choice.method = all_solvated && averaged ? PotentialMethod::kPme : PotentialMethod::kPoissonBoltzmann;
  choice.because =
      all_solvated ? "explicit water in a periodic cell" : "charges without explicit water in a periodic cell";
  if (!all_solvated || averaged) return choice;
  constexpr double kWaterMolar = 55.3;  // of liquid water at 300 K
  choice.own_cell = false;
  choice.ionic_strength = 0;
  std::size_t n_ions = 0;
  for (const PotentialFacts& m : molecules) {
    n_ions += m.n_ions;
    *choice.ionic_strength += 0.5 * kWaterMolar * m.ion_squares /
                              static_cast<double>(std::max<std::size_t>(m.n_waters, 1) * molecules.size());
  }
  choice.because = "a continuum in place of the explicit water of single frames; salt of the " +
                   std::to_string(n_ions / std::max<std::size_t>(molecules.size(), 1)) + " ions counted in it";
  return choice;
}

GivenPotentialSettings with_salt(const PotentialChoice& choice, GivenPotentialSettings given) {
  constexpr const char* kSalt = "ionic_strength";
  const bool is_given = std::any_of(given.begin(), given.end(),
                                    [&](const auto& g) { return find_potential_setting(g.first).key == kSalt; });
  if (choice.ionic_strength && !is_given) given.emplace_back(kSalt, formatted("%.4g", *choice.ionic_strength));
  return given;
}

}  // namespace espdiff
