// series_file.h: saves the state of a series, so that an interrupted run continues with the same bits.
#pragma once

#include <string>

#include "compare/series.h"

namespace espdiff {

/// Replaces the saved state. The file is either complete or unchanged.
/// CBOR: the format's name and version, the fingerprint, and the state with its SHA-256. Arrays are byte strings in the
/// machine's number format. A state of the morph takes about 60 bytes a vertex and 50 an atom.
/// @param fingerprint identifies the run and the frame; read_series_state() needs the same
/// @throws IoError
void write_series_state(const std::string& path, const SeriesState& state, const std::string& fingerprint);

/// @throws IoError (missing, unreadable), FormatError (damaged, cut off, of another version, another file), InputError
/// (of another fingerprint); each says what to do
SeriesState read_series_state(const std::string& path, const std::string& fingerprint);

}  // namespace espdiff
