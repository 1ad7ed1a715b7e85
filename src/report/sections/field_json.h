// field_json.h: what a field is as JSON: label, unit, signed, kind, reference, files.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "field/field_result.h"

namespace espdiff {

/// An entry of `fields`, without its name.
nlohmann::ordered_json field_json(const Quantity& quantity, const std::string& what, const std::string& reference,
                                  const std::vector<FieldFile>& files);

/// Fields by name, in their order.
nlohmann::ordered_json fields_json(const std::vector<FieldDescription>& fields);
/// @throws nlohmann::json::exception
std::vector<FieldDescription> parse_fields_json(const nlohmann::ordered_json& json);

/// What follows `# field NAME: ` in the head of a table: label, unit, signed, kind, SHA-256 of the files, on one line.
std::string field_head_text(const FieldDescription& field);
/// The fields of a table. @param comments lines of its head, without `#`; damaged ones are passed over
std::vector<Quantity> fields_in_head(const std::vector<std::string>& comments);
/// What stands before a field's name in a head.
constexpr const char* kFieldInHead = "field ";

/// Of fields that are described.
std::vector<Quantity> quantities_of(const std::vector<FieldDescription>& fields);

}  // namespace espdiff
