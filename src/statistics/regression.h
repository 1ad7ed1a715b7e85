// regression.h: a value of each replicate, such as an activity, regressed on columns over a surface.
#pragma once

#include <cstddef>
#include <vector>

#include "statistics/surface/surface_test.h"

namespace espdiff {

/// How a value goes with the surface, place by place and as a whole.
struct SurfaceRegression {
  std::vector<double> correlation, slope, t, p;  ///< [vertex] Pearson's; slope: of the column, per unit of the value
  std::vector<double> tfce;                      ///< scores of t
  NullMaxima maxima;
  std::vector<double> p_max_t, p_tfce;  ///< family-wise over the surface; NaN where not tested
  std::size_t n_permutations = 0;
  bool exact = true;              ///< all orders of the values
  double smallest_p = 1;          ///< that these orders allow
  std::vector<double> predicted;  ///< [replicate] from the others; NaN without a value
  double q2 = 0;                  ///< 1 - squares of the predictions' errors / of those by the others' mean
  double q2_p = 1;                ///< share of orders that predict at least as well
};

/// Fewest replicates with a value.
constexpr std::size_t kFewestValues = 4;

/// Pearson's correlation at each vertex, and the exchange of the values between replicates: the family-wise p of a
/// vertex is the share of orders whose largest |t|, or TFCE score, on the surface is at least its own (as
/// test_replicates()). All orders where they are not more than options.max_permutations, otherwise the observed one
/// and random ones.
///
/// Prediction of a value from the others: the first component of partial least squares (Wold et al. 1984, SIAM J. Sci.
/// Stat. Comput. 5:735), columns weighted by area, centred without the left-out replicate.
/// @param means  [replicate][vertex]; NaN in any replicate with a value: not tested
/// @param values [replicate]; NaN: it does not count
/// @throws InputError (fewer than kFewestValues values, or all of them equal)
SurfaceRegression regress_on_surface(const std::vector<std::vector<double>>& means, const std::vector<double>& values,
                                     const MeshGraph& graph, const SurfaceTestOptions& options);

}  // namespace espdiff
