// ensemble_causes.cpp: takes patches apart in every frame, and compares the residues' contributions by replicate.
#include "ensemble/result/ensemble_causes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "causes/reading.h"
#include "compare/template_mapping.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/frames/map_frames.h"
#include "ensemble/result/ensemble_result.h"
#include "ensemble/result/template_patches.h"
#include "io/files/write_csv.h"
#include "matrix/matrix_run.h"
#include "options/options.h"
#include "report/sections/json_number.h"
#include "statistics/false_discovery.h"
#include "statistics/welch.h"

namespace espdiff {
namespace {

constexpr std::size_t kShownCauses = 8, kRecordedCauses = 20;

/// [vertex] area of a patch's tested vertices.
std::vector<double> areas_of_patch(const std::string& name, const EnsembleFile& file, const EnsembleResult& result) {
  std::vector<double> areas(result.tested.size(), 0.0);
  for (FixedPatch patch : result.fixed_patches) {
    if (patch.name != name) continue;
    const std::vector<std::uint8_t> inside = vertices_on_template(patch, file.surface(), file.plan().residues);
    for (std::size_t v = 0; v < areas.size(); ++v)
      areas[v] = inside[v] != 0 && result.tested[v] != 0 ? result.graph.area[v] : 0;
    return areas;
  }
  for (std::size_t k = 0; k < result.patches.size(); ++k) {
    if (std::to_string(k + 1) != name) continue;
    for (const std::uint32_t v : result.patches[k].patch.vertices) areas[v] = result.graph.area[v];
    return areas;
  }
  throw InputError(option("causes", "patch " + name) + ": there is no such patch; " +
                   std::to_string(result.patches.size()) +
                   " were found significant (patch 1 is the first of the "
                   "table), and others are selections that are named by " +
                   option("patch"));
}

/// Means over the frames of each replicate.
class Sums {
 public:
  Sums(std::size_t n_readings, std::size_t n_replicates, std::size_t n_residues)
      : sums_(n_readings, std::vector<std::vector<double>>(n_replicates, std::vector<double>(n_residues, 0.0))),
        n_(n_readings, std::vector<std::size_t>(n_replicates, 0)) {}

  void add(std::size_t reading, std::size_t replicate, const FrameReading& frame) {
    std::vector<double>& row = sums_[reading][replicate];
    for (std::size_t r = 0; r < frame.of_residue.size(); ++r) row[r] += frame.of_residue[r];
    row.back() += frame.others;
    ++n_[reading][replicate];
  }
  std::vector<std::vector<double>> means(std::size_t reading) const {
    std::vector<std::vector<double>> all = sums_[reading];
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (double& value : all[k]) value /= static_cast<double>(n_[reading][k]);
    }
    return all;
  }
  std::size_t n_frames(std::size_t reading) const {
    return std::accumulate(n_[reading].begin(), n_[reading].end(), std::size_t{0});
  }

 private:
  std::vector<std::vector<std::vector<double>>> sums_;  // [reading][replicate][residue]
  std::vector<std::vector<std::size_t>> n_;             // [reading][replicate] frames
};

/// Welch's test of each residue, replicates as samples.
void compare_groups(const EnsemblePlan& plan, const EnsembleResult& result, EnsembleCauses& causes) {
  const std::size_t n_residues = causes.residues.size();
  std::vector<std::vector<std::vector<double>>> values;  // [group][residue][replicate]
  for (const GroupColumns& group : result.groups) {
    values.emplace_back(n_residues);
    causes.means.emplace_back();
    for (std::size_t r = 0; r < n_residues; ++r) {
      for (const std::size_t k : plan.replicates_of(group.name)) values.back()[r].push_back(causes.of_replicate[k][r]);
      causes.means.back().push_back(group_moments(values.back()[r].data(), values.back()[r].size()).mean);
    }
  }
  PlaceTests& t = causes.tests;
  for (std::size_t r = 0; result.compares && r < n_residues; ++r) {
    const WelchTest test = welch_test(group_moments(values[0][r].data(), values[0][r].size()),
                                      group_moments(values[1][r].data(), values[1][r].size()));
    const double half = student_quantile(1 - result.options.alpha, test.degrees) * test.error;
    t.difference.push_back(test.difference);
    t.error.push_back(test.error);
    t.degrees.push_back(test.degrees);
    t.t.push_back(test.t);
    t.p.push_back(test.p);
    t.low.push_back(test.difference - half);
    t.high.push_back(test.difference + half);
  }
  causes.adjusted_p = adjust_for_false_discovery(t.p);
  causes.order.resize(n_residues);
  std::iota(causes.order.begin(), causes.order.end(), std::size_t{0});
  const std::vector<double>& sizes = result.compares ? t.difference : causes.means.front();
  std::stable_sort(causes.order.begin(), causes.order.end(),
                   [&](std::size_t a, std::size_t b) { return std::fabs(sizes[a]) > std::fabs(sizes[b]); });
}

std::vector<std::size_t> frames_of_statistics(const EnsembleFile& file, const EnsembleResult& result) {
  std::vector<std::size_t> frames;
  for (std::size_t f = 0; f < file.plan().n_frames(); ++f) {
    const auto [replicate, number] = file.plan().place_of(f);
    if (number >= result.replicates[replicate].n_cut_off && std::isfinite(file.numbers(f).mean_potential))
      frames.push_back(f);
  }
  return frames;
}

double sum_over_residues(const EnsembleCauses& causes, const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t r = 0; r < causes.residues.size(); ++r) sum += values[r];
  return sum;
}

}  // namespace

