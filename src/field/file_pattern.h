// file_pattern.h: names of files with places for the state's: one file for each variant or frame.
#pragma once

#include <cstddef>
#include <string>

#include "field/field_side.h"

namespace espdiff {

/// How many places for a frame's number, `%d` or `%03d`, a pattern has.
std::size_t count_frame_places(const std::string& pattern);

/// Whether it has a place of any kind.
bool is_pattern(const std::string& pattern);

/// Fills `{label}`, `{group}` and `{replicate}`, and the first `%d` (or `%03d`: with zeros, of at least three digits)
/// with the frame's number.
/// @param what the option and its value, for messages
/// @throws InputError (a place for what the state lacks)
std::string fill_pattern(const std::string& pattern, const FieldInput& state, const std::string& what);

}  // namespace espdiff
