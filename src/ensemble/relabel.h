// relabel.h: other groups of the frames that an ensemble file has.
#pragma once

#include <vector>

namespace espdiff {

class EnsembleFile;
struct ReplicateRequest;

/// Makes the file's replicates, or some of their frames, members of other groups, so that what has no difference can
/// be compared by one command: halves of a run, runs of one state. Nothing is mapped, and the file is not written.
/// @param members their `group`, and in `files` the replicate: NAME, or GROUP/NAME where groups have one of that name,
///        with @FRAMES for some of its frames (see parse_frames())
/// @throws InputError (no such replicate; a frame twice; one frame; more than two groups)
void relabel(EnsembleFile& file, const std::vector<ReplicateRequest>& members);

}  // namespace espdiff
