// placement.cpp: how the place of an earlier patch was found, as JSON and in words.
#include "report/sections/placement.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/formatted.h"
#include "base/molecule/earlier_patch.h"

namespace espdiff {

nlohmann::ordered_json placement_json(const PatchPlacement& p) {
  return {{"file", p.path},
          {"sha256", p.sha256},
          {"patch", p.number},
          {"area_A2", p.area_A2},
          {"n_superposed_residues", p.n_residues},
          {"n_left_out", p.n_left_out},
          {"rmsd_A", p.rmsd_A},
          {"found_area_fraction", p.found_area_fraction},
          {"in_words", in_words(p)}};
}

std::string in_words(const PatchPlacement& p) {
  return "patch " + std::to_string(p.number) + " of " + std::filesystem::path(p.path).filename().string() +
         formatted("; %zu residues near it superposed (RMSD %.2g A); %.3g %% of its %.1f A^2 found", p.n_residues,
                   p.rmsd_A, 100 * p.found_area_fraction, p.area_A2);
}

}  // namespace espdiff
