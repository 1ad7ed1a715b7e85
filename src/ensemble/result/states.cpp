// states.cpp: the eigenvectors of the frames' products, and the tables of pairs and components.
#include "ensemble/result/states.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/not_a_number.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_result.h"
#include "io/files/write_csv.h"

namespace espdiff {
namespace {

std::vector<std::size_t> usable_frames(const EnsembleFile& file, const EnsembleResult& result) {
  std::vector<std::size_t> frames;
  std::size_t first = 0;
  for (const ReplicateSummary& r : result.replicates) {
    for (std::size_t f = r.n_cut_off; f < r.n_frames; ++f) {
      if (std::isfinite(file.numbers(first + f).mean_potential)) frames.push_back(first + f);
    }
    first += r.n_frames;
  }
  if (frames.size() > kMostStates)
    throw InputError(std::to_string(frames.size()) + " frames cannot be compared with each other; the limit is " +
                     std::to_string(kMostStates) + ": take fewer by " + option("frames", "0:10:end"));
  return frames;
}

/// The mean products over the area that every frame has, [i][j].
Eigen::MatrixXd mean_products(const StateSums& sums) {
  const auto n = static_cast<Eigen::Index>(sums.n);
  Eigen::MatrixXd products(n, n);
  for (std::size_t i = 0; i < sums.n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      products(row, column) = products(column, row) = sums.complete[StateSums::place(i, j)] / sums.complete_area_A2;
    }
  }
  return products;
}

/// Eigenvectors of the products of deviations from the mean over frames.
void find_components(Eigen::MatrixXd products, StateTable& table) {
  const Eigen::Index n = products.rows();
  const Eigen::VectorXd means = products.rowwise().mean();
  const double mean = means.mean();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) products(i, j) += mean - means(i) - means(j);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  const double total = products.trace();
  for (std::size_t k = 0; k < std::min(kComponents, table.size() - 1); ++k) {
    const Eigen::Index at = n - 1 - static_cast<Eigen::Index>(k);
    StateTable::Component component;
    component.share = total > 0 ? solver.eigenvalues()(at) / total : kNaN;
    const double root = std::sqrt(static_cast<double>(n));
    for (Eigen::Index i = 0; i < n; ++i) component.scores.push_back(root * solver.eigenvectors()(i, at));
    table.components.push_back(std::move(component));
  }
}

/// The regression of the potential on the scores: sum over frames of score * deviation / n.
void find_modes(const EnsembleFile& file, StateTable& table) {
  const auto n = static_cast<double>(table.size());
  StateBlock block(file, table.frames);
  for (auto& component : table.components) component.mode.assign(file.n_vertices(), kNaN);
  for (std::size_t begin = 0; begin < file.n_vertices(); begin += kStateBlock) {
    block.read(begin, std::min(file.n_vertices(), begin + kStateBlock));
    for (std::size_t c = 0; c < block.width(); ++c) {
      if (!block.is_complete(c)) continue;
      for (auto& component : table.components) {
        double sum = 0;
        for (std::size_t i = 0; i < table.size(); ++i) sum += component.scores[i] * block.values(i)[c];
        component.mode[begin + c] = sum / n;  // scores add up to zero, so the mean drops out
      }
    }
  }
  for (auto& component : table.components) {
    double largest = 0;
    for (const double value : component.mode) {
      if (std::fabs(value) > std::fabs(largest)) largest = value;
    }
    if (largest >= 0) continue;
    for (double& value : component.mode) value = -value;
    for (double& score : component.scores) score = -score;
  }
}

std::vector<std::string> named(const EnsembleFile& file, std::size_t frame) {
  const auto [replicate, number] = file.plan().place_of(frame);
  const EnsembleReplicate& r = file.plan().replicates[replicate];
  return {r.group, r.name, std::to_string(number)};
}

}  // namespace

StateTable compare_states(const EnsembleFile& file, const EnsembleResult& result) {
  StateTable table;
  table.frames = usable_frames(file, result);
  table.sums = sum_states(file, table.frames, result.graph.area);
  if (table.sums.complete_area_A2 == 0)
    throw InputError("no vertex of the template has a counterpart in every frame; nothing can be compared");
  table.area_fraction = table.sums.complete_area_A2 / result.area_A2;
  find_components(mean_products(table.sums), table);
  find_modes(file, table);
  return table;
}

void write_state_pairs(std::ostream& out, const EnsembleFile& file, const StateTable& states) {
  write_csv_row(out, {"group", "replicate", "frame", "other_group", "other_replicate", "other_frame",
                      "mean_abs_difference", "rms_difference", "hodgkin_index"});
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::vector<std::string> row = named(file, states.frames[j]);
      const std::vector<std::string> other = named(file, states.frames[i]);
      row.insert(row.end(), other.begin(), other.end());
      const Metrics m = states.sums.metrics(j, i);
      for (const double value : {m.mean_abs_difference, m.rms_difference, m.hodgkin_index})
        row.push_back(csv_number(value));
      write_csv_row(out, row);
    }
  }
}

void write_components(std::ostream& out, const EnsembleFile& file, const StateTable& states) {
  std::vector<std::string> names = {"group", "replicate", "frame"};
  for (std::size_t k = 0; k < states.components.size(); ++k) names.push_back("component_" + std::to_string(k + 1));
  write_csv_row(out, names);
  for (std::size_t i = 0; i < states.size(); ++i) {
    std::vector<std::string> row = named(file, states.frames[i]);
    for (const auto& component : states.components) row.push_back(csv_number(component.scores[i]));
    write_csv_row(out, row);
  }
}

}  // namespace espdiff
