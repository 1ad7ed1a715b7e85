// pair_study.cpp: the order of a pair's parts.
#include "study/pair_study.h"

#include <optional>
#include <utility>

#include "compare/compare.h"
#include "engine/engine.h"
#include "prepare/charges/preparation.h"
#include "prepare/region.h"
#include "prepare/surface_radii.h"
#include "report/state_report.h"
#include "study/pair_interface.h"

namespace espdiff {

Provenance provenance_of(const Engine& engine, const std::string& command_line, const ComparedState& source,
                         const ComparedState& target) {
  Provenance provenance;
  provenance.device = engine.back_end();
  provenance.device_description = engine.description();
  provenance.threads = engine.n_threads();
  provenance.command_line = command_line;
  for (const auto* inputs : {&source.inputs, &target.inputs, &source.map_inputs, &target.map_inputs})
    provenance.inputs.insert(provenance.inputs.end(), inputs->begin(), inputs->end());
  for (const ComparedState* state : {&source, &target}) {
    if (state->loaded.preparation)
      provenance.preparations.emplace_back(state->role, std::make_shared<Preparation>(*state->loaded.preparation));
  }
  return provenance;
}

PairAnswer run_pair(const PairStudy& study, Engine& engine, const Progress& progress) {
  progress.report("read", 0.0);
  PairAnswer answer;
  answer.options = study.options;
  const InputOptions& input = study.options.input;
  const bool has_interface = !study.options.interface.empty();
  const StatePtr given_source = has_interface ? PairInterface::without_others(study.source) : study.source,
                 given_target = has_interface ? PairInterface::without_others(study.target) : study.target;
  StateReader reader({study.options, study.potential, study.each_by_itself, study.refuses_shapes, engine.n_threads()},
                     {given_source, given_target}, progress);
  ComparedState source = reader.read(StateRole::kSource, nullptr, study.target.get());
  Molecule& source_molecule = source.loaded.molecule;
  ComparedState target = reader.read(StateRole::kTarget, &source_molecule);
  Molecule& target_molecule = target.loaded.molecule;
  std::optional<PairInterface> interface;
  if (has_interface) interface.emplace(study.options, source, target);
  const PotentialPlan plan = reader.add_maps({&source, &target});

  answer.provenance = provenance_of(engine, study.command_line, source, target);
  for (const ComparedState* state : {&source, &target}) {
    for (KeptFile& file : kept_structure(state->role, state->loaded)) answer.kept.push_back(std::move(file));
  }
  if (study.check_kept) study.check_kept(answer.kept);
  const std::string radii_note = set_surface_radii({&source_molecule, &target_molecule}, input.radii);
  source.take_parts(source_parts(source_molecule, source.whole(), target_molecule, target.whole(), input));
  if (interface) interface->make_fields(engine, *given_source, *given_target, plan, progress);
  answer.result = compare(engine, source.side(), target.side(), study.options, progress);
  if (interface) interface->add_to(answer.result);
  note_states(answer.result, source.loaded, target.loaded, radii_note);
  if (!answer.result.potential.compared)
    answer.result.inputs.shapes_because = plan.because().empty() ? study.source->shapes_because : plan.because();
  answer.source_molecule = std::move(source_molecule);
  answer.target_molecule = std::move(target_molecule);
  return answer;
}

}  // namespace espdiff
