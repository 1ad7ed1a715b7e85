// ensemble_result.cpp: from columns to groups, tests, residues and patches.
#include "ensemble/result/ensemble_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/formatted.h"
#include "base/molecule/earlier_patch.h"
#include "base/not_a_number.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_conclusion.h"
#include "ensemble/result/template_patches.h"
#include "statistics/control_together.h"
#include "statistics/false_discovery.h"
#include "statistics/replicate_columns.h"
#include "statistics/test_places.h"
#include "statistics/test_replicates.h"
#include "statistics/test_within_runs.h"

namespace espdiff {
namespace {

constexpr double kFewEffective = 20;
using Means = std::vector<std::vector<double>>;

double median(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }), values.end());
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double mean_abs_between(const std::vector<double>& a, const std::vector<double>& b, const MeshGraph& graph,
                        const std::vector<char>& tested) {
  double sum = 0, area = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    if (tested[v] == 0 || !std::isfinite(a[v]) || !std::isfinite(b[v])) continue;
    sum += graph.area[v] * std::fabs(a[v] - b[v]);
    area += graph.area[v];
  }
  return sum / area;
}

/// The state of an analysis: begin(), test(), finish().
struct Analysis {
  const EnsembleFile& file;
  EnsembleResult result{};
  std::unique_ptr<EnsembleColumns> values{};
  std::vector<ReplicateColumns> columns{};
  std::vector<double> n_mapped{};  ///< [replicate] frames that count, without those that failed
  Means means{};                   ///< [replicate][vertex], NaN where not tested

  const EnsemblePlan& plan() const { return file.plan(); }
  std::size_t n_vertices() const { return file.n_vertices(); }

  void check_complete() const {
    const std::size_t n = plan().n_frames();
    if (file.n_done() == n) return;
    throw InputError(file.path() + " has " + std::to_string(file.n_done()) + " of " + std::to_string(n) + " frames; " +
                     switched_on("resume") + " computes the others");
  }

  void check_varies() const {
    for (std::size_t r = 0; r < columns.size(); ++r) {
      const auto& all = columns[r].columns;
      if (std::any_of(all.begin(), all.end(), [](const SeriesSummary& s) { return std::isfinite(s.inefficiency); }))
        continue;
      throw InputError((plan().field ? "values" : "the potentials") + (" of replicate " + plan().replicates[r].name) +
                       " of " + plan().replicates[r].group +
                       " do not change from frame to frame; are its frames copies of one structure?");
    }
  }

  void count_mapped(const std::vector<std::size_t>& starts) {
    for (std::size_t r = 0, first = 0; r < starts.size(); first += plan().replicates[r++].n_frames) {
      n_mapped.push_back(0);
      for (std::size_t f = starts[r]; f < plan().replicates[r].n_frames; ++f)
        n_mapped.back() += std::isfinite(file.numbers(first + f).mean_potential) ? 1 : 0;
    }
  }

  void make_group(const std::string& name) {
    GroupColumns group;
    group.name = name;
    const std::vector<std::size_t> members = plan().replicates_of(name);
    group.n_replicates = members.size();
    for (std::size_t v = 0; v < n_vertices(); ++v) {
      double mean = 0, variance = 0, effective = 0, trusted = 0, frames = 0;
      for (const std::size_t r : members) {
        const SeriesSummary& s = columns[r].columns[v];
        mean += s.mean / static_cast<double>(members.size());
        variance += s.variance / static_cast<double>(members.size());
        effective += std::isfinite(s.effective) ? s.effective : 0;
        trusted += static_cast<double>(s.n);
        frames += n_mapped[r];
      }
      group.mean.push_back(mean);
      group.deviation.push_back(std::sqrt(variance));
      group.effective.push_back(effective);
      group.trusted.push_back(trusted / frames);
    }
    result.groups.push_back(std::move(group));
  }

