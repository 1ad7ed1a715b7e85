// result_page.h: a result of any kind as one page that opens in any browser.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// Which page a result gets, by its files: OUT.json of `compare`, `matrix` and `ensemble`, or OUT.csv of `trajectory`.
enum class PageKind { kPair, kMatrix, kTrajectory, kEnsemble };

/// @param prefix OUT
/// @throws IoError, FormatError (OUT.json cannot be read, or is no record)
PageKind page_kind(const std::string& prefix);

/// The files that the page of OUT is made of, whether they are there or not.
std::vector<std::string> page_inputs(const std::string& prefix);

/// The page of OUT.
/// @param title heading; empty: the names of structures or groups, or OUT
/// @throws what report_page(), matrix_page(), trajectory_page() and ensemble_page() throw
std::string result_page(const std::string& prefix, const std::string& title);

}  // namespace espdiff
