// report_page.h: a result of `compare` as one page that opens in any browser, without network or other files.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// The page: the mapped surface to be turned by the mouse, its residues, all numbers, verdict and provenance.
/// Everything in it comes from OUT.json, OUT.vtp and OUT.residues.csv; texts of the result are data to the page, never
/// markup or script.
/// @param prefix OUT
/// @param title    heading; empty: the names of the structures
/// @param range_of VTP files of other results; see result_page()
/// @throws IoError, FormatError (missing or damaged files, another version's result), InputError (a surface of more
/// than
///         kMaxPageTriangles triangles), DeviceError (this build has no library that draws)
std::string report_page(const std::string& prefix, const std::string& title,
                        const std::vector<std::string>& range_of = {});

/// Browsers turn a larger surface slowly.
constexpr std::size_t kMaxPageTriangles = 500000;

}  // namespace espdiff
