// frame_state.h: a frame of a series, loaded with what the reference of all frames has.
#pragma once

#include <string>

#include "base/progress.h"
#include "prepare/load_state.h"

namespace espdiff {

class FrameFiles;

/// Loads a frame as load_frame() does; with water and ions where the potential counts them, whose charges are then
/// those of the reference unless the frame has its own.
/// @param frame     from 0, of all files
/// @param takes_everything see PotentialPlan
/// @param role      whose selection and topology count
/// @param reference the state that the frames take charges and preparation from
/// @throws as load_frame(), take_values()
LoadedState load_frame_state(FrameFiles& files, int frame, StructureOptions structure, const LoadedState& reference,
                             bool takes_everything, const InputOptions& options, const Progress& progress,
                             StateRole role = StateRole::kTarget);

}  // namespace espdiff
