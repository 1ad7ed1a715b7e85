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
/// The density and its gradient at the mapped triangles' centroids; zero above 10,000 atoms, where counting the pairs
/// would take too long.
Work fit_work(const StageInputs& in);

}  // namespace espdiff_bench