  void choose_tested() {
    result.tested.assign(n_vertices(), 1);
    for (std::size_t v = 0; v < n_vertices(); ++v) {
      for (const GroupColumns& group : result.groups) {
        if (1 - group.trusted[v] > result.options.most_missing || !std::isfinite(group.mean[v])) result.tested[v] = 0;
      }
      result.area_A2 += result.graph.area[v];
      if (result.tested[v] != 0) result.tested_area_A2 += result.graph.area[v];
    }
    if (result.tested_area_A2 == 0)
      throw InputError("no vertex of the template is trusted in " +
                       std::to_string(std::lround(100 - 100 * result.options.most_missing)) +
                       " % of each group's frames; the frames differ too much from the template: " +
                       option("most-missing") + " allows more, or take another " + option("template"));
    for (const ReplicateColumns& replicate : columns) {
      means.emplace_back();
      for (std::size_t v = 0; v < n_vertices(); ++v)
        means.back().push_back(result.tested[v] != 0 ? replicate.columns[v].mean : kNaN);
    }
  }

  void summarize_replicate(std::size_t r, std::size_t first, std::size_t start) {
    const EnsembleReplicate& replicate = plan().replicates[r];
    ReplicateSummary s;
    s.group = replicate.group;
    s.name = replicate.name;
    s.n_frames = replicate.n_frames;
    s.n_cut_off = start;
    std::vector<double> g, effective, ratio;
    for (std::size_t v = 0; v < n_vertices(); ++v) {
      if (result.tested[v] == 0) continue;
      const SeriesSummary& column = columns[r].columns[v];
      g.push_back(column.inefficiency);
      effective.push_back(column.effective);
      ratio.push_back(column.error_by_blocks / column.error);
    }
    s.inefficiency = median(g);
    s.effective = median(effective);
    s.error_ratio = median(ratio);
    std::vector<double> weights(n_vertices());
    for (std::size_t v = 0; v < n_vertices(); ++v) {
      weights[v] = result.tested[v] != 0 ? result.graph.area[v] : 0;
      s.trusted_area_fraction += result.graph.area[v] * static_cast<double>(columns[r].columns[v].n);
    }
    s.trusted_area_fraction /= result.area_A2 * n_mapped[r];
    s.drift = measure_drift(columns[r].blocks, weights);
    double potential = 0, rmsd = 0;
    for (std::size_t f = start; f < replicate.n_frames; ++f) {
      const EnsembleFrame frame = file.numbers(first + f);
      if (!std::isfinite(frame.mean_potential)) {
        ++s.n_failed;
        continue;
      }
      s.n_not_trustworthy += frame.trustworthy ? 0U : 1U;
      potential += frame.mean_potential;
      rmsd += frame.rmsd_A;
    }
    const auto n = static_cast<double>(replicate.n_frames - start - s.n_failed);
    s.mean_potential = potential / n;
    s.mean_rmsd_A = rmsd / n;
    result.replicates.push_back(s);
  }

