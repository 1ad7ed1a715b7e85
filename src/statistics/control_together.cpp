// control_together.cpp: family-wise p over several surfaces, such as those of several fields.
#include "statistics/control_together.h"

#include <algorithm>
#include <cmath>

#include "statistics/null_maxima.h"
#include "statistics/regression.h"
#include "statistics/surface/surface_test.h"

namespace espdiff {
namespace {

void raise_to(std::vector<double>& largest, const std::vector<double>& values) {
  largest.resize(values.size(), 0);
  for (std::size_t k = 0; k < values.size(); ++k) largest[k] = std::max(largest[k], values[k]);
}

/// @param all each with `maxima`, `tfce`, `p_max_t` and `p_tfce`  @param t_of gives the t of one
template <typename Test, typename T>
void control_all(const std::vector<Test*>& all, const T& t_of) {
  NullMaxima joint;
  for (const Test* test : all) {
    raise_to(joint.t, test->maxima.t);
    raise_to(joint.tfce, test->maxima.tfce);
  }
  for (Test* test : all) {
    const std::vector<double>& t = t_of(*test);
    test->p_max_t = shares_at_least(joint.t, t, t);
    test->p_tfce = shares_at_least(joint.tfce, test->tfce, t);
  }
}

}  // namespace

void control_together(const std::vector<SurfaceTest*>& tests) {
  std::vector<SurfaceTest*> with_p;
  std::copy_if(tests.begin(), tests.end(), std::back_inserter(with_p),
               [](const SurfaceTest* test) { return test->no_p.empty(); });
  control_all(with_p, [](const SurfaceTest& test) -> const std::vector<double>& { return test.vertices.t; });
}

void control_together(const std::vector<SurfaceRegression*>& regressions) {
  control_all(regressions, [](const SurfaceRegression& of) -> const std::vector<double>& { return of.t; });
}

}  // namespace espdiff
