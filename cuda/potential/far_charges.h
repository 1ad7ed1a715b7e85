// far_charges.h: charges as they look from afar: spread to the nodes of a coarse lattice, which are fewer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cuda/potential/pb_atoms.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A potential that varies slowly over the nodes around a charge is interpolated from them by cubics, so the charge may
/// be spread to the 64 nodes with the same weights. At four times the spacing each charge's potential errs by 0.2 % at
/// most, and that of a ball of random charges by 1 % of its rms.
class FarCharges {
 public:
  /// @param spacing_A between nodes; 0 leaves the charges where they are, as does a molecule of too few atoms
  FarCharges(const std::vector<PbAtom>& atoms, double spacing_A);

  /// Of the nodes that have a part of an atom, or of the atoms.
  const std::vector<Vec3f>& places() const { return places_; }
  /// @param strengths [atom]  @returns [place]
  std::vector<float> spread(const std::vector<double>& strengths) const;
  /// The transpose. @param values [place]  @returns [atom]
  std::vector<double> gather(const std::vector<float>& values) const;

 private:
  static constexpr std::size_t kWide = 4;
  /// An atom's first node along each axis, and its four weights there.
  struct Spread {
    std::size_t first;
    double weight[3][kWide];
  };
  template <typename Visit>
  void visit(const Spread& atom, const Visit& visit) const;

  std::vector<Vec3f> places_;
  std::vector<Spread> spreads_;      ///< [atom]; empty where charges stay
  std::vector<std::int32_t> place_;  ///< [node] -1 where it has no part
  std::size_t row_ = 0, plane_ = 0;
};

}  // namespace espdiff::ESPDIFF_BACKEND
