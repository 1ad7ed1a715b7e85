// compare_fields.h: the fields of a step besides the potential, at the vertices of its one mapping.
#pragma once

#include <vector>

#include "base/handles.h"
#include "compare/measured_parts.h"
#include "field/field.h"

namespace espdiff {

struct CompareOptions;

/// The fields of one state, made before the work; as many as the options name.
using StateFields = std::vector<StateField>;

/// Makes the fields of a state, or takes those of `side.input` that were made before.
/// @throws InputError naming the field
StateFields make_state_fields(const std::vector<Field>& fields, const Molecule& molecule, const FieldSide& side);

/// One side's fields, and where they are read.
struct FieldsOfSide {
  const StateFields& fields;
  const Molecule& molecule;
  AtomsPtr atoms;
  RigidTransform to_common;
  GridPtr potential;
};

/// Reads each field of both states at corresponding vertices; metrics and residues over the trusted area, of the whole
/// and of each part. Notes become warnings.
void compare_fields(Engine& engine, const std::vector<Field>& fields, const FieldsOfSide& source,
                    const FieldsOfSide& target, const CompareOptions& options, const std::vector<MeasuredPart>& parts,
                    MappedStep& step);

}  // namespace espdiff
