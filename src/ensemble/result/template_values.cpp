// template_values.cpp: sums over the template for each pair, as cells.
#include "ensemble/result/template_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/counter_random.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/not_a_number.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_result.h"
#include "ensemble/result/state_sums.h"
#include "ensemble/result/template_patches.h"
#include "options/options.h"
#include "options/settings.h"
#include "statistics/surface/mesh_graph.h"

namespace espdiff {
namespace {

void require_states(const EnsembleFile& file) {
  for (std::size_t i = 0; i < file.plan().n_frames(); ++i) {
    if (!file.has(i))
      throw InputError(file.path() + " lacks the state " + file.plan().name_of(i) + "; " + switched_on("resume") +
                       " computes it");
  }
}

TemplateState state_of(const EnsembleFrame& frame) {
  TemplateState state{frame.rmsd_A,
                      frame.unmatched_template,
                      frame.unmatched_frame,
                      frame.distance_A,
                      frame.same_residue_area_fraction,
                      frame.trustworthy,
                      frame.note,
                      {}};
  if (!std::isfinite(frame.mean_potential)) {
    state.trustworthy = false;
    state.error = frame.note.empty() ? "no vertex of the template has a value" : frame.note;
    state.reason.clear();
  }
  return state;
}

/// Makes the cells of all pairs.
class Cells {
 public:
  Cells(const EnsembleFile& file, const std::vector<EnsembleFile>& fields, Matrix& matrix)
      : file_(file),
        matrix_(matrix),
        parts_(matrix.plan.parts()),
        required_share_(options_of("require").required_share),
        graph_(make_mesh_graph(file.surface().positions, file.surface().triangles)) {
    for (std::size_t i = 0; i < matrix.n(); ++i) {
      matrix_.through->states.push_back(state_of(file.numbers(i)));
      if (!matrix_.through->states.back().error.empty()) continue;
      row_of_[i] = frames_.size();
      frames_.push_back(i);
    }
    add_up("", file);
    for (const EnsembleFile& field : fields) add_up(field.plan().field->quantity.name, field);
  }

  void make() {
    for (const MatrixPair& pair : matrix_pairs(matrix_.n())) matrix_.cells.push_back(cell_of(pair));
    note_areas();
  }

 private:
  /// Sums of a field, empty for the potential, over the whole surface or a part.
  struct Sums {
    std::string field, part;
    double area_A2 = 0;  ///< of the template
    StateSums of;
  };

  void add_up(const std::string& field, const std::string& part, const EnsembleFile& file,
              const std::vector<double>& weights) {
    const double area = std::accumulate(weights.begin(), weights.end(), 0.0);
    sums_.push_back({field, part, area, sum_states(file, frames_, weights)});
  }

  /// The plan's settings of one name.
  CompareOptions options_of(const std::string& name) const {
    std::vector<std::pair<std::string, std::string>> given;
    for (const auto& setting : matrix_.plan.settings) {
      if (setting.first == name) given.push_back(setting);
    }
    return make_options(given);
  }

  /// The whole surface, then each patch.
  void add_up(const std::string& field, const EnsembleFile& file) {
    add_up(field, "", file, graph_.area);
    if (parts_.empty()) return;
    std::size_t k = 0;
    for (FixedPatch& patch : fixed_patches(options_of("patch"), residues_of_template(file_.plan()))) {
      const std::vector<std::uint8_t> inside = vertices_on_template(patch, file_.surface(), file_.plan().residues);
      std::vector<double> weights(graph_.area.size(), 0);
      for (std::size_t v = 0; v < weights.size(); ++v) weights[v] = inside[v] != 0 ? graph_.area[v] : 0;
      add_up(field, parts_[k++], file, weights);
    }
  }

  const std::string& label(std::size_t i) const { return matrix_.plan.variants[i].label; }

  MatrixCell cell_of(const MatrixPair& pair) const {
    MatrixCell cell;
    cell.source = pair.first;
    cell.target = pair.second;
    cell.values.assign(matrix_.metrics().size(), kNaN);
    cell.converged = cell.trustworthy = true;
    for (const std::size_t i : {pair.first, pair.second}) {
      const TemplateState& state = matrix_.through->states[i];
      if (state.trustworthy) continue;
      cell.trustworthy = false;
      if (state.error.empty()) {
        cell.reasons.push_back("the template onto " + label(i) + ": " + state.reason);
      } else if (cell.error.empty()) {
        cell.converged = false;
        cell.error = "the template onto " + label(i) + ": " + state.error;
      }
    }
    cell.parts_trustworthy.assign(parts_.size(), cell.trustworthy ? 1 : 0);
    if (!cell.error.empty()) {
      cell.reasons.clear();
      return cell;
    }
    for (const Sums& sums : sums_) {
      const Metrics metrics = sums.of.metrics(row_of_.at(pair.first), row_of_.at(pair.second));
      const double share = metrics.area_A2 / sums.area_A2;
      set_values(cell, sums, metrics, share);
      if (sums.field.empty()) judge(cell, sums.part, share);
    }
    return cell;
  }

