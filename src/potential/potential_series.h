// potential_series.h: potential maps of one frame, or the average of many.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/types.h"
#include "potential/potential.h"
#include "potential/running_map.h"

namespace espdiff {

/// Potentials of the frames of one molecule, and their average.
///
/// The first frame sets the lattice. With a fixed cell and no superposition every frame is computed on it; otherwise
/// each frame is computed in its own cell and sampled on it by splines (PmeOptions::smooth_samples). Coulomb sums are
/// computed on it directly.
class PotentialSeries {
 public:
  /// @throws InputError (options that exclude each other)
  PotentialSeries(Engine& engine, PotentialOptions options);
  ~PotentialSeries();

  /// Adds the frame's map to the average, and returns it. A periodic map covers its cell; a superposed one belongs to
  /// the first frame's coordinates.
  /// @param own_cell the frame's, where the file has one
  /// @throws InputError (no charges, other atoms than the first frame's), GeometryError (superposition), and as
  /// Engine::pme_potential
  Grid step(const Molecule& frame, const std::optional<UnitCell>& own_cell, const Progress& progress);
  /// Like step(), without returning the map.
  void add(const Molecule& frame, const std::optional<UnitCell>& own_cell, const Progress& progress);

  const RunningMap& average() const { return average_; }

 private:
  struct FirstFrame;

  Grid next_map(const Molecule& frame, const std::optional<UnitCell>& own_cell, const Progress& progress);
  std::vector<Vec3d> superposed_atoms(const Molecule& frame, const std::optional<UnitCell>& own_cell) const;
  Grid compute(const std::vector<Vec3d>& positions, const Molecule& frame, const PmeCell& cell,
               const Progress& progress) const;

  Engine& engine_;
  PotentialOptions options_;
  bool one_lattice_;  ///< every frame is computed in the first frame's cell
  std::unique_ptr<FirstFrame> first_;
  RunningMap average_;
};

/// The map of one molecule: a series of one.
Grid potential_map(Engine& engine, const Molecule& molecule, const PotentialOptions& options, const Progress& progress);

}  // namespace espdiff
