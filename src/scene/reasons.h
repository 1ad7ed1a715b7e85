// reasons.h: why surface is not trusted, as it is drawn: one colour a reason, and smooth borders between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"
#include "plot/colour_map.h"

namespace espdiff {

/// What a matched triangle is drawn as, in the order of kDrawnReasons; unmatched ones are hatched.
constexpr std::size_t kNumberOfDrawnReasons = 9;
/// Codes of OUT.vtp (`why`) are below this.
constexpr std::size_t kNumberOfReasonCodes = 9;

struct DrawnReason {
  const char* key;    ///< as in OUT.json
  const char* words;  ///< of the legend
  Rgb colour;         ///< distinct for red-green and blue-yellow deficient vision (M. Okabe and K. Ito, 2008)
};

/// "trusted" first, and last what is trusted although its side chain turned away from its atoms.
extern const std::array<DrawnReason, kNumberOfDrawnReasons> kDrawnReasons;

/// Codes of why triangles are not trusted, and of what turned at vertices, as in OUT.vtp.
struct ReasonCodes {
  const std::vector<Triangle>& triangles;
  const std::vector<std::uint8_t>& why;     ///< [triangle]
  const std::vector<std::uint8_t>& turned;  ///< [vertex]; may be empty
};

/// A key of the legend: "slipped 3.2 %". @param share of the surface
std::string reason_in_words(const char* words, double share);

/// [triangle] index into kDrawnReasons; of unmatched triangles kNumberOfDrawnReasons.
std::vector<std::size_t> drawn_reasons(const ReasonCodes& codes);

/// [reason][vertex] share of the matched triangles around a vertex, smooth. The reason with the largest share is drawn.
std::array<std::vector<float>, kNumberOfDrawnReasons> shares_of_reasons(const ReasonCodes& codes,
                                                                        std::size_t n_vertices);

/// [reason] share of the surface; the rest is unmatched. @param positions [vertex] of the source
std::array<double, kNumberOfDrawnReasons> areas_of_reasons(const ReasonCodes& codes,
                                                           const std::vector<Vec3d>& positions);

}  // namespace espdiff
