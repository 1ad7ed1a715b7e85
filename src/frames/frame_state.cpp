// frame_state.cpp: a frame's molecule, and everything around it where the potential needs that.
#include "frames/frame_state.h"

#include "frames/frame_files.h"
#include "prepare/take_charges.h"

namespace espdiff {

LoadedState load_frame_state(FrameFiles& files, int frame, StructureOptions structure, const LoadedState& reference,
                             bool takes_everything, const InputOptions& options, const Progress& progress,
                             StateRole role) {
  const auto [file, model] = files.file_of_frame(frame);
  const std::string name = files.name(frame);
  structure.model = model;
  LoadedState state = load_frame(*file, structure, name, reference.molecule, reference.preparation.has_value(), options,
                                 progress, role);
  if (!takes_everything || state.everything.size() > 0) return state;
  state.everything = file->read({model, true, true});
  if (!reference.everything.charges.empty()) take_values(state.everything, reference.everything, name);
  state.everything.name = name;
  return state;
}

}  // namespace espdiff
