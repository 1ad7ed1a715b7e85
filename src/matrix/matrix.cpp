// matrix.cpp: the order of the pairs, and one series per source.
#include "matrix/matrix.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "base/not_a_number.h"
#include "certificate/region_result.h"
#include "certificate/result.h"
#include "compare/series.h"
#include "engine/workers.h"
#include "io/text/text_cursor.h"
#include "options/input_settings.h"
#include "options/options.h"
#include "prepare/surface_radii.h"
#include "report/state_report.h"

namespace espdiff {
namespace {

std::vector<Metric> make_metrics(const PartsAndFields& compared) {
  std::vector<Metric> all;
  const auto add = [&](const std::vector<Metric>& some) {
    for (const Metric& metric : some) {
      if ((metric.flags & kInMatrix) != 0) all.push_back(metric);
    }
  };
  add(metrics());
  for (const std::string& part : compared.parts) add(part_metrics(part));
  add(all_field_metrics(compared));
  return all;
}

MatrixCell cell_of(const MatrixPair& pair, const CompareResult& result) {
  MatrixCell cell;
  cell.source = pair.first;
  cell.target = pair.second;
  const PartsAndFields compared = parts_and_fields(result);
  for (const Metric& metric : matrix_metrics(compared)) {
    const double value = value_of(metric, result);
    cell.values.push_back(std::isfinite(value) ? value : kNaN);
  }
  cell.converged = result.certificate.converged;
  cell.trustworthy = result.certificate.trustworthy;
  for (const std::string& part : compared.parts)
    cell.parts_trustworthy.push_back(part_of(result.parts, part)->certificate.trustworthy ? 1 : 0);
  for (const Message& reason : result.certificate.reasons) cell.reasons.push_back(reason.plain());
  for (const Warning& warning : result.inputs.warnings) {
    if (!warning.refuses) cell.warnings.push_back(warning.text.plain());  // those that refuse are reasons
  }
  return cell;
}

MatrixCell failed_cell(const MatrixPair& pair, const std::string& error, const PartsAndFields& compared) {
  MatrixCell cell;
  cell.source = pair.first;
  cell.target = pair.second;
  cell.values.assign(matrix_metrics(compared).size(), kNaN);
  cell.parts_trustworthy.assign(compared.parts.size(), 0);
  cell.error = error;
  return cell;
}

CompareInput input_of(const Variant& variant, const Molecule& molecule) {
  return {&molecule, variant.map ? &*variant.map : nullptr, variant.make_map, variant.parts, variant.fields};
}

Molecule with_element_radii(Molecule molecule) {
  set_surface_radii({&molecule}, RadiiChoice::kElement);
  return molecule;
}

/// The targets of one source. Its surface is made once by its own radii, and once by Bondi's for targets whose radii
/// are of another kind, as compare() takes them for such a pair.
class SourceOfPairs {
 public:
  SourceOfPairs(Engine& engine, const Variant& source, const CompareOptions& options)
      : engine_(engine), source_(source), options_(options) {}

  CompareResult compare(const Variant& target, const Progress& progress) {
    std::string note;
    if (options_.input.radii == RadiiChoice::kAuto) note = radii_conflict(source_.molecule, target.molecule);
    std::unique_ptr<Series>& series = note.empty() ? own_ : element_;
    if (series == nullptr && !note.empty()) molecule_ = with_element_radii(source_.molecule);
    if (series == nullptr)
      series =
          std::make_unique<Series>(engine_, input_of(source_, note.empty() ? source_.molecule : molecule_), options_);
    const Molecule other = note.empty() ? Molecule() : with_element_radii(target.molecule);
    CompareResult result =
        series->step(input_of(target, note.empty() ? target.molecule : other), StartFrom::kSource, progress);
    note_states(result, source_.origin, target.origin, note);
    if (!note.empty()) result.inputs.warnings.push_back({note + "; both surfaces take Bondi's radii by element"});
    return result;
  }

