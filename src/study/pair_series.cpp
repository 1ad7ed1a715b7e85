// pair_series.cpp: the order of a step's parts.
#include "study/pair_series.h"

#include <utility>

#include "engine/engine.h"
#include "report/state_report.h"

namespace espdiff {

PairSeries::PairSeries(PairStudy study, StartFrom start) : study_(std::move(study)), start_(start) {}

StatesRequest PairSeries::request() const {
  return {study_.options, study_.potential, study_.each_by_itself, study_.refuses_shapes};
}

void PairSeries::begin(Engine& engine, const Progress& progress) {
  if (series_ != nullptr) return;
  StateReader reader(request(), {study_.source}, progress);
  ComparedState source = reader.read(StateRole::kSource);
  states_.set_plan(reader.add_maps({&source}));
  states_.take_source(std::move(source), nullptr);
  source_ = states_.source_side();
  series_ = std::make_unique<Series>(engine, *source_, study_.options);
}

PairAnswer PairSeries::step(const StatePtr& target, Engine& engine, const Progress& progress) {
  begin(engine, progress);
  const StepInput sides =
      states_.step(StateReader(request(), {target}, progress).read_frame(states_.source().loaded), *target);
  PairAnswer answer;
  answer.options = study_.options;
  answer.provenance = provenance_of(engine, study_.command_line, states_.source(), states_.frame());
  answer.result = series_->step(sides.target, start_, progress);
  note_states(answer.result, *sides.source_origin, *sides.target_origin, {});
  if (!answer.result.potential.compared) answer.result.inputs.shapes_because = states_.plan().because();
  answer.source_molecule = states_.surface();
  answer.target_molecule = states_.frame().loaded.molecule;
  return answer;
}

}  // namespace espdiff
