// ensemble_table.cpp: the printed answer.
#include "ensemble/result/ensemble_table.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "base/formatted.h"
#include "base/units.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_result.h"
#include "potential/potential_settings.h"
#include "report/records/record.h"
#include "report/sections/placement.h"

namespace espdiff {
namespace {

/// Three decimals, "-" without a value.
std::string value(double number) { return std::isfinite(number) ? formatted("%.3f", number) : "-"; }

/// "43 %", "-" without a value.
std::string percent(double share) { return std::isfinite(share) ? formatted("%.0f %%", 100 * share) : "-"; }

/// A text in lines of at most 100 bytes, the further ones below the text.
std::string broken(std::string text) {
  constexpr std::size_t kWidth = 100;
  std::size_t start = 0;
  while (text.size() - start > kWidth) {
    const std::size_t blank = text.rfind(' ', start + kWidth);
    if (blank == std::string::npos || blank <= start + 13) break;
    text.replace(blank, 1, "\n             ");
    start = blank + 1;
  }
  return text;
}

void print_replicates(std::ostream& out, const EnsembleResult& result) {
  out << formatted("%-10s %-20s %7s %6s %7s %6s %9s %9s %8s %8s\n", "group", "replicate", "frames", "g", "eff.",
                   "trend", "mean", "RMSD (A)", "trusted", "refused");
  for (const ReplicateSummary& r : result.replicates)
    out << formatted("%-10.10s %-20.20s %7zu %6.1f %7.1f %6s %9.3f %9.2f %8s %8zu\n", r.group.c_str(), r.name.c_str(),
                     r.n_frames - r.n_cut_off - r.n_failed, r.inefficiency, r.effective, percent(r.drift.share).c_str(),
                     r.mean_potential, r.mean_rmsd_A, percent(r.trusted_area_fraction).c_str(), r.n_not_trustworthy);
}

/// What a p is a statement about, where that is not the states.
const char* of_runs(const EnsembleResult& result) {
  const bool of_states = result.test.inference == Inference::kReplicates && result.not_equilibrium.empty();
  return of_states ? "" : " (of these runs, not of the states)";
}

/// " (kT/e)"; nothing for a field without a unit.
std::string in_brackets(const std::string& unit) { return unit.empty() ? "" : " (" + unit + ")"; }

void print_noise(std::ostream& out, const EnsembleResult& result, const std::string& unit) {
  out << "\nmean absolute difference over the tested surface" << in_brackets(unit) << '\n';
  if (result.compares) {
    const SurfaceTest& test = result.test;
    const std::string groups = result.groups[1].name + " - " + result.groups[0].name;
    const char* const null =
        test.inference == Inference::kReplicates ? "with exchanged labels, median" : "with exchanged blocks, median";
    out << formatted(
        "  %-44.44s %8s%s\n", groups.c_str(), value(test.mean_abs_difference).c_str(),
        result.has_p() ? formatted("   p%s = %.3g", of_runs(result), test.mean_abs_difference_p).c_str() : "");
    out << formatted("  %-44s %8s\n", null, value(test.mean_abs_difference_exchanged).c_str());
    out << formatted("  %-44s %8s\n", "one replicate of each group, mean of pairs", value(result.noise.across).c_str());
  }
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    const std::string name = result.groups[g].name;
    out << formatted("  %-44.44s %8s\n", ("two replicates of " + name + ", mean of pairs").c_str(),
                     value(result.noise.replicates[g]).c_str());
    out << formatted("  %-44.44s %8s\n", ("first and second halves, " + name).c_str(),
                     value(result.noise.halves[g]).c_str());
  }
}

void print_fixed_patches(std::ostream& out, const EnsembleResult& result, const std::string& unit) {
  if (result.fixed_patches.empty()) return;
  out << "\nfixed patches" << in_brackets(unit) << '\n';
  const PlaceTests& t = result.fixed_patch_tests;
  for (std::size_t k = 0; k < result.fixed_patches.size(); ++k) {
    const FixedPatch& patch = result.fixed_patches[k];
    out << formatted("  %-20.20s %8.1f A^2", patch.name.c_str(), patch.area_A2);
    for (std::size_t g = 0; g < result.groups.size(); ++g)
      out << formatted("  %.12s %s", result.groups[g].name.c_str(), value(patch.means[g]).c_str());
    if (result.compares)
      out << formatted("  diff. %s (%s to %s), p %.2g", value(t.difference[k]).c_str(), value(t.low[k]).c_str(),
                       value(t.high[k]).c_str(), t.p[k]);
    out << '\n';
    if (patch.placement != nullptr) out << "    " << in_words(*patch.placement) << '\n';
  }
}

/// The largest shares, until they are most of the patch.
std::string main_residues(const std::vector<std::pair<std::string, double>>& residues) {
  std::string text;
  double sum = 0;
  for (std::size_t i = 0; i < residues.size() && i < 3 && sum < 0.75; ++i) {
    text += (text.empty() ? "" : ", ") + residues[i].first + formatted(" %.0f %%", 100 * residues[i].second);
    sum += residues[i].second;
  }
  return text;
}

void print_patches(std::ostream& out, const EnsembleResult& result, const std::string& unit) {
  const double confidence = 100 * (1 - result.options.alpha);
  if (!result.has_p()) {
    out << "\nsignificant: not tested, since " << result.why_no_p() << '\n';
    return;
  }
  out << formatted(
      "\nsignificant: %.1f A^2 of %.1f A^2 tested (%.1f %%), family-wise p%s <= %.3g by %s; smallest possible p %.3g\n",
      result.significant_area_A2, result.tested_area_A2, 100 * result.significant_area_A2 / result.tested_area_A2,
      of_runs(result), result.options.alpha, result.options.control == ErrorControl::kTfce ? "TFCE" : "max-t",
      result.test.smallest_p);
  if (result.patches.empty()) return;
  const std::string in_column = without_vacuum(unit);
  out << formatted("%-5s %10s %12s %20s %8s  %s\n", "patch", "area (A^2)", ("diff." + in_brackets(in_column)).c_str(),
                   formatted("%.0f %% interval", confidence).c_str(), "p", "residues");
  constexpr std::size_t kMost = 10;
  for (std::size_t k = 0; k < std::min(kMost, result.patches.size()); ++k) {
    const PlaceTests& t = result.patch_tests;
    out << formatted("%-6zu %9.1f %12.3f %20s %8.3g  %s\n", k + 1, result.patches[k].patch.area, t.difference[k],
                     formatted("%.3f to %.3f", t.low[k], t.high[k]).c_str(), result.patches[k].smallest_p,
                     main_residues(result.patches[k].residues).c_str());
  }
  if (result.patches.size() > kMost) out << "... and " << result.patches.size() - kMost << " smaller ones\n";
}

void print_regression(std::ostream& out, const EnsembleResult& result, const std::string& unit) {
  if (!result.regression) return;
  const EnsembleRegression& regression = *result.regression;
  const SurfaceRegression& surface = regression.surface;
  std::size_t n = 0;
  double area = 0;
  for (const double value : regression.column.values) n += std::isfinite(value) ? 1U : 0U;
  for (const EnsembleRegression::Patch& patch : regression.patches) area += patch.patch.area;
  out << formatted("\nregression on %.40s of %zu replicates, %s%zu orders\n", regression.column.name.c_str(), n,
                   surface.exact ? "all " : "", surface.n_permutations);
  out << formatted("  predicted from the others: Q2 %.3f, p %.3g\n", surface.q2, surface.q2_p);
  out << formatted("  significant: %.1f A^2 of %.1f A^2, family-wise p <= %.3g by %s; smallest possible p %.3g\n", area,
                   result.tested_area_A2, result.options.alpha,
                   result.options.control == ErrorControl::kTfce ? "TFCE" : "max-t", surface.smallest_p);
  for (std::size_t k = 0; k < std::min<std::size_t>(10, regression.patches.size()); ++k) {
    const EnsembleRegression::Patch& patch = regression.patches[k];
    out << formatted("  %-4zu %8.1f A^2  r %6.3f  %.3g%s per unit, p %.3g  %.40s\n", k + 1, patch.patch.area,
                     patch.correlation, patch.slope, (unit.empty() ? "" : " " + unit).c_str(), patch.smallest_p,
                     main_residues(patch.residues).c_str());
  }
}

void print_residues(std::ostream& out, const EnsembleResult& result) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < result.residues.size(); ++i) {
    if (result.residues[i].adjusted_p <= result.options.alpha) found.push_back(i);
  }
  const PlaceTests& t = result.residue_tests;
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
    return std::fabs(t.difference[a]) > std::fabs(t.difference[b]);
  });
  out << "\nresidues with a false discovery rate of at most " << result.options.alpha << ": " << found.size() << " of "
      << result.residues.size() << '\n';
  constexpr std::size_t kMost = 10;
  for (std::size_t k = 0; k < std::min(kMost, found.size()); ++k) {
    const std::size_t i = found[k];
    out << formatted("  %-24.24s %8.3f (%.3f to %.3f), adjusted p %.2g\n", result.residues[i].label.c_str(),
                     t.difference[i], t.low[i], t.high[i], result.residues[i].adjusted_p);
  }
}

