// planted_plan.h: what the plans of planted ensembles have in common.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensemble/frames/ensemble_plan.h"

namespace espdiff_test {

/// A plan that lacks its replicates.
inline espdiff::EnsemblePlan plan_of(std::string template_name, std::vector<std::string> residues) {
  espdiff::EnsemblePlan plan;
  plan.version = "test";
  plan.device = "cpu";
  plan.settings = {{"grid-spacing", "1"}};
  plan.potential = "planted";
  plan.potential_unit = "kT/e";
  plan.template_name = std::move(template_name);
  plan.template_sha256 = "0";
  plan.residues = std::move(residues);
  return plan;
}

}  // namespace espdiff_test
