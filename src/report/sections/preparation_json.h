// preparation_json.h: what PDB2PQR did to a structure, as JSON and as lines for a terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace espdiff {

struct LoadedState;
struct Preparation;

/// The object of a structure in OUT.json.
nlohmann::ordered_json preparation_json(const Preparation& preparation);

/// A table: bonds across the cell's border; of what was prepared, program and options, what was added, repaired and
/// protonated, the net charge.
void print_preparation(std::ostream& out, const LoadedState& state);

}  // namespace espdiff
