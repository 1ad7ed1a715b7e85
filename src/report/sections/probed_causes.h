// probed_causes.h: scans and placements of side chains in words, as a table, and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>

namespace espdiff {

struct Causes;
struct CausesOfReading;
struct CompareResult;

/// "with 34 side chains in other places (...): -0.83 (-0.95 to -0.35) kT/e, ...". @pre the reading has placements
std::string placements_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit);
/// The residues whose charges' removal or change by +1 shifts the source's reading most. @pre the reading has a scan
std::string scan_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit);

nlohmann::ordered_json placements_json(const Causes& causes, const CausesOfReading& reading);
nlohmann::ordered_json scan_json(const Causes& causes, const CausesOfReading& reading);

/// OUT.scan.csv: for each reading each residue of either state, the largest shift first.
void write_scan(std::ostream& out, const Causes& causes, const std::string& unit);
/// OUT.side-chains.csv: for each reading each placement of the side chains that may lie otherwise, the file's
/// first; the largest range first.
void write_side_chains(std::ostream& out, const Causes& causes, const std::string& unit);

}  // namespace espdiff
