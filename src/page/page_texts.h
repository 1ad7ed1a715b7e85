// page_texts.h: the files of page/ and the library that draws, as the build embeds them.
#pragma once

#include <map>
#include <string>

namespace espdiff {

/// By file name: report.html, report.css, report.js, three.min.js, TrackballControls.js.
const std::map<std::string, std::string>& page_texts();

}  // namespace espdiff
