// show.cpp: `espdiff show OUT`.
#include <iostream>
#include <memory>
#include <string>

#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "report/compare_answer.h"
#include "report/compare_table.h"
#include "report/records/pair_files.h"

namespace espdiff::cli {

Verb add_show(CLI::App& app) {
  auto input = std::make_shared<std::string>();
  auto brief = std::make_shared<bool>(false);
  CLI::App* parser = app.add_subcommand("show", "Print every number of a comparison, and its certificate");
  parser->add_option("OUT", *input, "A result of compare: its prefix, OUT.json or OUT.vtp")->required();
  parser->add_flag("--brief", *brief, "Print the answer alone, as compare does");
  set_help(*parser, {"", {"espdiff show ldh", "espdiff show ldh.json --brief"}});
  return {parser, [input, brief](const Context&) {
            const nlohmann::ordered_json record = read_comparison_record(result_prefix(*input) + ".json");
            if (*brief) {
              print_answer(std::cout, record, "");
            } else {
              print_table(std::cout, record);
            }
            return 0;
          }};
}

}  // namespace espdiff::cli
