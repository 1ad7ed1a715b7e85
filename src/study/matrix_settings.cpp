// matrix_settings.cpp: the table of a matrix' own options.
#include "study/matrix_settings.h"

namespace espdiff {

const std::vector<OptionRow<MatrixStudy>>& matrix_settings() {
  using Rows = RowsOf<MatrixStudy>;
  static const std::vector<Rows::Row> all{
      Rows::text(
          "cluster-by", "Groups", [](auto& o) -> auto& { return o.run.cluster_by; },
          "Metric for clustering (mean_abs_difference; without potentials mean_displacement_A)"),
      Rows::text(
          "template", "Template", [](auto& o) -> auto& { return o.template_text; },
          "Map the surface of one structure onto each variant, and compare all variants in its vertices: a mapping for "
          "each variant instead of each pair, and differences of potentials only. medoid: the variant nearest to all "
          "others; a label; a number from 0; a structure file. The potentials stay in OUT.h5"),
      Rows::count(
          "exact-sample", "Template", kNotNegative, [](auto& o) -> auto& { return o.n_exact; },
          "With a template: pairs, chosen at random, that are compared by themselves as well, to tell how far the "
          "template's are from exact ones; 0 for none"),
      Rows::boolean(
          "resume", "Run", [](auto& o) -> auto& { return o.run.resume; },
          "Resume an interrupted run from its state file OUT.state"),
      Rows::boolean(
          "overwrite", "Run", [](auto& o) -> auto& { return o.run.overwrite; },
          "Start again and replace results and state files"),
      Rows::choice_of<bool>(
          "on-error", "Run", {{"stop", false}, {"skip", true}}, [](auto& o) -> auto& { return o.run.skip_errors; },
          "A pair that cannot be compared stops the run, or is skipped and noted in the results"),
      Rows::parsed(
          "shard", "Run", [](MatrixStudy& o, const std::string& text) { o.run.shard = parse_shard(text); },
          [](const MatrixStudy& o) { return to_string(o.run.shard); },
          "Compute part I of N of the pairs, I/N, into OUT.shard-I-of-N.state; `espdiff merge` merges the parts "
          "together")};
  return all;
}

const std::vector<OptionRow<MatrixStudy>>& merge_settings() {
  static const std::vector<OptionRow<MatrixStudy>> all = [] {
    std::vector<OptionRow<MatrixStudy>> rows;
    for (const OptionRow<MatrixStudy>& row : matrix_settings()) {
      if (row.name == "cluster-by" || row.name == "overwrite") rows.push_back(row);
    }
    rows.back().help = "Replace results that exist";  // there is no run to start again
    return rows;
  }();
  return all;
}

}  // namespace espdiff
