// stage_inputs.h: inputs for timing the stages: one molecule and its displaced copy, after one full comparison.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/types.h"
#include "engine/select_engine.h"
#include "marching_cubes_peer.h"
#include "options/options.h"

namespace espdiff_bench {

/// A molecule to benchmark with.
struct Case {
  std::string name;         ///< "20k", "1tca"
  std::size_t n_atoms = 0;  ///< of a generated molecule; 0 to read the file
  std::string file;
  double quicksurf_ms = 0;  ///< bar of density and isosurface at 1 A on one thread (BARS.md); 0 where there is none
};

/// The generated sizes, and the real 1tca.pqr and TIM if available.
std::vector<Case> cases();

/// What to benchmark on.
struct BenchDevice {
  std::string name;  ///< "threads:2", "cuda"
  espdiff::DeviceRequest request;
  int n_threads;
};

/// One thread, two threads, and the first GPU if there is one.
std::vector<BenchDevice> devices();

/// One side of a pair on the engine, in the frame of the molecule's centroid.
struct Side {
  espdiff::Molecule molecule;
  std::vector<float> widths;
  std::vector<std::int32_t> residues;
  espdiff::AtomsPtr atoms;
  espdiff::GridPtr density;
  espdiff::MeshPtr raw;      ///< isosurface from the grid, cavities included
  espdiff::MeshPtr surface;  ///< projected, without cavities, as in a comparison
};

/// All inputs of the stages for one case and device, made with default options.
struct StageInputs {
  StageInputs(const Case& of, const BenchDevice& device);

  std::unique_ptr<espdiff::Engine> engine;
  espdiff::CompareOptions options;
  Side source, target;  ///< the target is the source displaced smoothly by 0.5 A
  espdiff::FieldPtr own_field, target_density_field, target_distance_field;
  espdiff::MeshPtr start;   ///< regularized source
  espdiff::MeshPtr mapped;  ///< deformed onto the target by the default field
  espdiff::Grid map;
  std::string fault;  ///< of the raw surface as a closed manifold; empty for none
  std::size_t n_components = 0;
  PeerSurface marching_cubes, flying_edges;  ///< of the same density; zero without VTK

  float isovalue() const { return static_cast<float>(options.surface.isovalue); }
  double spacing() const { return options.surface.grid_spacing_A; }  ///< Angstrom, as the next
  double projection_limit() const { return 0.5 * spacing(); }
};

/// The inputs of a case; the last ones are cached, so that stages of one case share them.
const StageInputs& stage_inputs(const Case& of, const BenchDevice& device);

}  // namespace espdiff_bench