void print_template_checks(std::ostream& out, const EnsembleResult& result) {
  if (result.template_checks.empty()) return;
  out << formatted("\n%-54s %10s %10s %8s %14s\n", "through another template", "mean diff.", "area (A^2)", "overlap",
                   "largest change");
  for (const TemplateCheck& check : result.template_checks)
    out << formatted("  %-52.52s %10.3f %10.1f %8s %14s\n", check.template_name.c_str(), check.mean_abs_difference,
                     check.significant_area_A2, value(check.overlap).c_str(), value(check.largest_change).c_str());
}

/// Mean scores of the groups beside each component's share.
void print_states(std::ostream& out, const EnsembleFile& file, const EnsembleResult& result) {
  if (!result.states) return;
  const StateTable& states = *result.states;
  out << formatted(
      "\nprincipal components of %zu frames, over %.1f %% of the area; mean scores in standard deviations\n",
      states.size(), 100 * states.area_fraction);
  for (std::size_t k = 0; k < states.components.size(); ++k) {
    out << formatted("  component %zu: %4.1f %% of the variance", k + 1, 100 * states.components[k].share);
    for (const GroupColumns& group : result.groups) {
      double sum = 0, n = 0;
      for (std::size_t i = 0; i < states.size(); ++i) {
        const auto replicate = file.plan().place_of(states.frames[i]).first;
        if (file.plan().replicates[replicate].group != group.name) continue;
        sum += states.components[k].scores[i];
        ++n;
      }
      out << formatted(";  %s %.2f", group.name.c_str(), sum / n);
    }
    out << '\n';
  }
}

}  // namespace

