// compare_fields.h: the fields of a step besides the potential, at the vertices of its one mapping.
#pragma once

#include <vector>

#include "base/handles.h"
#include "compare/stages/measured_parts.h"
#include "field/field.h"

namespace espdiff {

struct CompareOptions;

/// The fields of one state, made before the work; as many as the options name.
using StateFields = std::vector<StateField>;

/// Makes the fields of a state, or takes those of `side.input` that were made before.
/// @throws InputError naming the field
StateFields make_state_fields(const std::vector<Field>& fields, const Molecule& molecule, const FieldSide& side);

/// @throws InputError naming the first field that is made of the potential
void refuse_fields_of_potential(const std::vector<Field>& fields);

/// One side's fields, and where they are read.
struct FieldsOfSide {
  const StateFields& fields;
  const Molecule& molecule;
  AtomsPtr atoms;
  RigidTransform to_common;
  GridPtr potential;
};

/// The fields of both states on the mapping, and what was noted of them.
struct ComparedFields {
  std::vector<FieldResult> fields;
  std::vector<Warning> warnings;
};

/// Reads each field of both states at corresponding vertices; metrics and residues over the trusted area, of the whole
/// and of each part. Notes become warnings.
/// @param result with its mapped surface and the potentials' unit  @param parts receive their fields
ComparedFields compare_fields(Engine& engine, const std::vector<Field>& fields, const FieldsOfSide& source,
                              const FieldsOfSide& target, const CompareOptions& options, const MappedStep& step,
                              const CompareResult& result, std::vector<MeasuredPart>& parts);

}  // namespace espdiff