  void measure_noise() {
    NoiseFloor& noise = result.noise;
    for (const GroupColumns& group : result.groups) {
      const std::vector<std::size_t> members = plan().replicates_of(group.name);
      std::vector<double> first(n_vertices(), 0), second(n_vertices(), 0);
      for (const std::size_t r : members) {
        for (std::size_t v = 0; v < n_vertices(); ++v) {
          first[v] += columns[r].first_half[v] / static_cast<double>(members.size());
          second[v] += columns[r].second_half[v] / static_cast<double>(members.size());
        }
      }
      noise.halves.push_back(mean_abs_between(first, second, result.graph, result.tested));
      double sum = 0;
      std::size_t n = 0;
      for (std::size_t i = 0; i < members.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j, ++n)
          sum += mean_abs_between(means[members[i]], means[members[j]], result.graph, result.tested);
      }
      noise.replicates.push_back(n > 0 ? sum / static_cast<double>(n) : kNaN);
    }
    noise.across = kNaN;
    if (result.groups.size() < 2) return;
    double sum = 0, n = 0;
    for (const std::size_t i : plan().replicates_of(result.groups[0].name)) {
      for (const std::size_t j : plan().replicates_of(result.groups[1].name)) {
        sum += mean_abs_between(means[i], means[j], result.graph, result.tested);
        ++n;
      }
    }
    noise.across = sum / n;
  }

  std::size_t n_first_replicates() const { return plan().replicates_of(result.groups[0].name).size(); }

  void begin(const EnsembleOptions& options) {
    check_complete();
    result.options = options;
    result.graph = make_mesh_graph(file.surface().positions, file.surface().triangles);
    const std::vector<std::size_t> starts = equilibrated_starts(file, options.equilibration);
    values = std::make_unique<EnsembleColumns>(file, starts);
    columns = summarize_columns(*values);
    check_varies();
    count_mapped(starts);
    for (const std::string& group : plan().groups()) make_group(group);
    choose_tested();
    for (std::size_t r = 0, first = 0; r < starts.size(); first += plan().replicates[r++].n_frames)
      summarize_replicate(r, first, starts[r]);
    measure_noise();
    result.compares = result.groups.size() == 2;
  }

  void test() {
    if (result.options.regression)
      result.regression = EnsembleRegression{
          *result.options.regression,
          regress_on_surface(means, result.options.regression->values, result.graph, result.options.test)};
    if (!result.compares) return;
    const std::size_t n_first = n_first_replicates();
    const std::size_t n_second = columns.size() - n_first;
    SurfaceTestOptions options = result.options.test;
    options.confidence = 1 - result.options.alpha;
    result.test = std::min(n_first, n_second) > 1
                      ? test_replicates(means, n_first, result.graph, options)
                      : test_within_runs(*values, columns, n_first, result.tested, result.graph, options);
  }

  void finish() {
    if (result.compares) find_significant(n_first_replicates());
    summarize_residues();
    measure_fixed_patches();
    find_regressed();
    judge_equilibrium();
    warn();
    result.conclusion = conclusion_of(result, plan().potential_unit);
  }

  /// Residues with their shares of a patch's area, largest first.
  std::vector<std::pair<std::string, double>> shares_of(const SignificantPatch& patch) const {
    std::map<std::int32_t, double> shares;
    for (const std::uint32_t v : patch.vertices) shares[file.surface().residue[v]] += result.graph.area[v] / patch.area;
    std::vector<std::pair<std::string, double>> residues;
    residues.reserve(shares.size());
    for (const auto& [index, share] : shares)
      residues.emplace_back(index < 0 ? "none" : plan().residues.at(static_cast<std::size_t>(index)), share);
    std::stable_sort(residues.begin(), residues.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return residues;
  }

  void find_regressed() {
    if (!result.regression) return;
    EnsembleRegression& regression = *result.regression;
    const SurfaceRegression& surface = regression.surface;
    const std::vector<double>& p = result.options.control == ErrorControl::kTfce ? surface.p_tfce : surface.p_max_t;
    for (SignificantPatch& found : find_patches(p, surface.t, result.options.alpha, result.graph)) {
      EnsembleRegression::Patch patch;
      for (const std::uint32_t v : found.vertices) {
        const double share = result.graph.area[v] / found.area;
        patch.correlation += share * surface.correlation[v];
        patch.slope += share * surface.slope[v];
        patch.smallest_p = std::min(patch.smallest_p, p[v]);
      }
      patch.residues = shares_of(found);
      patch.patch = std::move(found);
      regression.patches.push_back(std::move(patch));
    }
  }

  void find_significant(std::size_t n_first) {
    const std::vector<double>& p = result.family_wise();
    std::vector<std::vector<std::uint32_t>> members;
    for (SignificantPatch& found :
         find_patches(p, result.test.vertices.difference, result.options.alpha, result.graph)) {
      EnsemblePatch patch;
      for (const std::uint32_t v : found.vertices) patch.smallest_p = std::min(patch.smallest_p, p[v]);
      patch.residues = shares_of(found);
      members.push_back(found.vertices);
      result.significant_area_A2 += found.area;
      patch.patch = std::move(found);
      result.patches.push_back(std::move(patch));
    }
    result.patch_tests = test_places(result.test, means, n_first, result.graph, members, 1 - result.options.alpha);
  }

  void summarize_residues() {
    const auto& residue = file.surface().residue;
    std::vector<std::vector<std::uint32_t>> members(plan().residues.size());
    result.residues.resize(members.size());
    for (std::uint32_t v = 0; v < n_vertices(); ++v) {
      if (residue[v] < 0 || result.tested[v] == 0) continue;
      const auto i = static_cast<std::size_t>(residue[v]);
      members[i].push_back(v);
      result.residues[i].area_A2 += result.graph.area[v];
      if (result.compares && result.family_wise()[v] <= result.options.alpha)
        result.residues[i].significant_area_A2 += result.graph.area[v];
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      result.residues[i].label = plan().residues[i];
      for (const GroupColumns& group : result.groups) {
        double sum = 0;
        for (const std::uint32_t v : members[i]) sum += result.graph.area[v] * group.mean[v];
        result.residues[i].means.push_back(members[i].empty() ? kNaN : sum / result.residues[i].area_A2);
      }
    }
    if (!result.compares) return;
    const std::size_t n_first = plan().replicates_of(result.groups[0].name).size();
    result.residue_tests = test_places(result.test, means, n_first, result.graph, members, 1 - result.options.alpha);
    const std::vector<double> adjusted = adjust_for_false_discovery(result.residue_tests.p);
    for (std::size_t i = 0; i < members.size(); ++i) result.residues[i].adjusted_p = adjusted[i];
  }

  bool is_of_these_runs(const EarlierPatch& patch) const {
    const auto& runs = patch.runs_sha256;
    return std::any_of(plan().replicates.begin(), plan().replicates.end(), [&](const EnsembleReplicate& replicate) {
      return std::any_of(replicate.sha256.begin(), replicate.sha256.end(), [&](const std::string& sha256) {
        return std::find(runs.begin(), runs.end(), sha256) != runs.end();
      });
    });
  }

  /// [vertex] nonzero in the patch; finds the place of an earlier one.
  std::vector<std::uint8_t> vertices_of(FixedPatch& patch) {
    std::vector<std::uint8_t> inside = vertices_on_template(patch, file.surface(), plan().residues);
    if (patch.earlier == nullptr) return inside;
    if (is_of_these_runs(*patch.earlier))
      result.warnings.push_back("patch " + patch.name +
                                " was found significant in frames that are measured here again: its difference is too "
                                "large, and its p means nothing; measure it in other simulations");
    return inside;
  }

  void measure_fixed_patches() {
    std::vector<std::vector<std::uint32_t>> members;
    for (FixedPatch patch : result.options.fixed_patches) {
      members.emplace_back();
      const std::vector<std::uint8_t> inside = vertices_of(patch);
      for (std::uint32_t v = 0; v < n_vertices(); ++v) {
        if (inside[v] == 0 || result.tested[v] == 0) continue;
        members.back().push_back(v);
        patch.area_A2 += result.graph.area[v];
      }
      if (members.back().empty())
        throw InputError(option("patch") + " " + patch.name +
                         ": nothing of it has surface that was tested; choose another place");
      for (const GroupColumns& group : result.groups) {
        double sum = 0;
        for (const std::uint32_t v : members.back()) sum += result.graph.area[v] * group.mean[v];
        patch.means.push_back(sum / patch.area_A2);
      }
      result.fixed_patches.push_back(std::move(patch));
    }
    if (!result.compares) return;
    const std::size_t n_first = plan().replicates_of(result.groups[0].name).size();
    result.fixed_patch_tests =
        test_places(result.test, means, n_first, result.graph, members, 1 - result.options.alpha);
  }

  /// A run that drifts, or a single run of a state with few effective samples, says nothing about a state.
  void judge_equilibrium() {
    const double level = kDriftLevel / static_cast<double>(result.replicates.size());
    for (const ReplicateSummary& r : result.replicates) {
      const bool alone = plan().replicates_of(r.group).size() == 1;
      if (r.drift.p <= level && r.drift.share >= kDriftShare) {
        result.not_equilibrium.push_back(
            formatted("replicate %s of %s drifts: %.0f %% of the variance between its tenths is a trend",
                      r.name.c_str(), r.group.c_str(), 100 * r.drift.share));
      } else if (alone && r.effective < kFewEffective) {
        result.not_equilibrium.push_back(
            formatted("%s has one replicate, of %.0f effective samples", r.group.c_str(), r.effective));
      }
    }
  }

  /// One warning for all of them: the table has each number.
  void warn_of_short_replicates() {
    const ReplicateSummary* fewest = nullptr;
    std::size_t n_short = 0;
    for (const ReplicateSummary& r : result.replicates) {
      if (r.effective >= kFewEffective) continue;
      ++n_short;
      if (fewest == nullptr || r.effective < fewest->effective) fewest = &r;
    }
    if (n_short == 0) return;
    const std::string name = "replicate " + fewest->name + " of " + fewest->group;
    result.warnings.push_back(
        n_short == 1
            ? formatted(
                  "%s has %.0f effective samples (median over the surface), fewer than %.0f: its mean may not have "
                  "converged",
                  name.c_str(), fewest->effective, kFewEffective)
            : formatted("%zu of %zu replicates have fewer than %.0f effective samples (median over the surface), the "
                        "fewest, %.0f, %s: their means may not have converged",
                        n_short, result.replicates.size(), kFewEffective, fewest->effective, name.c_str()));
  }

  void warn() {
    const std::string design = design_warning(plan());
    if (!design.empty()) result.warnings.push_back(design);
    if (!file.has_trust())
      result.warnings.push_back(
          "an earlier version made the file, which does not say where its frames trust the mapping: all that has a "
          "counterpart counts as trusted");
    warn_of_short_replicates();
    constexpr double kLeastTested = 0.5;  // as a pair needs, by default, to be trustworthy on a part
    if (result.tested_share() < kLeastTested)
      result.warnings.push_back(formatted(
          "only %.0f %% of the template's area is tested: the rest is not trusted in more than %.0f %% of a group's "
          "frames",
          std::floor(100 * result.tested_share()), 100 * result.options.most_missing));
  }
};

}  // namespace

