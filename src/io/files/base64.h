// base64.h: bytes as text (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace espdiff {

/// With padding, on one line.
std::string base64_of(std::string_view bytes);

}  // namespace espdiff
