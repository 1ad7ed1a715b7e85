// spelling.h: how the command line writes the options that messages name.
#pragma once

#include <string>

#include "base/message.h"

namespace espdiff::cli {

/// "--align none"; a switch as "--overwrite".
std::string spelled_option(const NamedOption& option);
/// A word as a shell takes it: in quotes where it has parentheses, blanks and the like.
std::string shell_quoted(const std::string& word);
/// The message as shown on the command line.
inline std::string spelled(const Message& message) { return message.spelled(spelled_option); }

}  // namespace espdiff::cli
