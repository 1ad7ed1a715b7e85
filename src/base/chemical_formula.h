// chemical_formula.h: a residue's chemical formula, as structure files give it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace espdiff {

/// Of one molecule, before it is bound to others.
struct ChemicalFormula {
  std::map<std::string, int> atoms;  ///< by element symbol: "C", "Zn"
  int charge = 0;                    ///< elementary charges
};

/// "C33 H41 N5 O6 S2", "2(O4 S 2-)", "ZN 2+": elements with their numbers, then the charge; behind a number of copies,
/// the formula of one. Nothing where it is none of these.
std::optional<ChemicalFormula> parse_formula(std::string_view text);

/// The formulas of a PDB file's FORMUL records, by residue name.
std::map<std::string, ChemicalFormula> formulas_in_pdb(std::string_view text);

}  // namespace espdiff
