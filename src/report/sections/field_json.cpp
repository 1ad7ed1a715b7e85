// field_json.cpp: descriptions of fields as JSON, and back.
#include "report/sections/field_json.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace espdiff {

using Json = nlohmann::ordered_json;

Json field_json(const Quantity& quantity, const std::string& what, const std::string& reference,
                const std::vector<FieldFile>& files) {
  Json json = {{"label", quantity.label}, {"unit", quantity.unit}, {"signed", quantity.is_signed}, {"kind", what},
               {"reference", reference},  {"files", Json::array()}};
  for (const FieldFile& file : files) json["files"].push_back({{"path", file.path}, {"sha256", file.sha256}});
  return json;
}

Json fields_json(const std::vector<FieldDescription>& fields) {
  Json json = Json::object();
  for (const FieldDescription& field : fields)
    json[field.quantity.name] = field_json(field.quantity, field.what, field.reference, field.files);
  return json;
}

std::vector<FieldDescription> parse_fields_json(const Json& json) {
  std::vector<FieldDescription> fields;
  for (const auto& [name, entry] : json.items()) {
    FieldDescription field{
        {name, entry.at("label"), entry.at("unit"), entry.at("signed")}, entry.at("kind"), entry.at("reference"), {}};
    for (const Json& file : entry.at("files")) field.files.push_back({file.at("path"), file.at("sha256")});
    fields.push_back(std::move(field));
  }
  return fields;
}

std::string field_head_text(const FieldDescription& field) {
  Json json = {{"label", field.quantity.label},
               {"unit", field.quantity.unit},
               {"signed", field.quantity.is_signed},
               {"kind", field.what}};
  for (const FieldFile& file : field.files) json["sha256"].push_back(file.sha256);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<Quantity> fields_in_head(const std::vector<std::string>& comments) {
  const std::string word = kFieldInHead;
  std::vector<Quantity> fields;
  for (const std::string& comment : comments) {
    const std::size_t begin = std::min(comment.find_first_not_of(' '), comment.size()),
                      colon = comment.find(": ", begin);
    if (comment.compare(begin, word.size(), word) != 0 || colon == std::string::npos) continue;
    const Json json = Json::parse(comment.substr(colon + 2), nullptr, false);
    if (!json.is_object()) continue;
    fields.push_back({comment.substr(begin + word.size(), colon - begin - word.size()), json.value("label", ""),
                      json.value("unit", ""), json.value("signed", false)});
  }
  return fields;
}

std::vector<Quantity> quantities_of(const std::vector<FieldDescription>& fields) {
  std::vector<Quantity> all;
  for (const FieldDescription& field : fields) all.push_back(field.quantity);
  return all;
}

}  // namespace espdiff
