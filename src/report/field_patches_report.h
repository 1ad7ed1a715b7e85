// field_patches_report.h: patches of one state as a table, as JSON and in words.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace espdiff {

struct FieldPatches;
struct Molecule;
class Record;

/// OUT.json's `field_patches`: an entry for each request, with a row for each patch of both states. The rows' keys are
/// the columns of OUT.field_patches.csv.
nlohmann::ordered_json field_patches_json(const Molecule& source, const Molecule& target,
                                          const std::vector<FieldPatches>& patches);

/// OUT.field_patches.csv.
void write_field_patches(std::ostream& out, const Molecule& source, const Molecule& target,
                         const std::vector<FieldPatches>& patches);

/// "source 12 (3 grew, 2 vanished); target 11 (1 appeared); the largest of the source 412 A^2 around ARG 12 of chain
/// A".
/// @param entry of field_patches_json()
std::string field_patches_in_words(const Record& entry);

}  // namespace espdiff
