// page_texts.h: the files of page/ and the library that draws, as the build embeds them.
#pragma once

#include <map>
#include <string>

namespace espdiff {

/// By file name: those of page/, and with three.js three.min.js and TrackballControls.js.
const std::map<std::string, std::string>& page_texts();

}  // namespace espdiff
