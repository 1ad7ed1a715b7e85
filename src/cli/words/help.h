// help.h: what `--help` prints: the options that most people use, with examples; `--help-all` prints every option.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace espdiff::cli {

/// What the short help of a command shows besides its purpose and its arguments.
struct ShortHelp {
  std::string options;                ///< names as they are typed, separated by blanks; empty: all options
  std::vector<std::string> examples;  ///< whole commands, one a line
  std::string rare{};                 ///< commands that are named in one line, separated by blanks
};

/// Gives a command its help. `--help` prints `help`; `--help-all` every option in its group, and the command's footer.
void set_help(CLI::App& parser, ShortHelp help);

/// The command's arguments as typed: "espdiff compare SOURCE TARGET [OPTION ...]".
std::string usage_line(const CLI::App& parser);

/// The option's names, the long ones first: "--output, -o".
std::vector<std::string> option_names(const CLI::Option& option);
/// What an option takes: "NUMBER", "auto|cpu|cuda"; empty for a switch.
std::string value_name(const CLI::Option& option);
/// The values that an option accepts, where they are a list.
std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace espdiff::cli
