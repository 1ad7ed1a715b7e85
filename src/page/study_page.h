// study_page.h: a trajectory or a matrix as one page that opens in any browser.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace espdiff {

/// The page of a matrix or a trajectory: a plot of each metric, in which a click selects a pair or a frame; then all
/// its numbers, why it is not trustworthy, and warnings. A matrix is a map, in the given order or that of its
/// clustering; a trajectory lines along its frames, and a map of its residues, if OUT.residues.csv is there. Everything
/// comes from OUT.csv, OUT.json (matrix) and OUT.residues.csv; texts of the result are data to the page.
/// @param prefix OUT
/// @param title heading; empty: the name of OUT
/// @throws IoError, FormatError (missing or damaged files), InputError (more than kMaxStudyRows rows)
std::string matrix_page(const std::string& prefix, const std::string& title);
std::string trajectory_page(const std::string& prefix, const std::string& title);

/// A record of espdiff.
/// @throws IoError, FormatError (not JSON, or no object)
nlohmann::ordered_json read_study_json(const std::string& path);

/// Browsers draw and search more rows slowly: 300 variants, or 90,000 frames.
constexpr std::size_t kMaxStudyRows = 90000;

}  // namespace espdiff
