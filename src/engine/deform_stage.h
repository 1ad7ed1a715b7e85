// deform_stage.h: parameters and reports of the force iteration and of gradient vector flow.
#pragma once

#include "base/handles.h"

namespace espdiff {

enum class Interpolation { kTrilinear, kTricubic };

/// Parameters of the force iteration (thesis section 3.5.4); defaults are the thesis' values for the mapping.
struct DeformOptions {
  double sigma = 0.1;                ///< step scale, > 0
  double mu = 0.75;                  ///< weight of the external against the internal force, 0 to 1
  double rho = 0.3;                  ///< rigidity (thin plate) against tension (membrane), 0 to 1
  double min_displacement_A = 1e-3;  ///< converged when the mean displacement of an iteration falls below it
  int max_iterations = 1000;
  Interpolation interpolation = Interpolation::kTrilinear;
  /// Multiplies the internal force; 1 is the thesis' iteration. That force moves vertices along the surface only. A
  /// larger one spreads them sooner into stretched parts, and the surface stays as exact.
  double tangential_gain = 1;
  /// Measures the internal force from a rest shape (see Engine::deform), so that it resists distortion. Otherwise from
  /// equal edges (the thesis); the mesh then keeps sliding along the surface even if nothing deforms.
  bool rest_shape = false;
  /// Share of the last iteration's movement that is added to the internal force, 0 to below 1: Polyak's heavy ball,
  /// USSR Comput. Math. Math. Phys. 4, 1 (1964). What has far to go along the surface arrives in fewer iterations; a
  /// mean displacement of 1 / (1 - momentum) times as much means the same force.
  double momentum = 0;
};

struct DeformReport {
  int iterations = 0;
  double mean_displacement_A = 0;  ///< of the last iteration
  bool converged = false;
  ScalarsPtr path_length;  ///< [vertex] path length over the iterations, Angstrom
};

/// Parameters of gvf_field().
struct VectorFlowOptions {
  double weight_A2 = 0.05;  ///< mu: smoothness against the normals at the surface; they blend over its square root
  double tolerance = 1e-3;  ///< converged when no point moves by more in a sweep; normals have length 1
  int max_sweeps = 1000;
};

struct VectorFlowReport {
  int sweeps = 0;
  double residual = 0;  ///< largest move of a point in the last sweep checked
  bool converged = false;
};

}  // namespace espdiff
