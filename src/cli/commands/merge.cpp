// merge.cpp: `espdiff merge PART.state... -o OUT`.
#include <iostream>

#include "cli/options.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_run.h"
#include "ensemble/file/ensemble_file.h"
#endif
#include "matrix/matrix_table.h"
#include "study/matrix_settings.h"
#include "study/matrix_study.h"

namespace espdiff::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> states;
  MatrixStudy study;  ///< its run only
  bool quiet = false;
};

#ifdef ESPDIFF_HAVE_HDF5
/// Parts of an ensemble.
int run_ensemble_merge(const MergeArguments& a) {
  EnsembleRun run;
  run.output = a.study.run.output;
  run.overwrite = a.study.run.overwrite;
  const EnsembleReport report = merge_ensemble(a.states, run);
  if (a.quiet) return 0;
  std::cout << report.n_frames << " frames merged into " << report.path << "; the statistics: espdiff ensemble --from "
            << report.path << " -o " << a.study.run.output << '\n';
  return 0;
}
#endif

int merge_verb(const MergeArguments& a, const Context&) {
#ifdef ESPDIFF_HAVE_HDF5
  if (is_hdf5_file(a.states.front()) && !are_template_parts(a.states)) return run_ensemble_merge(a);
#endif
  const MatrixReport report = merge_parts(a.states, a.study.run);
  if (a.quiet) return 0;
  const Matrix& matrix = *report.matrix;
  print_matrix(std::cout, matrix, metric_to_cluster_by(a.study.run, matrix));
  std::cout << "written:";
  for (const std::string& file : report.files) std::cout << ' ' << file;
  std::cout << '\n';
  return 0;
}

}  // namespace

Verb add_merge(CLI::App& app) {
  auto a = std::make_shared<MergeArguments>();
  CLI::App* parser = app.add_subcommand("merge", "Merge the parts of a matrix or an ensemble");
  parser->footer(
      "The parts are the state files of `espdiff matrix --shard I/N` (with --template the HDF5 files too), or the HDF5 "
      "files of `espdiff ensemble --shard I/N`. The results are those of one process, byte by byte.");
  parser->add_option("STATE", a->states, "State files, or HDF5 files, of all parts")->required();
  parser->add_option("-o,--output", a->study.run.output, "Prefix of the results: OUT.csv and OUT.json, or OUT.h5")
      ->required();
  add_rows(*parser, merge_settings(), a->study);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(*parser, {"", {"espdiff merge part.shard-*-of-8.state -o all"}});
  return {parser, [a](const Context& context) { return merge_verb(*a, context); }};
}

}  // namespace espdiff::cli
