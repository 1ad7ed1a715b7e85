// ensemble_page.h: an ensemble as one page that opens in any browser.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// The page of an ensemble's statistics: the template with the means of the groups, their difference, its interval and
/// p, faint where it is not significant; the significant patches, their means in each frame, residues, replicates, the
/// noise floor and the conclusion. Texts of the result are data to the page, never markup or script. The series of the
/// patches are left out, with a warning, if they have more than kMaxStudyRows frames.
/// @param prefix OUT
/// @param title    heading; empty: the names of the groups
/// @param range_of VTP files of other results; see result_page()
/// @throws IoError, FormatError (missing or damaged files, another version's result, files of different results),
///         InputError (more than kMaxPageTriangles triangles), DeviceError (this build has no library that draws)
std::string ensemble_page(const std::string& prefix, const std::string& title,
                          const std::vector<std::string>& range_of = {});

}  // namespace espdiff
