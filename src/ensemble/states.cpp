// states.cpp: sums over columns for each pair of frames, and the eigenvectors of their products.
#include "ensemble/states.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "ensemble/ensemble_file.h"
#include "ensemble/ensemble_result.h"
#include "io/atomic_file.h"
#include "io/write_csv.h"

namespace espdiff {
namespace {

constexpr std::size_t kBlock = 256;  // columns at a time, of all frames
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

/// Columns of all frames, [frame][column of the block], in double precision.
class Block {
 public:
  Block(const EnsembleFile& file, const std::vector<std::size_t>& frames) : file_(file), frames_(frames) {}

  void read(std::size_t begin, std::size_t end) {
    width_ = end - begin;
    values_.resize(frames_.size() * width_);
    std::vector<float> row(width_);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      file_.read_values(frames_[i], begin, end, row.data());
      std::copy(row.begin(), row.end(), values_.begin() + static_cast<std::ptrdiff_t>(i * width_));
    }
  }
  double at(std::size_t frame, std::size_t column) const { return values_[frame * width_ + column]; }
  std::size_t width() const { return width_; }

  /// Sets columns that some frame lacks to 0, and their weights too.
  void drop_incomplete(std::vector<double>& weights) {
    for (std::size_t c = 0; c < width_; ++c) {
      bool complete = true;
      for (std::size_t i = 0; i < frames_.size(); ++i) complete = complete && std::isfinite(at(i, c));
      if (complete) continue;
      weights[c] = 0;
      for (std::size_t i = 0; i < frames_.size(); ++i) values_[i * width_ + c] = 0;
    }
  }

 private:
  const EnsembleFile& file_;
  const std::vector<std::size_t>& frames_;
  std::size_t width_ = 0;
  std::vector<double> values_;
};

template <typename Work>
void for_each_block(const EnsembleFile& file, const EnsembleResult& result, Block& block, Work work) {
  for (std::size_t begin = 0; begin < file.n_vertices(); begin += kBlock) {
    const std::size_t end = std::min(file.n_vertices(), begin + kBlock);
    block.read(begin, end);
    std::vector<double> weights(result.graph.area.begin() + static_cast<std::ptrdiff_t>(begin),
                                result.graph.area.begin() + static_cast<std::ptrdiff_t>(end));
    block.drop_incomplete(weights);
    work(begin, weights);
  }
}

/// Adds up products and absolute differences of all pairs.
/// @returns the products, [i][j]
Eigen::MatrixXd add_up(const EnsembleFile& file, const EnsembleResult& result, StateTable& table) {
  const std::size_t n = table.size();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  table.mean_abs.assign(n * n, 0);
  double area = 0;
  Block block(file, table.frames);
  for_each_block(file, result, block, [&](std::size_t, const std::vector<double>& weights) {
    for (const double w : weights) area += w;
#pragma omp parallel for schedule(dynamic, 4)
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double product = 0, difference = 0;
        for (std::size_t c = 0; c < weights.size(); ++c) {
          const double a = block.at(i, c), b = block.at(j, c);
          product += weights[c] * a * b;
          difference += weights[c] * std::fabs(a - b);
        }
        products(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) += product;
        table.mean_abs[i * n + j] += difference;
      }
    }
  });
  if (area == 0)
    throw InputError("no vertex of the template has a counterpart in every frame; nothing can be compared");
  table.area_fraction = area / result.area_A2;
  for (Eigen::Index i = 0; i < products.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      products(i, j) /= area;
      products(j, i) = products(i, j);
      const auto at = static_cast<std::size_t>(i) * n + static_cast<std::size_t>(j);
      table.mean_abs[at] /= area;
      table.mean_abs[static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i)] = table.mean_abs[at];
    }
  }
  return products;
}

void set_distances(const Eigen::MatrixXd& products, StateTable& table) {
  for (Eigen::Index i = 0; i < products.rows(); ++i) {
    for (Eigen::Index j = 0; j < products.cols(); ++j) {
      const double squares = products(i, i) + products(j, j);
      table.rms.push_back(std::sqrt(std::max(0.0, squares - 2 * products(i, j))));
      table.hodgkin.push_back(squares > 0 ? 2 * products(i, j) / squares : kNaN);
    }
  }
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
void find_modes(const EnsembleFile& file, const EnsembleResult& result, StateTable& table) {
  const auto n = static_cast<double>(table.size());
  Block block(file, table.frames);
  for (auto& component : table.components) component.mode.assign(file.n_vertices(), kNaN);
  for_each_block(file, result, block, [&](std::size_t begin, const std::vector<double>& weights) {
    for (std::size_t c = 0; c < weights.size(); ++c) {
      if (weights[c] == 0) continue;
      for (auto& component : table.components) {
        double sum = 0;
        for (std::size_t i = 0; i < table.size(); ++i) sum += component.scores[i] * block.at(i, c);
        component.mode[begin + c] = sum / n;  // scores add up to zero, so the mean drops out
      }
    }
  });
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
  const Eigen::MatrixXd products = add_up(file, result, table);
  set_distances(products, table);
  find_components(products, table);
  find_modes(file, result, table);
  return table;
}

std::vector<std::string> write_states(const std::string& prefix, const EnsembleFile& file, const StateTable& states) {
  AtomicFile pairs(prefix + ".states.csv"), components(prefix + ".components.csv");
  write_csv_row(pairs.stream(), {"group", "replicate", "frame", "other_group", "other_replicate", "other_frame",
                                 "mean_abs_difference", "rms_difference", "hodgkin_index"});
  const std::size_t n = states.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::vector<std::string> row = named(file, states.frames[j]);
      const std::vector<std::string> other = named(file, states.frames[i]);
      row.insert(row.end(), other.begin(), other.end());
      for (const auto* values : {&states.mean_abs, &states.rms, &states.hodgkin})
        row.push_back(csv_number((*values)[i * n + j]));
      write_csv_row(pairs.stream(), row);
    }
  }
  std::vector<std::string> names = {"group", "replicate", "frame"};
  for (std::size_t k = 0; k < states.components.size(); ++k) names.push_back("component_" + std::to_string(k + 1));
  write_csv_row(components.stream(), names);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::string> row = named(file, states.frames[i]);
    for (const auto& component : states.components) row.push_back(csv_number(component.scores[i]));
    write_csv_row(components.stream(), row);
  }
  commit_all({&pairs, &components});
  return {pairs.path(), components.path()};
}

}  // namespace espdiff
