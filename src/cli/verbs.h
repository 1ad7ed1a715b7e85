// verbs.h: the commands of the command line; each adds its options to the parser and returns its work.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"

namespace espdiff::cli {

/// Given to every command.
struct Context {
  std::string command_line;        ///< as typed, for the provenance of a result
  std::vector<std::string> words;  ///< the same behind the program's name, word by word
  Progress* progress = nullptr;
};

/// A command's work: runs after parsing if the command was chosen; returns the exit status.
using Run = std::function<int(const Context&)>;

/// A command's parser, and its work.
struct Verb {
  CLI::App* parser;
  Run run;
};

Verb add_compare(CLI::App& app);
Verb add_trajectory(CLI::App& app);
Verb add_matrix(CLI::App& app);
Verb add_merge(CLI::App& app);
Verb add_ensemble(CLI::App& app);
Verb add_complementarity(CLI::App& app);
Verb add_export(CLI::App& app);
Verb add_fields(CLI::App& app);
Verb add_surface(CLI::App& app);
Verb add_plot(CLI::App& app);
Verb add_potential(CLI::App& app);
Verb add_prepare(CLI::App& app);
Verb add_render(CLI::App& app);
Verb add_report(CLI::App& app);
Verb add_show(CLI::App& app);
Verb add_view(CLI::App& app);
Verb add_verify(CLI::App& app);
Verb add_doctor(CLI::App& app);
Verb add_completion(CLI::App& app);
Verb add_man(CLI::App& app);

}  // namespace espdiff::cli