void check_ensemble_causes(const CompareOptions& options, const CompareInput& source, bool nonlinear) {
  if (options.scan || options.side_chains > 0)
    throw InputError(switched_on(options.scan ? "scan" : "side-chains") +
                     " is of one pair, not of an ensemble; compare two of its frames with it");
  if (options.causes.empty()) return;
  for (const std::string& text : options.causes) {
    if (parse_reading(text).of != ReadingOf::kPatch)
      throw InputError(option("causes", text) + ": an ensemble's causes are of a patch; give " +
                       option("causes", "patch NAME") + " of a " + option("patch") + ", or " +
                       option("causes", "patch 1") + " for the first that is found significant");
  }
  if (!source.make_map || nonlinear)
    throw InputError(option("causes") + " needs potentials that are computed by a linear equation: " +
                     (nonlinear ? "that of the nonlinear one is not a sum over charges"
                                : "those of given maps do not say which charges they are made of"));
}

std::vector<EnsembleCauses> find_ensemble_causes(Engine& engine, const CompareInput& source,
                                                 const CompareOptions& options, const EnsembleFile& file,
                                                 const EnsembleResult& result,
                                                 const std::function<HeldInput(std::size_t)>& read,
                                                 const Progress& progress,
                                                 const std::function<void(const Message&)>& tell) {
  std::vector<std::vector<double>> areas;
  for (const std::string& text : options.causes)
    areas.push_back(areas_of_patch(parse_reading(text).patch, file, result));
  CompareOptions of_potential = options;
  of_potential.fields.clear();
  TemplateMapping mapping(engine, source, of_potential, progress);
  mapping.take_apart(areas);
  std::vector<EnsembleCauses> all(areas.size());
  const EnsemblePlan& plan = file.plan();
  Sums sums(areas.size(), plan.replicates.size(), plan.residues.size() + 1);
  const std::vector<std::size_t> frames = frames_of_statistics(file, result);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const FramesToMap to_map{
      engine, mapping, frames.size(), source.molecule->size(), 0, [&](std::size_t i) { return read(frames[i]); }};
  const double at_once = frames_at_once(to_map);
  std::size_t n_done = 0;
  const Progress inner([&](const std::string&, double) {
    if (n_done == frames.size()) return;
    std::string text = formatted("causes: frame %zu of %zu is solved again", n_done + 1, frames.size());
    if (n_done > 0)
      text += ", " + in_words(seconds() / static_cast<double>(n_done) * static_cast<double>(frames.size() - n_done)) +
              " left";
    progress.report(text, static_cast<double>(n_done) / static_cast<double>(frames.size()));
  });
  const auto done = [&](std::size_t i, const TemplateFrame& frame) {
    for (std::size_t r = 0; r < areas.size(); ++r) {
      const FrameReading& reading = frame.readings[r];
      if (!std::isfinite(reading.mean)) continue;  // nothing of the patch has a value in this frame
      sums.add(r, plan.place_of(frames[i]).first, reading);
      const double sum = std::accumulate(reading.of_residue.begin(), reading.of_residue.end(), reading.others);
      all[r].sum_error = std::max(all[r].sum_error, std::fabs(sum - reading.mean));
    }
    if (i == 0 && frames.size() > 1)
      tell("the causes solve " + std::to_string(frames.size()) + " frames again, in about " +
           in_words(seconds() * static_cast<double>(frames.size()) / at_once));
    ++n_done;
  };
  const auto failed = [](std::size_t, const Error& error) { throw error; };
  inner.report("read", 0.0);
  map_frames(to_map, done, failed, inner);
  for (std::size_t r = 0; r < areas.size(); ++r) {
    all[r].reading = options.causes[r];
    all[r].residues = plan.residues;
    all[r].residues.emplace_back("others");
    all[r].n_frames = sums.n_frames(r);
    all[r].of_replicate = sums.means(r);
    compare_groups(plan, result, all[r]);
  }
  return all;
}

