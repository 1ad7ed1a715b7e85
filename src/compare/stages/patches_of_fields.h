// patches_of_fields.h: the connected areas of a field's values that the options ask for.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct CompareOptions;

/// @throws InputError naming a request for patches of the potential
void refuse_patches_of_potential(const CompareOptions& options);

/// Patches of fields, and a warning for each request that finds none.
struct FoundPatches {
  std::vector<FieldPatches> patches;
  std::vector<Warning> warnings;
};

/// Finds the patches that the options ask for, of the finished fields and potentials. A request that finds none in
/// either state becomes a warning with the values that there are.
FoundPatches find_patches_of_fields(const CompareOptions& options, const CompareResult& result);

}  // namespace espdiff
