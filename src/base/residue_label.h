// residue_label.h: a residue as messages name it.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff {

/// "ALA 12 of chain A"; without a chain "ALA 12", with an insertion code "ALA 12B of chain A".
inline std::string residue_label(const Residue& residue) {
  std::string label = residue.name + " " + std::to_string(residue.number);
  if (residue.insertion_code != ' ') label += residue.insertion_code;
  return residue.chain.empty() ? label : label + " of chain " + residue.chain;
}

}  // namespace espdiff
