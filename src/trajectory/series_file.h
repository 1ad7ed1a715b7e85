// series_file.h: the state of a series as a file, so that an interrupted run goes on with the same bits.
#pragma once

#include <string>

#include "compare/series.h"

namespace espdiff {

/// Writes the state in place of an older one; the file is complete or as it was before.
/// CBOR: the format's name and version, the fingerprint, and the state with its SHA-256. Arrays are byte strings in the
/// machine's own number format. By the morph it takes about 60 bytes a vertex and 50 an atom.
/// @param fingerprint what the state belongs to, in one line: read_series_state() wants the same
/// @throws IoError
void write_series_state(const std::string& path, const SeriesState& state, const std::string& fingerprint);

/// @throws IoError (missing, unreadable), FormatError (damaged, cut off, of another version, another file), InputError
/// (of another fingerprint); each
/// says what to do
SeriesState read_series_state(const std::string& path, const std::string& fingerprint);

}  // namespace espdiff
