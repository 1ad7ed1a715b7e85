// choose_potential.cpp: the rule by which potentials are chosen.
#include "potential/choose_potential.h"

#include <algorithm>

#include "base/error.h"
#include "base/water.h"

namespace espdiff {

bool has_charges(const Molecule& molecule) {
  return std::any_of(molecule.charges.begin(), molecule.charges.end(), [](float q) { return q != 0; });
}

PotentialFacts potential_facts(const Molecule& everything, const std::optional<UnitCell>& cell) {
  PotentialFacts facts{everything.name, has_charges(everything), false};
  for (std::size_t i = 0; facts.has_charges && cell && i < everything.atoms.size() && !facts.has_solvent; ++i) {
    const Residue& residue = everything.residues[static_cast<std::size_t>(everything.atoms[i].residue)];
    facts.has_solvent = everything.charges[i] != 0 && is_water_name(residue.name);
  }
  return facts;
}

PotentialChoice choose_potential(const std::string& asked, const std::string& cell,
                                 const std::vector<PotentialFacts>& molecules) {
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
  choice.method = all_solvated ? PotentialMethod::kPme : PotentialMethod::kPoissonBoltzmann;
  choice.because =
      all_solvated ? "explicit water in a periodic cell" : "charges without explicit water in a periodic cell";
  return choice;
}

}  // namespace espdiff
