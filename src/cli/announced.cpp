// announced.cpp: verbs of the design that this version does not have; they say so instead of being unknown.
#include "cli/verbs.h"

namespace espdiff::cli {

std::vector<Verb> add_announced(CLI::App& app) {
  std::vector<Verb> verbs;
  for (const char* name : {"matrix"}) {
    CLI::App* parser = app.add_subcommand(name, "Not in this version");
    parser->allow_extras();
    parser->group("Not in this version");
    verbs.push_back({parser, [name](const Context&) -> int {
                       throw InputError(std::string("'") + name +
                                        "' is not in this version; `espdiff --help` lists what is");
                     }});
  }
  return verbs;
}

}  // namespace espdiff::cli
