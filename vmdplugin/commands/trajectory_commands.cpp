// trajectory_commands.cpp: runs over frames, step by step from Tcl; ranges of frames; CSV tables.
#include <sstream>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "commands.h"
#include "engine/engine.h"
#include "frames/frame_range.h"
#include "frames/frame_state.h"
#include "io/files/read_csv.h"
#include "io/files/write_csv.h"
#include "potential/potential.h"
#include "potential/potential_settings.h"
#include "study/trajectory_study.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

SeriesHead pairs_of(Tcl_Obj* list, const std::string& what) {
  SeriesHead pairs;
  const std::vector<Tcl_Obj*> words = to_vector(list, what);
  for (std::size_t i = 0; i + 1 < words.size(); i += 2)
    pairs.emplace_back(to_string(words[i]), to_string(words[i + 1]));
  return pairs;
}

/// A computed potential with all its settings as text; other maps unchanged.
std::string map_in_words(Tcl_Obj* map, double temperature_K) {
  const std::vector<Tcl_Obj*> words = to_vector(map, "map");
  const std::string kind = words.empty() ? std::string() : to_string(words[0]);
  if (kind != "pb" && kind != "pme" && kind != "coulomb") return to_string(map);
  GivenPotentialSettings given;
  std::string others;  // which atoms, which cell, over how many frames
  for (std::size_t i = 1; i + 1 < words.size(); i += 2) {
    const std::string key = to_string(words[i]), value = to_string(words[i + 1]);
    if (key == "sel" || key == "cell" || key == "average") {
      others += " " + key + " " + value;
    } else {
      given.emplace_back(key, value);
    }
  }
  return potential_in_words(make_potential_options(parse_potential_method(kind), given, temperature_K)) + others;
}

SeriesDescription parse_description(DictReader& reader, double temperature_K) {
  SeriesDescription run;
  if (Tcl_Obj* const file = reader.find("file")) run.files = {to_string(file)};
  if (Tcl_Obj* const molecule = reader.find("molecule")) run.molecule = pairs_of(molecule, "molecule");
  run.reference = to_string(reader.require("reference"));
  if (Tcl_Obj* const map = reader.find("map")) run.map = map_in_words(map, temperature_K);
  if (Tcl_Obj* const map = reader.find("reference_map")) run.reference_map = map_in_words(map, temperature_K);
  return run;
}

Reference parse_reference(const std::string& text) {
  if (text == "one") return Reference::kOne;
  if (text == "previous") return Reference::kPrevious;
  if (text == "same") return Reference::kSame;
  throw InputError("against: '" + text + "' is not one, previous or same");
}

/// PLAN: csv FILE, the options of trajectory_settings() by name, numbers LIST (of the frames) reference TEXT
/// ?row_reference TEXT? ?against one|previous|same? ?source_file PATH? (whose frames are the sources) ?map TEXT?
/// ?reference_map TEXT? ?one_map B? ?region B? (the reference has one) inputs FILES (which no output may replace) and
/// file PATH or molecule {NAME TEXT ...}, lines of the head.
Tcl_Obj* trajectory(const Call& call) {
  auto object = std::make_shared<TrajectoryObject>();
  DictReader options(call.arguments[1], "options");
  object->computation = parse_computation(options, nullptr);
  DictReader reader(call.arguments[0], "plan");
  TrajectoryRequest request;
  request.csv = to_string(reader.require("csv"));
  reader.take(trajectory_settings(), request);
  SeriesDescription run = parse_description(reader, object->computation.options.temperature_K);
  TrajectoryPlan plan;
  plan.options = object->computation.options;
  for (Tcl_Obj* const frame : to_vector(reader.require("numbers"), "numbers"))
    plan.frames.push_back(to_int(frame, "numbers"));
  plan.against = parse_reference(reader.text("against", "one"));
  plan.reference = reader.text("row_reference", run.reference);
  plan.compared = parts_and_fields(plan.options);
  if (reader.boolean("region", false) && !plan.options.input.has_region())
    plan.compared.parts.insert(plan.compared.parts.begin(), kRegionPart);
  object->one_map = reader.boolean("one_map", false);
  object->against = plan.against;
  const std::string source_file = reader.text("source_file", "");
  std::vector<std::string> inputs = run.files;
  for (Tcl_Obj* const path : to_vector(reader.require("inputs"), "inputs")) inputs.push_back(to_string(path));
  reader.finish();
  inputs.push_back(source_file);
  check_request(request, plan.options, std::move(inputs));
  if (!source_file.empty()) run.reference_files = {source_file};
  if (!run.files.empty()) object->files = std::make_unique<FrameFiles>(run.files);
  if (!source_file.empty()) object->source_files = std::make_unique<FrameFiles>(std::vector{source_file});
  object->steps = std::make_unique<TrajectorySteps>(request, std::move(plan), std::move(run), *object, object->states);
  return to_obj(call.handles.add(object));
}

