// merge.cpp: `espdiff merge PART.state... -o OUT`.
#include <iostream>

#include "cli/verbs.h"
#include "matrix/matrix_run.h"
#include "matrix/write_matrix.h"

namespace espdiff::cli {
namespace {

struct Arguments {
  std::vector<std::string> states;
  MatrixRun run;
  bool quiet = false;
};

int run(const Arguments& a, const Context&) {
  const MatrixReport report = merge_matrix(a.states, a.run);
  if (a.quiet) return 0;
  const Matrix& matrix = *report.matrix;
  print_matrix(std::cout, matrix, metric_to_cluster_by(a.run, matrix));
  std::cout << "written:";
  for (const std::string& file : report.files) std::cout << ' ' << file;
  std::cout << '\n';
  return 0;
}

}  // namespace

Verb add_merge(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* parser = app.add_subcommand("merge", "Merge the parts of a matrix");
  parser->footer(
      "The parts are the state files of `espdiff matrix --shard I/N`. The results are those of one process, byte by "
      "byte.\n\n"
      "Example:\n  espdiff merge part.shard-*-of-8.state -o all");
  parser->add_option("STATE", a->states, "State files of all parts")->required();
  parser->add_option("-o,--output", a->run.output, "Prefix of the results OUT.csv and OUT.json")->required();
  parser->add_option("--cluster-by", a->run.cluster_by, "Metric for clustering, as in `espdiff matrix`");
  parser->add_flag("--overwrite", a->run.overwrite, "Replace results that exist");
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  return {parser, [a](const Context& context) { return run(*a, context); }};
}

}  // namespace espdiff::cli
