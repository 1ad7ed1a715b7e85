// interface_numbers.h: the complementarity of an interface in numbers, of one complex and of two that are compared.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// One partner's surface within the interface.
struct SideComplementarity {
  double buried_area_A2 = 0, area_A2 = 0;  ///< buried; of that within the interface
  double pearson = 0, spearman = 0;        ///< -r of both partners' potentials
};

/// The complementarity of one complex.
struct StateComplementarity {
  std::string structure;
  SideComplementarity sides[2];
  double pearson = 0, spearman = 0;  ///< means of both sides
  std::size_t n_left_out = 0;        ///< atoms of neither partner
  std::string potential;             ///< in words
};

/// A residue's part in the complementarity.
struct InterfaceResidue {
  double area_A2 = 0;                   ///< of its surface within the interface
  double contribution = 0;              ///< to its partner's -r; all residues of a partner add up to it
  double mean_own = 0, mean_other = 0;  ///< potentials of its own partner and of the other, kT/e; NaN without area
};

/// A residue of a partner in each state; empty in a state that it is not part of.
struct InterfaceRow {
  std::size_t side = 0;
  Residue residue;  ///< of the first state, or of the second where the first has none
  std::optional<InterfaceResidue> states[2] = {};

  /// Of the contribution, second less first.
  double change() const {
    const auto of = [](const std::optional<InterfaceResidue>& state) { return state ? state->contribution : 0; };
    return of(states[1]) - of(states[0]);
  }
};

/// Of both states of a comparison.
struct InterfaceComparison {
  std::string first, second;  ///< the partners, as they were asked for
  StateComplementarity source, target;
  std::vector<InterfaceRow> rows;  ///< with surface in the interface of either state, in the order of the molecules
};

}  // namespace espdiff
