// ensemble_columns.cpp: which frames of the file a replicate's columns are.
#include "ensemble/file/ensemble_columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "ensemble/file/ensemble_file.h"
#include "statistics/autocorrelation.h"

namespace espdiff {
namespace {

std::size_t first_frame(const EnsemblePlan& plan, std::size_t replicate) {
  std::size_t first = 0;
  for (std::size_t r = 0; r < replicate; ++r) first += plan.replicates[r].n_frames;
  return first;
}

std::size_t detected_start(const EnsembleFile& file, std::size_t replicate) {
  const std::size_t first = first_frame(file.plan(), replicate);
  std::vector<double> rmsd, potential;
  std::vector<std::size_t> numbers;
  for (std::size_t f = 0; f < file.plan().replicates[replicate].n_frames; ++f) {
    const EnsembleFrame frame = file.numbers(first + f);
    if (!std::isfinite(frame.mean_potential)) continue;
    rmsd.push_back(frame.rmsd_A);
    potential.push_back(frame.mean_potential);
    numbers.push_back(f);
  }
  if (numbers.empty()) return 0;
  return numbers[std::max(detect_equilibration(rmsd), detect_equilibration(potential))];
}

}  // namespace

std::string to_string(const Equilibration& how) {
  return how.kind == Equilibration::Kind::kNone        ? "none"
         : how.kind == Equilibration::Kind::kAutomatic ? "auto"
                                                       : std::to_string(how.n_frames);
}

Equilibration parse_equilibration(const std::string& text) {
  if (text == "none") return {};
  if (text == "auto") return {Equilibration::Kind::kAutomatic, 0};
  if (!text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos)
    return {Equilibration::Kind::kFrames, static_cast<std::size_t>(std::stoul(text))};
  throw InputError(option("equilibration") + ": '" + text + "' is not none, auto, or a number of frames");
}

std::vector<std::size_t> equilibrated_starts(const EnsembleFile& file, const Equilibration& how) {
  std::vector<std::size_t> starts;
  for (std::size_t r = 0; r < file.plan().replicates.size(); ++r) {
    const EnsembleReplicate& replicate = file.plan().replicates[r];
    std::size_t start = 0;
    if (how.kind == Equilibration::Kind::kFrames) start = how.n_frames;
    if (how.kind == Equilibration::Kind::kAutomatic) start = detected_start(file, r);
    if (start + 2 > replicate.n_frames)
      throw InputError(option("equilibration", std::to_string(start)) + " leaves fewer than two of the " +
                       std::to_string(replicate.n_frames) + " frames of replicate " + replicate.name + " of " +
                       replicate.group + "; cut off less");
    starts.push_back(start);
  }
  return starts;
}

EnsembleColumns::EnsembleColumns(const EnsembleFile& file, std::vector<std::size_t> starts)
    : file_(file), starts_(std::move(starts)) {
  for (std::size_t r = 0; r < starts_.size(); ++r) first_.push_back(first_frame(file.plan(), r));
}

std::size_t EnsembleColumns::n_columns() const { return file_.n_vertices(); }

std::size_t EnsembleColumns::n_frames(std::size_t replicate) const {
  return file_.plan().replicates[replicate].n_frames - starts_[replicate];
}

void EnsembleColumns::read(std::size_t replicate, std::size_t begin, std::size_t end,
                           std::vector<float>& values) const {
  const std::size_t n = n_frames(replicate), width = end - begin;
  values.resize(n * width);
  for (std::size_t f = 0; f < n; ++f)
    file_.read_values(first_[replicate] + starts_[replicate] + f, begin, end, values.data() + f * width);
}

}  // namespace espdiff