/// The run of a handle, between two steps.
std::shared_ptr<TrajectoryObject> resting(const Call& call) {
  auto object = call.handles.find_trajectory(call.text(0));
  if (object->job != nullptr && !object->job->finished())
    throw InputError(call.text(0) + " is still comparing a frame; wait for it");
  return object;
}

/// The next step, {frame N reference R source S}; empty after the last one. S is the frame that is the source, unless
/// all frames have one.
Tcl_Obj* trajectory_next(const Call& call) {
  const auto object = resting(call);
  if (object->run().is_done()) return Tcl_NewObj();
  const TrajectoryStep& step = object->run().next();
  return to_dict({{"frame", to_obj(step.frame)},
                  {"reference", to_obj(step.reference)},
                  {"source", step.source ? to_obj(*step.source) : Tcl_NewObj()}});
}

/// The source of all frames.
Tcl_Obj* trajectory_source(const Call& call) {
  resting(call)->source = shared_endpoint(call.arguments[1], "source");
  return nullptr;
}

/// pme takes the water of a file's frames.
bool takes_everything(const State& state) {
  if (!state.potential || state.potential->charges.size() > 0) return false;
  return state.potential->method == PotentialMethod::kPme;
}

/// Compares and writes one frame, on the worker's thread.
void run_step(TrajectoryObject& object, const Progress& progress) {
  object.row.reset();
  if (object.engine == nullptr) object.engine = engine_for(object.computation);
  if (const SeriesRow* const row = object.steps->step(*object.engine, progress)) object.row = *row;
}

/// The sides of a frame: TARGET, and SOURCE unless all frames have one.
Tcl_Obj* trajectory_step(const Call& call) {
  const auto object = resting(call);
  if ((object->against != Reference::kOne) != (call.arguments.size() > 2))
    throw InputError("a source is given for each frame, unless all frames have one");
  if (object->against == Reference::kOne && object->source == nullptr)
    throw InputError(call.text(0) + " has no source yet; give it by trajectory_source");
  object->target = shared_endpoint(call.arguments[1], "target");
  if (object->against != Reference::kOne) object->source = shared_endpoint(call.arguments[2], "source");
  object->job = Worker::instance().submit([keep = std::weak_ptr<TrajectoryObject>(object)](const Progress& progress) {
    if (const auto alive = keep.lock()) run_step(*alive, progress);
  });
  return nullptr;
}

/// The next frame failed with MESSAGE and errorcode {ESPDIFF CLASS}: writes a row with the error, or throws it.
Tcl_Obj* trajectory_skip(const Call& call) {
  const auto object = resting(call);
  object->row.reset();
  if (const SeriesRow* const row = object->run().skip(error_of_class(call.text(2), call.text(1)))) object->row = *row;
  return nullptr;
}

/// The row that the last step added, by column; empty if the file had it already.
Tcl_Obj* trajectory_row(const Call& call) {
  const auto object = resting(call);
  Tcl_Obj* const dict = Tcl_NewDictObj();
  if (!object->row) return dict;
  for (const std::string& column : object->row->columns())
    Tcl_DictObjPut(nullptr, dict, to_obj(column), to_obj((*object->row)[column]));
  return dict;
}

Tcl_Obj* trajectory_columns(const Call&) { return to_list(series_columns()); }

Tcl_Obj* trajectory_summary(const Call& call) {
  const auto object = resting(call);
  const TrajectorySummary s = object->run().summary();
  return to_dict({{"frames", to_obj(s.n_frames)},
                  {"rows", to_obj(s.n_rows)},
                  {"skipped", to_obj(s.n_skipped)},
                  {"resumed", to_obj(s.n_resumed)},
                  {"csv", to_obj(object->run().file().path())}});
}

/// Reason why the first mapping of a resumed run starts from the source; usually empty.
Tcl_Obj* trajectory_warning(const Call& call) { return to_obj(resting(call)->run().warning()); }

