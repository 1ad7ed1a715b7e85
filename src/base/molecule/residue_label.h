// residue_label.h: a residue as messages name it.
#pragma once

#include <cstdlib>
#include <string>

#include "base/types.h"

namespace espdiff {

/// "ALA 12 of chain A"; without a chain "ALA 12", with an insertion code "ALA 12B of chain A".
inline std::string residue_label(const Residue& residue) {
  std::string label = residue.name + " " + std::to_string(residue.number);
  if (residue.insertion_code != ' ') label += residue.insertion_code;
  return residue.chain.empty() ? label : label + " of chain " + residue.chain;
}

/// The residue of such a label; what is no label becomes a name.
inline Residue parse_residue_label(const std::string& label) {
  const std::string of_chain = " of chain ";
  Residue residue;
  const std::size_t chain = label.find(of_chain);
  if (chain != std::string::npos) residue.chain = label.substr(chain + of_chain.size());
  const std::string rest = label.substr(0, chain);
  const std::size_t blank = rest.find(' ');
  residue.name = rest.substr(0, blank);
  if (blank == std::string::npos) return residue;
  char* end = nullptr;
  const long number = std::strtol(rest.c_str() + blank + 1, &end, 10);
  residue.number = static_cast<std::int32_t>(number);
  if (*end != '\0') residue.insertion_code = *end;
  return residue;
}

}  // namespace espdiff
