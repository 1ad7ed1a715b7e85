// medoid.cpp: all pairs of a sample of the frames, superposed.
#include "ensemble/frames/medoid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "align/geometry/superpose.h"
#include "align/pair_atoms.h"
#include "base/error.h"
#include "base/not_a_number.h"

namespace espdiff {
namespace {

/// [atom of the first frame] positions in another frame; NaN if it has no partner.
std::vector<Vec3d> as_in_first(const Molecule& first, const Molecule& frame) {
  std::vector<Vec3d> positions(first.size(), Vec3d{kNaN, kNaN, kNaN});
  for (const auto& [a, b] : pair_atoms(first, frame).pairs) positions[a] = frame.positions[b];
  return positions;
}

}  // namespace

std::size_t find_medoid(std::size_t n_frames, const std::function<Molecule(std::size_t)>& read,
                        const Progress& progress) {
  const std::size_t n_chosen = std::min(n_frames, kMostMedoidFrames);
  Molecule first;
  std::vector<std::vector<Vec3d>> frames;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < n_chosen; ++i) {
    progress.report("template: frame " + std::to_string(i + 1) + " of " + std::to_string(n_chosen), 0.0);
    const std::size_t number = i * n_frames / n_chosen;
    const Molecule frame = read(number);
    if (frame.size() == 0) continue;
    if (first.size() == 0) first = frame;
    frames.push_back(as_in_first(first, frame));
    numbers.push_back(number);
  }
  const std::size_t n = numbers.size();
  if (n == 0) throw InputError("no frame can be read; give a structure as " + option("template"));
  std::vector<std::pair<std::size_t, std::size_t>> common;
  for (std::size_t a = 0; a < first.size(); ++a) {
    const bool everywhere =
        std::all_of(frames.begin(), frames.end(), [&](const auto& frame) { return std::isfinite(frame[a].x); });
    if (everywhere && first.atoms[a].element != "H") common.emplace_back(a, a);
  }
  if (common.size() < 3)
    throw InputError("the frames share " + std::to_string(common.size()) +
                     " atoms besides hydrogens, too few to superpose them; give a structure as " + option("template"));
  std::vector<double> sums(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    progress.report("template: RMSD", static_cast<double>(i) / static_cast<double>(n));
    for (std::size_t j = 0; j < i; ++j) {
      const double rmsd_A = superpose(frames[i], frames[j], common).rmsd_A;
      sums[i] += rmsd_A;
      sums[j] += rmsd_A;
    }
  }
  return numbers[static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin())];
}

}  // namespace espdiff