/// Ends the run between two frames; throws the error of a cancelled run.
Tcl_Obj* trajectory_cancelled(const Call& call) { throw resting(call)->run().cancelled(); }

/// OPTION TEXT N NOW OF: a list of frames; NOW is empty if there is no current frame.
Tcl_Obj* frames(const Call& call) {
  FrameSet set;
  set.what = call.text(0);
  set.n_frames = to_int(call.arguments[2], "number of frames");
  if (!call.text(3).empty()) set.now = to_int(call.arguments[3], "now");
  set.of = call.text(4);
  std::vector<Tcl_Obj*> all;
  for (const int frame : parse_frames(call.text(1), set)) all.push_back(to_obj(frame));
  return to_list(all);
}

/// {columns LIST rows LIST}, each row a dict by column.
Tcl_Obj* read_table(const Call& call) {
  const CsvTable table = read_csv(call.text(0));
  std::vector<Tcl_Obj*> rows;
  for (const auto& cells : table.rows) {
    rows.push_back(Tcl_NewDictObj());
    for (std::size_t i = 0; i < cells.size(); ++i)
      Tcl_DictObjPut(nullptr, rows.back(), to_obj(table.columns[i]), to_obj(cells[i]));
  }
  return to_dict({{"columns", to_list(table.columns)}, {"rows", to_list(rows)}});
}

/// Rows, each a list of fields, as the text of a CSV file.
Tcl_Obj* csv_text(const Call& call) {
  std::ostringstream text;
  for (Tcl_Obj* const row : to_vector(call.arguments[0], "rows")) {
    std::vector<std::string> fields;
    for (Tcl_Obj* const field : to_vector(row, "row")) fields.push_back(to_string(field));
    write_csv_row(text, fields);
  }
  return to_obj(text.str());
}

}  // namespace

/// A frame of the run's file through its one open text, or what Tcl gave.
ComparedState TrajectoryObject::read(StateRole role, std::optional<int> frame, const SeriesStates& read_states,
                                     const Progress& progress) {
  const CompareOptions& options = computation.options;
  const bool is_source = role == StateRole::kSource;
  const StatePtr& state_given = is_source ? source : target;
  const LoadedState& reference = read_states.source().loaded;
  FrameFiles* const frames = is_source && against == Reference::kSame ? source_files.get() : files.get();
  if (!frame || frames == nullptr || state_given->path.empty())
    return StateReader({options, {}, true}, {state_given}, progress)
        .read(role, is_source ? nullptr : &reference.molecule);
  ComparedState state;
  state.role = to_string(role);
  static const LoadedState none;
  state.loaded = load_frame_state(*frames, *frame, state_given->structure, is_source ? none : reference,
                                  takes_everything(*state_given), options.input, progress, role);
  if (is_source && state_given->potential)
    state.loaded.preparation =
        charge_molecule(state.loaded.molecule, options.input, {}, state.loaded.charge_files, progress);
  return state;
}

/// The one source, and a map of all frames.
std::vector<InputFile> TrajectoryObject::inputs(const SeriesStates& read_states) const {
  std::vector<InputFile> all;
  const ComparedState& one = read_states.source();
  if (against == Reference::kOne) {
    all = one.inputs;
    all.insert(all.end(), one.map_inputs.begin(), one.map_inputs.end());
  }
  const std::vector<InputFile>& of_map = read_states.frame().map_inputs;
  if (one_map) all.insert(all.end(), of_map.begin(), of_map.end());
  return all;
}

std::vector<Command> trajectory_commands() {
  return {{"trajectory", 2, 2, "plan options", trajectory},
          {"trajectory_source", 2, 2, "handle source", trajectory_source},
          {"trajectory_next", 1, 1, "handle", trajectory_next},
          {"trajectory_step", 2, 3, "handle target ?source?", trajectory_step},
          {"trajectory_skip", 3, 3, "handle message class", trajectory_skip},
          {"trajectory_row", 1, 1, "handle", trajectory_row},
          {"trajectory_columns", 0, 0, "", trajectory_columns},
          {"trajectory_summary", 1, 1, "handle", trajectory_summary},
          {"trajectory_warning", 1, 1, "handle", trajectory_warning},
          {"trajectory_cancelled", 1, 1, "handle", trajectory_cancelled},
          {"frames", 5, 5, "option text number now of", frames},
          {"read_csv", 1, 1, "file", read_table},
          {"csv_text", 1, 1, "rows", csv_text}};
}

}  // namespace espdiff::vmdplugin