void print_ensemble(std::ostream& out, const EnsembleFile& file, const EnsembleResult& result,
                    const std::vector<std::string>& said) {
  const std::string& unit = file.plan().potential_unit;
  out << broken("conclusion   " + result.conclusion) << "\n\n";
  out << formatted("template     %s, %zu vertices, %.1f A^2\n", file.plan().template_name.c_str(), file.n_vertices(),
                   result.area_A2);
  out << formatted("tested       %.1f A^2 of it (%.0f %%), which at least %.0f %% of each group's frames trust\n",
                   result.tested_area_A2, std::floor(100 * result.tested_share()),
                   100 - 100 * result.options.most_missing);
  out << broken(file.plan().field ? "field        " + file.plan().potential
                                  : "potential    " + short_potential(file.plan().potential))
      << '\n';
  if (result.n_together > 1)
    out << formatted("family       p is family-wise over the surfaces of %zu fields together\n", result.n_together);
  if (result.compares && result.test.inference == Inference::kReplicates)
    out << formatted("inference    of the states: Welch's t of replicates' means; labels exchanged in %s%zu ways\n",
                     result.test.exact ? "all " : "", result.test.n_permutations);
  if (result.compares && result.test.inference == Inference::kWithinRuns)
    out << "inference    of these runs only, not of the states"
        << (result.test.no_p.empty()
                ? formatted(": %zu blocks of %zu frames exchanged in %s%zu ways", result.test.block_means.size(),
                            result.test.blocks.length, result.test.exact ? "all " : "", result.test.n_permutations)
                : "")
        << '\n';
  out << '\n';
  print_replicates(out, result);
  print_noise(out, result, unit);
  if (result.compares) {
    print_patches(out, result, unit);
    if (result.has_p()) print_residues(out, result);
    print_template_checks(out, result);
  }
  print_fixed_patches(out, result, unit);
  print_ensemble_causes(out, result, unit);
  print_regression(out, result, unit);
  print_states(out, file, result);
  for (const std::string& warning : result.warnings) {
    if (std::find(said.begin(), said.end(), warning) == said.end()) out << "\nwarning: " << warning << '\n';
  }
}

}  // namespace espdiff
