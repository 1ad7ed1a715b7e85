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
/// @param title    heading; empty: the names of structures or groups, or OUT
/// @param range_of VTP files of other results; each scale is then as wide as the widest automatic one of OUT and these
/// @throws what report_page(), matrix_page(), trajectory_page() and ensemble_page() throw; InputError (`range_of` for a
///         matrix or a trajectory, whose scales are of other numbers)
std::string result_page(const std::string& prefix, const std::string& title,
                        const std::vector<std::string>& range_of = {});

}  // namespace espdiff
