// readings.cpp: the weights of readings on the mapped surface, and what each residue adds to them.
#include "compare/stages/readings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "base/text/short_numbers.h"
#include "base/triangle_areas.h"
#include "causes/causes.h"
#include "causes/reading.h"
#include "causes/residue_changes.h"
#include "compare/stages/cause_probes.h"
#include "engine/engine.h"
#include "mapping/map_recipe.h"
#include "mapping/sample_outside.h"
#include "options/cause_settings.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// Whether a residue is the one that a reading names.
bool is_residue(const ReadingRequest& request, const Residue& residue) {
  return residue.number == request.number && residue.insertion_code == request.insertion_code &&
         (request.chain.empty() || residue.chain == request.chain);
}

/// [triangle] nonzero outside of the region or patch that a reading names.
const std::vector<float>& outside_of_reading(const ReadingRequest& request, const std::vector<MeasuredPart>& parts) {
  const std::string name = request.of == ReadingOf::kPatch ? request.patch : kRegionPart;
  const auto wanted =
      std::find_if(parts.begin(), parts.end(), [&](const MeasuredPart& part) { return part.result.name == name; });
  if (wanted == parts.end()) throw InputError(option("causes") + ": there is no such region or patch");
  return wanted->place.outside;
}

/// [vertex] the share of the reading's area, with the metrics' area and exclusions; for the whole times the sign of the
/// difference.
std::vector<double> weights_of(const ReadingRequest& request, const std::string& name, const CompareResult& result,
                               const std::vector<MeasuredPart>& parts, const Molecule& source) {
  const MappedSurface& s = result.surface;
  std::vector<float> outside;
  if (request.of == ReadingOf::kRegion || request.of == ReadingOf::kPatch) outside = outside_of_reading(request, parts);
  std::vector<double> weights = corner_areas(
      s.positions, s.triangles, [&](std::size_t t) { return s.why[t] == 0 && (outside.empty() || outside[t] == 0); });
  if (request.of == ReadingOf::kResidue) {
    for (std::size_t v = 0; v < weights.size(); ++v) {
      if (s.residue[v] < 0 || !is_residue(request, source.residues[static_cast<std::size_t>(s.residue[v])]))
        weights[v] = 0;
    }
  }
  double all = 0;
  for (const double w : weights) all += w;
  if (!(all > 0))
    throw InputError(
        option("causes", name) +
        ": none of its surface is trusted, so that there is no difference to explain; take a part of the surface "
        "that is");
  for (std::size_t v = 0; v < weights.size(); ++v) {
    weights[v] /= all;
    if (request.of == ReadingOf::kWhole && s.potential_target[v] < s.potential_source[v]) weights[v] = -weights[v];
  }
  return weights;
}

double reading_of(const std::vector<double>& weights, const std::vector<float>& potential) {
  double sum = 0;
  for (std::size_t v = 0; v < weights.size(); ++v) {
    if (weights[v] != 0) sum += weights[v] * static_cast<double>(potential[v]);
  }
  return sum;
}

std::vector<Vec3d> places_of(const std::vector<double>& weights, const std::vector<Vec3d>& positions) {
  std::vector<Vec3d> places;
  for (std::size_t v = 0; v < weights.size(); ++v) {
    if (weights[v] != 0) places.push_back(positions[v]);
  }
  return places;
}

/// [change] nonzero for residues with surface: the source's, by its vertices, and their partners. A residue that the
/// target has alone is taken for one at the surface; inside, its placements clash.
std::vector<std::uint8_t> at_surface(const CompareResult& result, const Causes& causes) {
  std::vector<bool> has_surface;
  for (const std::int32_t residue : result.surface.residue) {
    if (residue < 0) continue;
    const auto r = static_cast<std::size_t>(residue);
    if (r >= has_surface.size()) has_surface.resize(r + 1, false);
    has_surface[r] = true;
  }
  std::vector<std::uint8_t> at;
  for (const ResidueChange& change : causes.changes) {
    const auto r = static_cast<std::size_t>(change.source);
    at.push_back(change.source < 0 || (r < has_surface.size() && has_surface[r]) ? 1 : 0);
  }
  return at;
}

/// Splits what charges and probes add: the probes' values, the charges' stay.
std::vector<double> take_probes(std::vector<double>& values, std::size_t n_charges) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(n_charges);
  std::vector<double> of_probes(first, values.end());
  values.erase(first, values.end());
  return of_probes;
}

}  // namespace

void check_causes(const CompareOptions& options, const CompareInput& source, const CompareInput& target) {
  if (!source.make_map || !target.make_map)
    throw InputError(option("causes") +
                     " needs potentials that are computed for both states: a given map does not say which charges it "
                     "is made of; leave the maps out, and let " +
                     option("potential") + " be pb, pme or coulomb");
  for (const std::string& text : options.causes) {
    const ReadingRequest request = parse_reading(text);
    if (request.of == ReadingOf::kPatch) require_patch(options, text, request.patch);
    if (request.of != ReadingOf::kResidue) continue;
    const std::vector<Residue>& residues = source.molecule->residues;
    const auto n = std::count_if(residues.begin(), residues.end(),
                                 [&](const Residue& residue) { return is_residue(request, residue); });
    if (n == 1) continue;
    throw InputError(option("causes", text) + ": " + source.molecule->name + " has " +
                     (n == 0 ? "no such residue" : std::to_string(n) + " such residues; name the chain"));
  }
}