std::vector<float> where_tested(const std::vector<double>& values, const std::vector<char>& tested) {
  std::vector<float> out;
  for (std::size_t v = 0; v < values.size(); ++v)
    out.push_back(tested[v] != 0 ? static_cast<float>(values[v]) : std::numeric_limits<float>::quiet_NaN());
  return out;
}

EnsembleResult analyse_ensemble(const EnsembleFile& file, const EnsembleOptions& options) {
  Analysis a{file};
  a.begin(options);
  if (file.plan().n_fields > 1)
    a.result.warnings.push_back(formatted(
        "family-wise p are over the surface of this field alone, one of %zu; compute the statistics of all of them "
        "together",
        file.plan().n_fields));
  a.test();
  a.finish();
  return std::move(a.result);
}

std::vector<FieldStatistics> analyse_fields(const std::vector<const EnsembleFile*>& files,
                                            const EnsembleOptions& options) {
  std::vector<FieldStatistics> all(files.size());
  std::vector<std::unique_ptr<Analysis>> analyses;
  const auto each = [&](const auto& step) {
    for (std::size_t k = 0; k < analyses.size(); ++k) {
      try {
        if (all[k].why_not.empty()) step(*analyses[k]);
      } catch (const InputError& error) {
        all[k].why_not = error.what();
      }
    }
  };
  for (const EnsembleFile* file : files) analyses.push_back(std::make_unique<Analysis>(Analysis{*file}));
  EnsembleOptions together = options;
  each([&](Analysis& a) { a.begin(options); });
  each([&](Analysis& a) {
    together.test.least_inefficiency =
        std::max(together.test.least_inefficiency, inefficiency_of_runs(a.columns, a.result.tested));
  });
  std::vector<SurfaceTest*> tests;
  std::vector<SurfaceRegression*> regressions;
  each([&](Analysis& a) {
    a.result.options = together;
    a.test();
    if (a.result.compares) tests.push_back(&a.result.test);
    if (a.result.regression) regressions.push_back(&a.result.regression->surface);
  });
  control_together(tests);
  control_together(regressions);
  each([&](Analysis& a) {
    a.result.n_together = std::max(tests.size(), regressions.size());
    a.finish();
  });
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (all[k].why_not.empty()) all[k].result = std::move(analyses[k]->result);
  }
  return all;
}

}  // namespace espdiff
