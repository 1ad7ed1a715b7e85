// deform_stage.h: parameters and reports of the force iteration and of gradient vector flow.
#pragma once

#include "engine/handles.h"

namespace espdiff {

enum class Interpolation { kTrilinear, kTricubic };

/// Parameters of the force iteration (thesis section 3.5.4); defaults are its study's values for the mapping.
struct DeformOptions {
  double sigma = 0.1;                ///< step scale, > 0
  double mu = 0.75;                  ///< weight of the external against the internal force, 0 to 1
  double rho = 0.3;                  ///< rigidity (thin plate) against tension (membrane), 0 to 1
  double min_displacement_A = 1e-3;  ///< converged when the mean displacement of an iteration falls below it
  int max_iterations = 1000;
  Interpolation interpolation = Interpolation::kTrilinear;
  /// Multiplies the internal force; 1 is the thesis' iteration. That force moves vertices along the surface only, so a
  /// larger one lets them spread into what the surface has been drawn into sooner, and the surface itself no less
  /// exact.
  double tangential_gain = 1;
  /// Measures the internal force from a rest shape (see Engine::deform), so that it resists distortion; else from
  /// equal edges (the thesis), so that the mesh goes on sliding along the surface even when nothing is to be deformed.
  bool rest_shape = false;
};

struct DeformReport {
  int iterations = 0;
  double mean_displacement_A = 0;  ///< of the last iteration
  bool converged = false;
  ScalarsPtr path_length;  ///< [vertex] length of the way that the iterations took it, Angstrom
};

/// Parameters of gvf_field().
struct VectorFlowOptions {
  double weight_A2 = 0.05;  ///< mu: smoothness against the normals at the surface; they are blended over its root
  double tolerance = 1e-3;  ///< converged when no point would move by more in a sweep; normals are 1 long
  int max_sweeps = 1000;
};

struct VectorFlowReport {
  int sweeps = 0;
  double residual = 0;  ///< largest move of a point in the last sweep looked at
  bool converged = false;
};

}  // namespace espdiff