void refuse_nonlinear(const CompareOptions& options, const MapRecipe& recipe) {
  if (options.causes.empty() || recipe.method != PotentialMethod::kPoissonBoltzmann || !recipe.pb.nonlinear) return;
  throw InputError(option("causes") +
                   " with the nonlinear Poisson-Boltzmann equation: its potential is not a sum over charges, so that "
                   "no charge has a part of its own; take the linearized equation");
}

PotentialReading weighted_reading(const std::vector<Vec3f>& points, const std::vector<double>& weights,
                                  const std::vector<float>& potential) {
  PotentialReading reading;
  double sum = 0, sizes = 0;
  for (std::size_t v = 0; v < weights.size(); ++v) {
    if (weights[v] == 0) continue;
    reading.points.push_back(points[v]);
    reading.weights.push_back(weights[v]);
    const double part = weights[v] * static_cast<double>(potential[v]);
    sum += part;
    sizes += std::fabs(part);
  }
  if (sizes > 0) reading.share_left = std::fabs(sum) / sizes;
  return reading;
}

Readings take_readings(Engine& engine, const ComparedSide& source, const ComparedSide& target,
                       const CompareOptions& options, const std::vector<MeasuredPart>& parts,
                       std::vector<std::int32_t> target_of, const MappedStep& step, const CompareResult& result) {
  const float isovalue = static_cast<float>(options.surface.isovalue);
  const auto points_of = [&](const ComparedSide& side, const MeshPtr& mesh) {
    return engine.download_positions(
        moved_outside(engine, mesh, side.surface.atoms, isovalue, options.offsets_A.front()));
  };
  const std::vector<Vec3f> on_source = points_of(source, step.mapping.source),
                           on_target = points_of(target, step.mapping.mapped);
  Readings readings;
  for (const std::string& text : options.causes) {
    readings.weights.push_back(weights_of(parse_reading(text), text, result, parts, *source.input.molecule));
    const std::vector<double>& weights = readings.weights.back();
    readings.of_source.push_back(weighted_reading(on_source, weights, result.surface.potential_source));
    readings.of_target.push_back(weighted_reading(on_target, weights, result.surface.potential_target));
  }
  readings.source_map = engine.without_values(source.map.map);
  readings.target_map = engine.without_values(target.map.map);
  readings.target_of = std::move(target_of);
  return readings;
}

FoundCauses find_causes(Engine& engine, Readings readings, const SideCharges& source, const SideCharges& target,
                        const CompareOptions& options, const CompareResult& result, const Progress& progress) {
  auto causes = std::make_shared<Causes>();
  causes->changes = residue_changes({source.molecule, target.molecule, readings.target_of, result.alignment.pairing,
                                     result.inputs.protonation, result.alignment.source_to_target});
  causes->knows_places = knows_places(source.molecule) || knows_places(target.molecule);
  for (const Residue& residue : source.molecule.residues)
    causes->has_chains = causes->has_chains || residue.chain != source.molecule.residues.front().chain;
  const std::vector<std::uint8_t> may_move = at_surface(result, *causes);
  const StateProbes source_probes = probes_of(source.molecule, source.to_common, *causes, false, may_move, options),
                    target_probes = probes_of(target.molecule, target.to_common, *causes, true, may_move, options);
  // One state after the other: what the first one's potential left is not needed for the second.
  auto of_source = engine.contributions(std::exchange(readings.source_map, nullptr), readings.of_source,
                                        source_probes.charges, progress);
  auto of_target = engine.contributions(readings.target_map, readings.of_target, target_probes.charges, progress);
  const auto depends_on_shape = [](const std::shared_ptr<const MapRecipe>& recipe) {
    return recipe != nullptr && recipe->method == PotentialMethod::kPoissonBoltzmann;
  };
  const bool is_exact = !depends_on_shape(result.maps.source_recipe) && !depends_on_shape(result.maps.target_recipe);
  const MappedSurface& s = result.surface;
  for (std::size_t r = 0; r < readings.weights.size(); ++r) {
    const std::vector<double>& weights = readings.weights[r];
    const std::vector<double> source_values = take_probes(of_source[r], source.charges.size()),
                              target_values = take_probes(of_target[r], target.charges.size());
    add_reading(*causes, options.causes[r],
                {source.molecule, source.charges, of_source[r], places_of(weights, s.source_positions),
                 reading_of(weights, s.potential_source)},
                {target.molecule, target.charges, of_target[r], places_of(weights, s.positions),
                 reading_of(weights, s.potential_target)});
    add_probed(*causes, source_probes, source_values, target_probes, target_values, is_exact, options);
  }
  FoundCauses found;
  for (const CausesOfReading& reading : causes->readings) {
    if (!reading.placements || !reading.placements->spans_zero()) continue;
    found.warnings.push_back({"the difference of " + reading.name + " is " + short_number(reading.difference()) +
                                  ", and " + short_number(reading.placements->low) + " to " +
                                  short_number(reading.placements->high) +
                                  " with side chains in other places: its sign is not known",
                              false});
  }
  found.causes = std::move(causes);
  return found;
}

}  // namespace espdiff
