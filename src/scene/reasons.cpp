// reasons.cpp: the codes of OUT.vtp as what is drawn.
#include "scene/reasons.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/smooth_field.h"
#include "base/triangle_areas.h"
#include "io/files/write_csv.h"

namespace espdiff {
namespace {

constexpr int kReasonRounds = 4;
/// In kDrawnReasons: trusted, on a side chain that turned.
constexpr std::size_t kTurnedSideChain = 8;
/// By the code in OUT.vtp (`why`): trusted, unmatched, corrupt, unpaired, slipped, on another residue, disagrees,
/// without a potential, turned.
constexpr std::array<std::size_t, kNumberOfReasonCodes> kReasonOfCode = {0, kNumberOfDrawnReasons, 5, 6, 1, 2, 4, 7, 3};

}  // namespace

const std::array<DrawnReason, kNumberOfDrawnReasons> kDrawnReasons = {
    {{"trusted", "trusted", kPlainColour},
     {"slipped", "slipped", {213, 94, 0}},
     {"other_residue", "on another residue", {240, 190, 40}},
     {"turned", "turned", {0, 114, 178}},
     {"disagrees", "disagrees", {190, 90, 150}},
     {"corrupt", "off the target", {30, 30, 30}},
     {"unpaired", "without a partner", {0, 150, 110}},
     {"no_potential", "no potential", kNoValueColour},
     {"turned_side_chain", "trusted, side chain turned", {135, 190, 230}}}};

std::string reason_in_words(const char* words, double share) {
  return words + (" " + csv_number(std::round(1000 * share) / 10)) + " %";
}

std::vector<std::size_t> drawn_reasons(const ReasonCodes& codes) {
  std::vector<std::size_t> reasons;
  reasons.reserve(codes.triangles.size());
  for (std::size_t t = 0; t < codes.triangles.size(); ++t) {
    const auto has_turned = [&](std::uint32_t v) { return !codes.turned.empty() && codes.turned[v] != 0; };
    const auto n_turned = std::count_if(codes.triangles[t].begin(), codes.triangles[t].end(), has_turned);
    const std::size_t reason = kReasonOfCode.at(codes.why[t]);
    reasons.push_back(reason == 0 && n_turned >= 2 ? kTurnedSideChain : reason);
  }
  return reasons;
}

std::array<std::vector<float>, kNumberOfDrawnReasons> shares_of_reasons(const ReasonCodes& codes,
                                                                        std::size_t n_vertices) {
  const std::vector<std::size_t> reasons = drawn_reasons(codes);
  std::array<std::vector<float>, kNumberOfDrawnReasons> shares;
  for (std::vector<float>& share : shares) share.assign(n_vertices, 0);
  std::vector<float> n_around(n_vertices, 0);
  for (std::size_t t = 0; t < reasons.size(); ++t) {
    if (reasons[t] == kNumberOfDrawnReasons) continue;
    for (const std::uint32_t corner : codes.triangles[t]) {
      shares[reasons[t]][corner] += 1;
      n_around[corner] += 1;
    }
  }
  for (std::vector<float>& share : shares) {
    for (std::size_t v = 0; v < n_vertices; ++v) share[v] /= n_around[v] > 0 ? n_around[v] : 1;
    share = smoothed_over_neighbours(codes.triangles, std::move(share), kReasonRounds);
  }
  return shares;
}

std::array<double, kNumberOfDrawnReasons> areas_of_reasons(const ReasonCodes& codes,
                                                           const std::vector<Vec3d>& positions) {
  const std::vector<std::size_t> reasons = drawn_reasons(codes);
  std::array<double, kNumberOfDrawnReasons> areas{};
  double all = 0;
  for (std::size_t t = 0; t < reasons.size(); ++t) {
    const double area = triangle_area(positions, codes.triangles[t]);
    all += area;
    if (reasons[t] < kNumberOfDrawnReasons) areas[reasons[t]] += area;
  }
  for (double& area : areas) area /= all;
  return areas;
}

}  // namespace espdiff