void write_ensemble_causes(std::ostream& out, const EnsembleResult& result) {
  std::vector<std::string> names = {"reading", "residue"};
  for (const GroupColumns& group : result.groups) names.push_back("mean_" + group.name);
  if (result.compares) names.insert(names.end(), {"difference", "low", "high", "t", "p", "p_false_discovery"});
  for (const ReplicateSummary& r : result.replicates) names.push_back(r.group + "/" + r.name);
  write_csv_row(out, names);
  for (const EnsembleCauses& causes : result.causes) {
    for (const std::size_t i : causes.order) {
      std::vector<std::string> row = {causes.reading, causes.residues[i]};
      for (const std::vector<double>& means : causes.means) row.push_back(csv_number(means[i]));
      const PlaceTests& t = causes.tests;
      if (result.compares) {
        for (const double value : {t.difference[i], t.low[i], t.high[i], t.t[i], t.p[i], causes.adjusted_p[i]})
          row.push_back(csv_number(value));
      }
      for (const std::vector<double>& replicate : causes.of_replicate) row.push_back(csv_number(replicate[i]));
      write_csv_row(out, row);
    }
  }
}

void print_ensemble_causes(std::ostream& out, const EnsembleResult& result, const std::string& unit) {
  for (const EnsembleCauses& causes : result.causes) {
    out << "\nwhose charges make the " << (result.compares ? "difference" : "potential") << " of " << causes.reading
        << ", " << unit << ": ";
    for (std::size_t g = 0; g < result.groups.size(); ++g)
      out << formatted("%.12s %+.3f, ", result.groups[g].name.c_str(), sum_over_residues(causes, causes.means[g]));
    out << formatted("%zu frames solved again,\n  contributions add up within %.1g\n", causes.n_frames,
                     causes.sum_error);
    for (std::size_t n = 0; n < std::min(kShownCauses, causes.order.size()); ++n) {
      const std::size_t i = causes.order[n];
      out << formatted("  %-24.24s", causes.residues[i].c_str());
      for (std::size_t g = 0; g < result.groups.size(); ++g)
        out << formatted("  %.12s %+.3f", result.groups[g].name.c_str(), causes.means[g][i]);
      if (result.compares) {
        const PlaceTests& t = causes.tests;
        out << formatted("  diff. %+.3f", t.difference[i]);
        if (std::isfinite(t.low[i]))
          out << formatted(" (%+.3f to %+.3f), p %.2g", t.low[i], t.high[i], causes.adjusted_p[i]);
      }
      out << '\n';
    }
    if (result.compares)
      out << "  intervals by replicate; p for the false discovery rate over " << causes.residues.size()
          << " residues\n";
  }
}

nlohmann::ordered_json ensemble_causes_json(const EnsembleResult& result) {
  auto all = nlohmann::ordered_json::array();
  for (const EnsembleCauses& causes : result.causes) {
    nlohmann::ordered_json reading{{"reading", causes.reading},
                                   {"n_frames", causes.n_frames},
                                   {"largest_deviation_of_sum", json_number(causes.sum_error)},
                                   {"means", nlohmann::ordered_json::object()},
                                   {"largest", nlohmann::ordered_json::array()}};
    for (std::size_t g = 0; g < result.groups.size(); ++g)
      reading["means"][result.groups[g].name] = json_number(sum_over_residues(causes, causes.means[g]));
    for (std::size_t n = 0; n < std::min(kRecordedCauses, causes.order.size()); ++n) {
      const std::size_t i = causes.order[n];
      nlohmann::ordered_json residue{{"residue", causes.residues[i]}, {"means", nlohmann::ordered_json::object()}};
      for (std::size_t g = 0; g < result.groups.size(); ++g)
        residue["means"][result.groups[g].name] = json_number(causes.means[g][i]);
      if (result.compares) {
        const PlaceTests& t = causes.tests;
        residue["difference"] = json_number(t.difference[i]);
        residue["low"] = json_number(t.low[i]);
        residue["high"] = json_number(t.high[i]);
        residue["p"] = json_number(t.p[i]);
        residue["p_false_discovery"] = json_number(causes.adjusted_p[i]);
      }
      reading["largest"].push_back(std::move(residue));
    }
    all.push_back(std::move(reading));
  }
  return all;
}

}  // namespace espdiff
