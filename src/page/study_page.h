// study_page.h: a trajectory or a matrix as one page that opens in any browser.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// Which page a result gets, by its files: OUT.json of `compare` and of `matrix`, or OUT.csv of `trajectory`.
enum class PageKind { kPair, kMatrix, kTrajectory };

/// @param prefix OUT
/// @throws InputError (neither OUT.json nor OUT.csv; an ensemble, which has no page), IoError
PageKind page_kind(const std::string& prefix);

/// The files that a page is made of; a trajectory's table of residues only if it is there.
std::vector<std::string> page_inputs(const std::string& prefix, PageKind kind);

/// The page of a matrix or a trajectory: a plot of each metric, in which a click selects a pair or a frame; then all
/// its numbers, why it is not trustworthy, and warnings. A matrix is a map, in the given order or that of its
/// clustering; a trajectory lines along its frames, and a map of its residues, if OUT.residues.csv is there. Everything
/// comes from OUT.csv, OUT.json (matrix) and OUT.residues.csv; texts of the result are data to the page.
/// @param title heading; empty: the name of OUT
/// @throws IoError, FormatError (missing or damaged files), InputError (more than kMaxStudyRows rows)
std::string study_page(const std::string& prefix, PageKind kind, const std::string& title);

/// Browsers draw and search more rows slowly: 300 variants, or 90,000 frames.
constexpr std::size_t kMaxStudyRows = 90000;

}  // namespace espdiff
