// report.cpp: `espdiff report OUT`.
#include <memory>

#include "base/error.h"
#include "cli/help.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "io/atomic_file.h"
#include "io/check_outputs.h"
#include "page/report_page.h"

namespace espdiff::cli {
namespace {

struct ReportArguments {
  std::string input, output, title;
};

int report_verb(const ReportArguments& a, const Context& context) {
  const std::string prefix = result_prefix(a.input), output = a.output.empty() ? prefix + ".html" : a.output;
  check_outputs({prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"}, {output});
  context.progress->report("page", 0.0);
  AtomicFile file(output);
  file.stream() << report_page(prefix, a.title);
  file.commit();
  return 0;
}

}  // namespace

Verb add_report(CLI::App& app) {
  auto a = std::make_shared<ReportArguments>();
  CLI::App* parser = app.add_subcommand("report", "Write a comparison as one page for any browser, without network");
  parser->add_option("OUT", a->input, "A result of compare: its prefix, OUT.json or OUT.vtp")->required();
  parser->add_option("-o,--output", a->output, "Page to write; default: OUT.html")->type_name("FILE");
  parser->add_option("--title", a->title, "Heading; default: the names of both structures");
  set_help(*parser, {"", {"espdiff report ldh -o ldh.html --title 'LDH, double mutant against wild type'"}});
  return {parser, [a](const Context& context) { return report_verb(*a, context); }};
}

}  // namespace espdiff::cli
