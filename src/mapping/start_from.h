// start_from.h: where a mapping starts.
#pragma once

namespace espdiff {

/// Start of a mapping: the source's surface, or the previous target's, which is closer if targets are the frames of a
/// trajectory.
enum class StartFrom { kSource, kPrevious };

}  // namespace espdiff
