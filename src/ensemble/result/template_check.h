// template_check.h: whether an ensemble's answer depends on its template.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

class EnsembleFile;
struct EnsembleResult;

/// The same ensemble through another template, beside the first.
struct TemplateCheck {
  std::string template_name;
  double mean_abs_difference = 0, significant_area_A2 = 0;
  /// Area that is significant by both templates over that by either, on the first one's surface; NaN if none is.
  double overlap = 0;
  /// [patch of the first] its mean difference by the other template, at the nearest vertices; NaN if they are not
  /// tested there.
  std::vector<double> patch_differences;
  double largest_change = 0;  ///< of a patch's mean; NaN without patches
};

/// Compares two results of the same groups. Vertices correspond to the nearest ones of the superposed templates;
/// those that are farther than 2 A count as not tested. O(n^2) in vertices.
/// @param to_first the other template's coordinates -> the first one's
TemplateCheck check_template(const EnsembleFile& first, const EnsembleResult& first_result, const EnsembleFile& other,
                             const EnsembleResult& other_result, const RigidTransform& to_first);

}  // namespace espdiff
