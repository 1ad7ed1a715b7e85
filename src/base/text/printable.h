// printable.h: text that may be shown in a terminal.
#pragma once

#include <cstddef>
#include <string>

namespace espdiff {

/// `text` on one line: control characters (also those of UTF-8, U+0080 to U+009F) as '?'. Names of files may hold any.
inline std::string printable(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : ' ');
    if (c < 0x20 || c == 0x7f) text[i] = '?';
    if (c == 0xc2 && next >= 0x80 && next < 0xa0) text[i] = text[i + 1] = '?';
  }
  return text;
}

}  // namespace espdiff
