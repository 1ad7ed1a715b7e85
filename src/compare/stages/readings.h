// readings.h: readings of the potentials on a mapped surface, and their causes.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compare/stages/potentials.h"
#include "engine/potential_stage.h"
#include "mapping/input.h"

namespace espdiff {

struct CompareOptions;

/// Before any work. @throws InputError (a potential that is not computed, a residue that the source lacks)
void check_causes(const CompareOptions& options, const CompareInput& source, const CompareInput& target);

/// As soon as the first potential is known. @throws InputError for causes of the nonlinear equation
void refuse_nonlinear(const CompareOptions& options, const MapRecipe& recipe);

/// What the causes of a step's readings are found from besides its result: neither surfaces nor potentials, which may
/// be gone by then.
struct Readings {
  std::vector<std::vector<double>> weights;  ///< [reading][vertex]
  /// [reading]
  std::vector<PotentialReading> of_source, of_target;
  GridPtr source_map, target_map;  ///< without values
  std::vector<std::int32_t> target_of;
};

/// The points of one reading whose weight is not zero.
/// @param points, weights, potential [vertex]; the potential as sampled there
PotentialReading weighted_reading(const std::vector<Vec3f>& points, const std::vector<double>& weights,
                                  const std::vector<float>& potential);

/// The readings that the options ask for. The result's surface and residues are complete.
/// @param target_of [source residue] from paired_residues()
/// @throws InputError for a reading without surface
Readings take_readings(Engine& engine, const ComparedSide& source, const ComparedSide& target,
                       const CompareOptions& options, const std::vector<MeasuredPart>& parts,
                       std::vector<std::int32_t> target_of, const MappedStep& step, const CompareResult& result);

/// A molecule as it is compared, its charges in the order of its map, and its place.
struct SideCharges {
  const Molecule& molecule;
  const Molecule& charges;
  RigidTransform to_common;
};

struct FoundCauses {
  std::shared_ptr<const Causes> causes;
  std::vector<Warning> warnings;
};

/// The causes of the readings of a result that is complete but for them.
/// @throws as Engine::contributions()
FoundCauses find_causes(Engine& engine, Readings readings, const SideCharges& source, const SideCharges& target,
                        const CompareOptions& options, const CompareResult& result, const Progress& progress);

}  // namespace espdiff