 private:
  Engine& engine_;
  const Variant& source_;
  const CompareOptions& options_;
  Molecule molecule_;  // with Bondi's radii
  std::unique_ptr<Series> own_, element_;
};

/// Pairs of one source follow each other, in groups that are few enough to prepare it seldom and enough to share out.
ItemGroups groups_of(const std::vector<MatrixPair>& pairs, int n_workers) {
  constexpr std::size_t kGroupsEach = 3;
  const std::size_t most = std::max<std::size_t>(1, pairs.size() / (kGroupsEach * static_cast<std::size_t>(n_workers)));
  ItemGroups groups{pairs.size(), {}};
  std::size_t first = 0;
  for (std::size_t p = 1; p <= pairs.size(); ++p) {
    if (p < pairs.size() && pairs[p].first == pairs[first].first && p - first < most) continue;
    groups.ends.push_back(p);
    first = p;
  }
  return groups;
}

}  // namespace

const std::vector<Metric>& matrix_metrics(const PartsAndFields& compared) {
  static std::mutex one_at_a_time;
  static std::map<PartsAndFields, std::vector<Metric>> known;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  std::vector<Metric>& all = known[compared];
  if (all.empty()) all = make_metrics(compared);
  return all;
}

std::size_t find_metric(const std::string& name, const PartsAndFields& compared) {
  std::string list;
  const std::vector<Metric>& all = matrix_metrics(compared);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
    list += (list.empty() ? "" : ", ") + std::string(all[i].name);
  }
  throw InputError("there is no metric '" + name + "'; there are: " + list);
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  long long index = 0, count = 0;
  if (slash == std::string::npos || !parse_integer(text.substr(0, slash), index) ||
      !parse_integer(text.substr(slash + 1), count) || count < 1 || index < 1 || index > count || count > 1000000)
    throw InputError(option("shard") + ": " + in_quotes(text) + " is not i/n with i from 1 to n, such as 2/8");
  return {static_cast<int>(index), static_cast<int>(count)};
}

std::string to_string(const Shard& shard) { return std::to_string(shard.index) + "/" + std::to_string(shard.count); }

std::vector<MatrixPair> matrix_pairs(std::size_t n_variants, const Shard& shard) {
  const std::size_t n = n_variants < 2 ? 0 : n_variants * (n_variants - 1);
  const auto count = static_cast<std::size_t>(shard.count), index = static_cast<std::size_t>(shard.index);
  constexpr double kBytesOfCell = 600;  // its values and reasons, and its place in the tables
  const auto n_here = static_cast<double>(index * n / count - (index - 1) * n / count);
  require_memory(kBytesOfCell * n_here, "a matrix of " + std::to_string(n_variants) + " variants, of whose " +
                                            std::to_string(n) + " ordered pairs this run has " +
                                            formatted("%.0f", n_here));
  std::vector<MatrixPair> pairs;
  for (std::size_t p = (index - 1) * n / count; p < index * n / count; ++p) {
    const std::size_t source = p / (n_variants - 1), rest = p % (n_variants - 1);
    pairs.emplace_back(source, rest < source ? rest : rest + 1);
  }
  return pairs;
}

void compute_pairs(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                   const std::vector<MatrixPair>& pairs, bool skip_errors,
                   const std::function<void(const MatrixCell&)>& done, const Progress& progress) {
  const PartsAndFields compared = parts_and_fields(options);
  std::size_t n_atoms = 1;
  for (const Variant& variant : variants) n_atoms = std::max(n_atoms, variant.molecule.size());
  const Workers workers = workers_for(engine, pairs.size(), kBytesOfAtom * static_cast<double>(n_atoms));
  std::vector<MatrixCell> cells(pairs.size());
  const auto name_of = [&](std::size_t p) {
    return variants.at(pairs[p].first).label + " to " + variants.at(pairs[p].second).label;
  };
  const auto begin = [&](Engine& of_thread) -> ComputeItem {
    auto prepared = std::make_shared<std::optional<SourceOfPairs>>();
    return [&, prepared, number = variants.size()](std::size_t p, const Progress& stages) mutable {
      const Variant &source = variants.at(pairs[p].first), &target = variants.at(pairs[p].second);
      const Progress named([&](const std::string& stage, double) { stages.report(name_of(p) + ": " + stage, 0); });
      if (number != pairs[p].first) prepared->emplace(of_thread, source, options);
      number = pairs[p].first;
      cells[p] = cell_of(pairs[p], (*prepared)->compare(target, named));
    };
  };
  const auto failed = [&](std::size_t p, const Error& error) {
    if (!skip_errors) throw Error(error.error_class(), name_of(p) + ": " + error.message());
    cells[p] = failed_cell(pairs[p], error.what(), compared);
  };
  const auto hand_over = [&](std::size_t p) { done(std::exchange(cells[p], {})); };
  compute_items(engine, workers, groups_of(pairs, workers.n), begin, failed, hand_over, progress);
  progress.report("pairs", 1.0);
}

}  // namespace espdiff
