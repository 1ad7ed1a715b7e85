// assembled_page.h: a record, its arrays and the embedded files as one page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "page/page_arrays.h"

namespace espdiff {

/// One HTML file that fetches nothing. The record gets the colour scales; its texts are data to the page, never markup
/// or script.
/// @param body    the embedded file of markup
/// @param scripts embedded files, in the order in which they run
/// @param library embedded files of three.js, packed as the arrays are: Page.unpack() runs them
std::string assembled_page(nlohmann::ordered_json page, const PageArrays& arrays, const std::string& body,
                           const std::vector<std::string>& scripts, const std::vector<std::string>& library = {});

}  // namespace espdiff