  void set_values(MatrixCell& cell, const Sums& sums, const Metrics& metrics, double share) const {
    for (std::size_t m = 0; m < cell.values.size(); ++m) {
      const Metric& metric = matrix_.metrics()[m];
      if (!matrix_.gives(m) || metric.part != sums.part || metric.field != sums.field) continue;
      cell.values[m] = metric.source.of_area != nullptr ? metrics.*metric.source.of_area : share;
    }
  }

  /// By the share of the whole, or of a part, that is trusted onto both states.
  void judge(MatrixCell& cell, const std::string& part, double share) const {
    if (share >= required_share_) return;
    if (!part.empty()) {
      cell.parts_trustworthy[static_cast<std::size_t>(std::find(parts_.begin(), parts_.end(), part) - parts_.begin())] =
          0;
      return;
    }
    cell.trustworthy = false;
    cell.reasons.push_back(formatted("%.0f %% of the template is trusted onto both states (limit %.0f %%)",
                                     std::floor(100 * share), 100 * required_share_));
  }

  void note_areas() {
    ThroughTemplate& through = *matrix_.through;
    for (const double area : graph_.area) through.area_A2 += area;
    double sum = 0, least = std::numeric_limits<double>::infinity();
    std::size_t n = 0;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j, ++n) {
        const double area = sums_.front().of.pairs[StateSums::place(i, j)].area_A2;
        sum += area;
        least = std::min(least, area);
      }
    }
    through.mean_area_fraction = n > 0 ? sum / static_cast<double>(n) / through.area_A2 : kNaN;
    through.least_area_fraction = n > 0 ? least / through.area_A2 : kNaN;
  }

  const EnsembleFile& file_;
  Matrix& matrix_;
  std::vector<std::string> parts_;
  double required_share_ = 0;
  MeshGraph graph_;
  std::vector<std::size_t> frames_;            // that have values
  std::map<std::size_t, std::size_t> row_of_;  // by frame: its place in frames_
  std::vector<Sums> sums_;                     // of the potential first
};

}  // namespace

std::vector<MatrixPair> exact_sample(std::size_t n_variants, std::size_t n_exact) {
  constexpr std::uint64_t kSeed = 20221;
  const std::vector<MatrixPair> all = matrix_pairs(n_variants);
  if (n_exact >= all.size()) return all;
  std::vector<MatrixPair> sample;
  std::set<std::uint64_t> drawn;
  for (std::uint64_t counter = 0; sample.size() < n_exact; ++counter) {
    const std::uint64_t at = random_below(all.size(), kSeed, 0, counter);
    if (drawn.insert(at).second) sample.push_back(all[at]);
  }
  return sample;
}

std::vector<MatrixCell> sampled(const MatrixPlan& plan, std::size_t n_exact, const std::vector<MatrixCell>& cells) {
  std::vector<MatrixCell> chosen;
  std::vector<MatrixPair> sample = exact_sample(plan.variants.size(), n_exact);
  std::sort(sample.begin(), sample.end());
  for (const MatrixPair& pair : sample) {
    const auto found = std::find_if(cells.begin(), cells.end(), [&](const MatrixCell& cell) {
      return cell.source == pair.first && cell.target == pair.second;
    });
    if (found == cells.end())
      throw InputError("the exact pair " + plan.variants[pair.first].label + " to " + plan.variants[pair.second].label +
                       " is missing; resume the shard that lacks it, or name its state file too");
    chosen.push_back(*found);
  }
  return chosen;
}

Matrix matrix_through_template(const EnsembleFile& file, const std::vector<EnsembleFile>& fields,
                               std::vector<MatrixCell> exact) {
  require_states(file);
  for (const EnsembleFile& field : fields) require_states(field);
  const EnsemblePlan& plan = file.plan();
  Matrix matrix{*plan.matrix, {}, ThroughTemplate{}};
  ThroughTemplate& through = *matrix.through;
  through.name = plan.template_name;
  through.sha256 = plan.template_sha256;
  through.n_vertices = file.n_vertices();
  through.settings = plan.settings;
  through.exact = std::move(exact);
  Cells(file, fields, matrix).make();
  return matrix;
}

}  // namespace espdiff
