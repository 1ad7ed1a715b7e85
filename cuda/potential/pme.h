// pme.h: smooth particle-mesh Ewald: the reciprocal potential of a periodic cell on a grid (see Engine::pme_potential).
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "cuda/potential/fourier.h"
#include "cuda/potential/spread.h"
#include "cuda/surface/sample.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Computes maps. Keeps plans and workspace for the next map of the same size.
class PmeSolver {
 public:
  std::shared_ptr<MapGrid> potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                     const PmeCell& cell, const PmeOptions& options, const RigidTransform& to_map,
                                     const Progress& progress);
  /// [atom, then probe] what each charge of a map made here adds to a reading: the same sums, with the weights as
  /// charges.
  std::vector<double> contributions(const MapGrid& map, const WeightedPlaces& reading,
                                    const std::vector<ProbeCharge>& probes);

 private:
  template <typename T>
  struct Kept {
    std::array<int, 3> size{};
    std::unique_ptr<FourierGrid<T>> grid;

    FourierGrid<T>& of_size(std::array<int, 3> wanted);
  };
  template <typename T>
  void solve(Kept<T>& kept, Buffer<GridCharge> placed, const PmeCell& cell, const PmeOptions& options, MapGrid& map,
             const Progress& progress);
  template <typename T>
  void convolve(FourierGrid<T>& grid, const PmeCell& cell, const PmeOptions& options, MapGrid& map);
  template <typename T>
  void solve_transposed(Kept<T>& kept, const MapGrid& map, const WeightedPlaces& reading, MapGrid& solution);

  Kept<float> single_;
  Kept<double> double_;
};

}  // namespace espdiff::ESPDIFF_BACKEND
