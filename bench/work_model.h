// work_model.h: what a stage has to do at least, from the sizes of its input: bytes that must pass memory once, and
// operations of the formula. The same for every back end, whatever it does besides.
#pragma once

#include "stage_inputs.h"

namespace espdiff_bench {

struct Work {
  double bytes = 0;       ///< each array that is read or written counts once
  double operations = 0;  ///< additions and multiplications in single precision
};

/// Every Gaussian at every lattice point within its reach: a multiplication and an addition each.
Work density_work(const StageInputs& in);
/// The density in; vertices, triangles and one-rings out. No arithmetic to speak of.
Work isosurface_work(const StageInputs& in);
/// The density in, value and gradient out.
Work density_field_work(const StageInputs& in);
/// One iteration on the regularized source in the target's field.
Work deform_iteration_work(const StageInputs& in, bool tricubic);
/// The density and its gradient at the mapped triangles' centroids. This and the next three: no
/// operations above 10,000 atoms, where counting the pairs would take too long.
Work fit_work(const StageInputs& in);
/// The same at the isosurface's vertices, twice: a step of Newton's method, and the look whether it has arrived.
Work project_work(const StageInputs& in);
/// Plain integration of the flow: every vertex in every step, its density as in project_work(), then its flow.
Work morph_work(const StageInputs& in, int n_steps);
/// The atom with the most density at each vertex.
Work vertex_residues_work(const StageInputs& in);
/// Both meshes in; from each corner and centroid to one triangle, both directions.
Work distances_work(const StageInputs& in);
/// One cycle of conjugate gradients with one of multigrid, for each fine point.
Work poisson_boltzmann_work(std::size_t n_points, int n_cycles);

}  // namespace espdiff_bench
