// system_message.h: what the operating system says of an error number.
#pragma once

#include <string>
#include <system_error>

namespace espdiff {

/// The text for a value of errno. Unlike std::strerror it may be called from several threads.
inline std::string system_message(int error_number) { return std::generic_category().message(error_number); }

}  // namespace espdiff
