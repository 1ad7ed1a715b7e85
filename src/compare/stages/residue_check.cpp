// residue_check.cpp: own potentials of both sides, residues that disagree, and the noise of the grids.
#include "compare/stages/residue_check.h"

#include <algorithm>
#include <utility>

#include "align/paired_residues.h"
#include "base/not_a_number.h"
#include "base/text/short_numbers.h"
#include "certificate/own_potentials.h"
#include "certificate/residue_rows.h"
#include "certificate/trusted_area.h"
#include "engine/engine.h"
#include "mapping/sample_outside.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// [residue] a molecule's potentials on its own surface, at the first of the offsets.
std::vector<OwnPotential> own_on(const StatesToMap& states, const PotentialSide& side,
                                 const std::vector<std::int32_t>& partner_of) {
  Engine& engine = states.engine;
  const MeshPtr& mesh = side.surface.mesh;
  const AtomsPtr& atoms = side.surface.atoms;
  OutsideSamples samples =
      sample_outside(engine, side.map, mesh, atoms, states.isovalue(), states.options.offsets_A.front());
  for (std::size_t v = 0; v < samples.values.size(); ++v) {
    if (samples.inside[v] != 0) samples.values[v] = static_cast<float>(kNaN);
  }
  return own_potentials(engine.download_shape(mesh), engine.vertex_residues(mesh, atoms), samples.values, partner_of);
}

/// How much the residues' potentials differ between two meshes of one surface, the source's: what the grids alone make
/// of no difference at all.
double noise_of_residues(const StatesToMap& states, const PotentialSide& source, const std::vector<OwnPotential>& own,
                         const std::vector<std::int32_t>& target_of, std::vector<ResidueRow> rows) {
  std::vector<std::int32_t> itself(target_of.size());
  for (std::size_t r = 0; r < itself.size(); ++r) itself[r] = target_of[r] < 0 ? -1 : static_cast<std::int32_t>(r);
  set_own_differences(rows, own, own_on(states, source, target_of), itself);
  return rms_own_difference(rows);
}

Warning noise_warning(double differences, double noise, PotentialUnit unit) {
  return {"the residues' potentials differ by " + short_number(differences) + " " + to_string(unit) +
              " (rms) between the states, and by " + short_number(noise) +
              " between two meshes of the source's surface: their correlation is one of noise "
              "with noise and was not judged",
          false};
}

}  // namespace

ResidueAgreement check_residues_of(const StatesToMap& states, const PotentialSide& source, const PotentialSide& target,
                                   PotentialUnit unit, const MappedStep& step,
                                   const std::vector<std::int32_t>& target_of, MappedSurface& surface,
                                   std::vector<ResidueRow> rows) {
  ResidueAgreement agreement;
  if (target.map == nullptr || states.alignment.pairing.pairs.empty()) {
    for (ResidueRow& row : rows) row.own_difference = row.own_area_A2 = kNaN;
    agreement.is_not_checked = target.map != nullptr;
    agreement.rows = std::move(rows);
    return agreement;
  }
  const std::vector<OwnPotential> own = own_potentials(states.engine.download_shape(step.mapping.source),
                                                       surface.residue, surface.potential_source, target_of);
  const std::vector<std::int32_t> source_of = source_residues(target_of, states.target.residues.size());
  const std::vector<OwnPotential> own_on_target = own_on(states, target, source_of);
  set_own_differences(rows, own, own_on_target, target_of);
  const std::vector<std::uint8_t> disagree = disagreeing_residues(rows, own);
  const auto n_disagreeing = static_cast<std::size_t>(std::count(disagree.begin(), disagree.end(), 1));
  if (n_disagreeing > 0) {
    mark_disagreeing(surface, disagree);
    rows = residue_rows(surface, step.areas, rows.size(), true);
    set_own_differences(rows, own, own_on_target, target_of);
  }
  ResidueCheck check = check_residues(rows, own);
  check.n_disagreeing = n_disagreeing;
  bool applies = check.n_residues >= kLeastComparedResidues;
  constexpr double kSureCorrelation = 0.9;
  if (applies && !(check.correlation >= kSureCorrelation)) {
    const double differences = rms_own_difference(rows),
                 noise = noise_of_residues(states, source, own, target_of, rows);
    constexpr double kNoiseFactor = 2;
    applies = differences > kNoiseFactor * noise;
    if (!applies) agreement.warnings.push_back(noise_warning(differences, noise, unit));
  }
  if (applies) agreement.check = check;
  agreement.is_not_checked = !applies;
  agreement.rows = std::move(rows);
  return agreement;
}

}  // namespace espdiff
