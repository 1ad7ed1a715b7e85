// causes_report.h: the causes of readings in words, as a table, and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace espdiff {

struct Causes;
struct CausesOfReading;
struct CompareResult;

/// One sentence: the reading, what the residues of each kind add to it with the largest of them, and the rest:
/// "the difference is -0.83 kT/e: -0.72 from 27 side chains that turned (LYS 118, chi 1 by 132 degrees, -0.36, ...);
/// ...".
std::string causes_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit);
/// How much of the difference residues make whose place the structure files know poorly, and which.
std::string certainty_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit);
/// OUT.json's `causes`: an entry for each reading.
nlohmann::ordered_json causes_json(const Causes& causes, const std::string& unit);
/// OUT.causes.csv: for each reading each residue of either state, the largest difference first.
void write_causes(std::ostream& out, const Causes& causes, const std::string& unit);

}  // namespace espdiff
