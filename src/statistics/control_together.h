// control_together.h: family-wise p over several surfaces, such as those of several fields.
#pragma once

#include <vector>

namespace espdiff {

struct SurfaceRegression;
struct SurfaceTest;

/// Family-wise p over the surfaces of several tests together: the share of permutations whose largest |t|, or TFCE
/// score, on any of the surfaces is at least the vertex' own (the maximum over modalities, Winkler et al. 2016, Hum.
/// Brain Mapp. 37:1486). The tests exchange the same labels of the same replicates or blocks; those without p are left
/// alone.
void control_together(const std::vector<SurfaceTest*>& tests);

/// As for tests of groups: the same orders of the same values.
void control_together(const std::vector<SurfaceRegression*>& regressions);

}  // namespace espdiff
