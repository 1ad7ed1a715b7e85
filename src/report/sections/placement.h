// placement.h: how the place of an earlier patch was found, as JSON and in words.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace espdiff {

struct PatchPlacement;

/// Keys: file, sha256, patch, area_A2, n_superposed_residues, n_left_out, rmsd_A, found_area_fraction, in_words.
nlohmann::ordered_json placement_json(const PatchPlacement& placement);

/// "patch 1 of wild.json; 9 residues near it superposed (RMSD 0.8 A); 97 % of its 104.1 A^2 found"
std::string in_words(const PatchPlacement& placement);

}  // namespace espdiff
