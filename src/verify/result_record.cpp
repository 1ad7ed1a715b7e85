// result_record.cpp: checked access to OUT.json.
#include "verify/result_record.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/formats.h"
#include "io/files/read_input.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}
bool flag_of(const Json& object, const char* key, bool fallback) {
  const auto found = object.find(key);
  return found != object.end() && found->is_boolean() ? found->get<bool>() : fallback;
}

}  // namespace

ResultRecord::ResultRecord(const std::string& prefix) : path_(prefix + ".json") {
  std::error_code ignored;
  if (!std::filesystem::exists(path_, ignored))
    throw IoError(path_, "cannot be read; give the prefix of a result: OUT of OUT.json and OUT.vtp");
  require_regular_file(path_);
  require_memory_for_json(path_);
  std::ifstream in(path_);
  if (!in) throw IoError(path_, "cannot be read; check its permissions");
  Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded()) throw InputError(path_ + ": is not JSON, or is cut off; compare again");
  const std::string format = json.is_object() && json.contains("format") && json["format"].is_string()
                                 ? json["format"].get<std::string>()
                                 : "";
  if (format == kEnsembleFormat)
    throw InputError(path_ + ": is the record of an ensemble, and `verify` recomputes comparisons of two states. " +
                     "`ensemble` with " + option("from", "OUT.h5") +
                     " checks the sum of each frame and makes the statistics again; compare two frames to verify a "
                     "mapping");
  if (format == kMatrixFormat)
    throw InputError(path_ +
                     ": is the record of a matrix, and `verify` recomputes comparisons of two states; compare " +
                     "two of its variants, whose numbers are those of its cell, and verify that");
  if (!json.is_object() || !json.contains("certificate") || !json["certificate"].is_object() ||
      !json.contains("inputs") || !json["inputs"].is_array())
    throw InputError(path_ + ": is not the record of a comparison: it has no certificate, or no inputs; compare again");
  json_ = std::make_shared<const Json>(std::move(json));
}

const Json* ResultRecord::at(const std::string& pointer) const {
  const Json::json_pointer place("/" + pointer);
  return json_->contains(place) ? &json_->at(place) : nullptr;
}

std::optional<double> ResultRecord::number(const std::string& pointer) const {
  const Json* const found = at(pointer);
  if (found == nullptr || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

double ResultRecord::number_between(const std::string& pointer, double least, double most, double fallback) const {
  const double value = number(pointer).value_or(fallback);
  if (value >= least && value <= most) return value;
  throw InputError(path_ + ": " + pointer +
                   formatted(" is %g, and %g to %g was expected; compare again", value, least, most));
}

bool ResultRecord::flag(const std::string& pointer) const {
  const Json* const found = at(pointer);
  return found != nullptr && found->is_boolean() && found->get<bool>();
}

std::string ResultRecord::text(const std::string& pointer) const {
  const Json* const found = at(pointer);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

std::vector<std::vector<std::size_t>> ResultRecord::triples(const std::string& pointer) const {
  const Json* const found = at(pointer);
  std::vector<std::vector<std::size_t>> all;
  if (found == nullptr) return all;
  const InputError damaged(path_ + ": " + pointer + " has an entry that is not three whole numbers; compare again");
  if (!found->is_array()) throw damaged;
  for (const Json& entry : *found) {
    if (!entry.is_array() || entry.size() != 3) throw damaged;
    for (const Json& value : entry) {
      if (!value.is_number_unsigned()) throw damaged;
    }
    all.push_back(entry.get<std::vector<std::size_t>>());
  }
  return all;
}

double ResultRecord::sum(const std::string& pointer) const {
  const Json* const found = at(pointer);
  if (found == nullptr || !found->is_object()) return std::numeric_limits<double>::quiet_NaN();
  double all = 0;
  for (const Json& value : *found) all += value.is_number() ? value.get<double>() : 0;
  return all;
}

std::vector<double> ResultRecord::numbers(const std::string& pointer) const {
  const Json* const found = at(pointer);
  std::vector<double> all;
  if (found == nullptr || !found->is_array()) return all;
  for (const Json& value : *found) {
    if (!value.is_number()) return {};
    all.push_back(value.get<double>());
  }
  return all;
}

std::size_t ResultRecord::size(const std::string& pointer) const {
  const Json* const found = at(pointer);
  return found != nullptr && found->is_structured() ? found->size() : 0;
}

std::vector<std::string> ResultRecord::leaves() const {
  std::vector<std::string> all;
  const Json flat = json_->flatten();
  for (const auto& entry : flat.items()) all.push_back(entry.key().substr(1));
  return all;
}

std::string ResultRecord::place_of_input(const std::string& role) const {
  const Json& inputs = json_->at("inputs");
  std::size_t k = 0;
  while (k < inputs.size() && !(inputs[k].is_object() && text_of(inputs[k], "role") == role)) ++k;
  return "inputs/" + std::to_string(k);
}

std::optional<VerifiedInput> ResultRecord::input(const std::string& role) const {
  for (const Json& entry : json_->at("inputs")) {
    if (!entry.is_object() || text_of(entry, "role") != role) continue;
    VerifiedInput input;
    const std::filesystem::path recorded = text_of(entry, "path");
    if (recorded.empty()) return std::nullopt;
    const std::filesystem::path beside = std::filesystem::path(path_).parent_path() / recorded.filename();
    std::error_code ignored;
    input.path = (std::filesystem::exists(recorded, ignored) ? recorded : beside).string();
    input.sha256 = text_of(entry, "sha256");
    const auto model = entry.find("model");
    if (model != entry.end() && model->is_number_integer()) input.model = model->get<int>();
    input.hetero = flag_of(entry, "hetero", true);
    input.water = flag_of(entry, "water", false);
    input.computed = entry.contains("computed");
    return input;
  }
  return std::nullopt;
}

}  // namespace espdiff
