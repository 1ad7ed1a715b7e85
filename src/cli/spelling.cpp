// spelling.cpp: how the command line writes the options that messages name.
#include "cli/spelling.h"

namespace espdiff::cli {

std::string spelled_option(const NamedOption& option) {
  return "--" + option.name + (option.value.empty() ? "" : " " + option.value);
}

}  // namespace espdiff::cli
