// fields.h: the fields of a step besides the potential, at the vertices of its one mapping, and the connected areas of
// their values.
#pragma once

#include <vector>

#include "base/handles.h"
#include "certificate/result.h"
#include "compare/stages/compared_side.h"
#include "compare/stages/measured_parts.h"

namespace espdiff {

struct CompareOptions;

/// Makes the fields of a state, or takes those of `side.input` that were made before.
/// @throws InputError naming the field
StateFields make_state_fields(const std::vector<Field>& fields, const Molecule& molecule, const FieldSide& side);

/// @throws InputError naming the first field that is made of the potential
void refuse_fields_of_potential(const std::vector<Field>& fields);

/// The fields of both states on the mapping, the patches of their values, and what was noted of them.
struct ComparedFields {
  std::vector<FieldResult> fields;
  std::vector<FieldPatches> patches;
  std::vector<Warning> warnings;
};

/// Reads each field of both states at corresponding vertices; metrics and residues over the trusted area, of the whole
/// and of each part. Then finds the patches that the options ask for, of these fields and of the potential. Notes
/// become warnings, and so do requests that find no patch in either state, with the values that there are.
/// @param surface with potentials, which are in `unit`  @param parts receive their fields
ComparedFields compare_fields(Engine& engine, const std::vector<Field>& fields, const ComparedSide& source,
                              const ComparedSide& target, const CompareOptions& options, const MappedStep& step,
                              const MappedSurface& surface, PotentialUnit unit, std::vector<MeasuredPart>& parts);

/// @throws InputError naming a request for patches of the potential
void refuse_patches_of_potential(const CompareOptions& options);

}  // namespace espdiff
