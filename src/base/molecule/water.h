// water.h: the names that water has in structure files.
#pragma once

#include <string_view>

namespace espdiff {

/// Whether a residue of this name, in capitals, is water: HOH, WAT, TIP3, SOL and the like.
inline bool is_water_name(std::string_view residue_name) {
  constexpr std::string_view kNames[] = {"HOH", "WAT", "H2O", "DOD", "TIP", "TIP2", "TIP3", "TIP4", "TIP5", "TP3",
                                         "TP4", "TP5", "T3P", "T4P", "SPC", "SPCE", "SOL",  "SOLV", "OH2"};
  for (const std::string_view name : kNames) {
    if (residue_name == name) return true;
  }
  return false;
}

}  // namespace espdiff
