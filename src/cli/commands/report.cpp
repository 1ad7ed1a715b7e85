// report.cpp: `espdiff report OUT`.
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "page/result_page.h"

namespace espdiff::cli {
namespace {

struct ReportArguments {
  std::string input, output, title;
  std::vector<std::string> range_of;
  bool overwrite = false;
};

/// OUT of a result that is named by it or by one of its files, a trajectory's OUT.csv among them.
std::string report_prefix(const std::string& given) {
  const std::string prefix = result_prefix(given), ending = ".csv";
  const bool is_table = prefix.size() > ending.size() && prefix == given &&
                        prefix.compare(prefix.size() - ending.size(), ending.size(), ending) == 0;
  return is_table ? prefix.substr(0, prefix.size() - ending.size()) : prefix;
}

int report_verb(const ReportArguments& a, const Context& context) {
  const std::string prefix = report_prefix(a.input), output = a.output.empty() ? prefix + ".html" : a.output;
  check_outputs(page_inputs(prefix), {output}, a.overwrite);
  std::vector<std::string> range_of;
  for (const std::string& other : a.range_of) range_of.push_back(surface_of_result(other));
  context.progress->report("page", 0.0);
  AtomicFile file(output);
  file.stream() << result_page(prefix, a.title, range_of);
  file.commit();
  return 0;
}

}  // namespace

Verb add_report(CLI::App& app) {
  auto a = std::make_shared<ReportArguments>();
  CLI::App* parser = app.add_subcommand("report", "Write a result as one page for any browser, without network");
  parser
      ->add_option("OUT", a->input,
                   "A result of compare, trajectory, matrix or ensemble: its prefix, or one of its files")
      ->required();
  parser->add_option("-o,--output", a->output, "Page to write; default: OUT.html")->type_name("FILE");
  add_overwrite(*parser, a->overwrite);
  parser->add_option("--title", a->title, "Heading; default: the names of both structures or groups, or OUT");
  add_range_of(*parser, a->range_of);
  set_help(*parser, {"",
                     {"espdiff report ldh -o ldh.html --title 'LDH, double mutant against wild type'",
                      "espdiff report adk.csv"}});
  return {parser, [a](const Context& context) { return report_verb(*a, context); }};
}

}  // namespace espdiff::cli
