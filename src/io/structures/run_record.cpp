// run_record.cpp: extracts from OUT.json what pictures and other files of a result need.
#include "io/structures/run_record.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/molecule/structure_options.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/structures/structure_file.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The file with the recorded content, if there are two of this name.
RecordedInput found_from(const fs::path& folder, const std::string& path, const std::string& sha256) {
  std::error_code ignored;
  if (path.empty()) return {path, sha256, {}};
  const std::string beside = (folder / path).string();
  if (!fs::exists(beside, ignored)) return {path, sha256, {}};
  const bool is_here = fs::is_regular_file(path, ignored) && sha256_of_file(path) == sha256;
  return {is_here ? path : beside, sha256, {}};
}

void read_inputs(const Json& inputs, const fs::path& folder, RunRecord& record) {
  for (const Json& input : inputs) {
    const std::string role = input.at("role");
    RecordedInput* to = role == "source"       ? &record.source
                        : role == "target"     ? &record.target
                        : role == "source_map" ? &record.source_map
                        : role == "target_map" ? &record.target_map
                                               : nullptr;
    if (to == nullptr) continue;
    if (input.contains("computed")) {
      record.maps_computed = true;
      continue;
    }
    *to = found_from(folder, input.at("path"), input.at("sha256"));
    to->read_with = {input.contains("model") ? integer_of<int>(input.at("model")) : 1, input.value("hetero", true),
                     input.value("water", false)};
  }
}

/// Where it is no JSON; of another JSON there is nothing that a user could do.
std::string detail_of(const Json::exception& error) {
  const auto* parsing = dynamic_cast<const nlohmann::json::parse_error*>(&error);
  return parsing != nullptr ? " (no JSON at byte " + std::to_string(parsing->byte) + ")" : std::string();
}

FormatError no_record(const std::string& path, const std::string& detail) {
  return {path, 0,
          "not a record that `espdiff compare` wrote" + detail +
              "; compare again, or move it away to draw the surface alone"};
}

void read_superposition(const Json& json, RigidTransform& transform) {
  const auto& rotation = json.at("rotation_row_major");
  for (std::size_t i = 0; i < 9; ++i) transform.rotation[i] = rotation.at(i);
  const auto& shift = json.at("translation_A");
  transform.translation = {shift.at(0), shift.at(1), shift.at(2)};
}

void read_parts(const Json& json, std::map<std::string, std::vector<int>>& parts) {
  const auto add = [&](const std::string& name, const Json& part) {
    if (!part.is_object() || !part.contains("residues")) return;
    for (const Json& residue : part.at("residues")) parts[name].push_back(integer_of<int>(residue));
  };
  if (json.contains("region")) add("region", json.at("region"));
  if (!json.contains("fixed_patches")) return;
  for (const auto& [name, part] : json.at("fixed_patches").items()) add("patch " + name, part);
}

/// A state's file without its folder; of VMD's molecules, written as mol 0 "adk.psf" frame 97 sel "protein", also the
/// frame if it is not the first.
std::string name_of_state(const std::string& path) {
  const std::size_t begin = path.find('"'), end = path.find("\" frame ");
  if (path.rfind("mol ", 0) != 0 || begin >= end || end == std::string::npos) return fs::path(path).filename().string();
  const std::string name = fs::path(path.substr(begin + 1, end - begin - 1)).filename().string();
  const long frame = std::strtol(path.c_str() + end + 8, nullptr, 10);
  return frame == 0 ? name : name + " frame " + std::to_string(frame);
}

void read_names(const Json& json, RunRecord& record) {
  for (const Json& input : json.at("inputs")) {
    const std::string role = input.at("role");
    std::string* const name = role.rfind("source", 0) == 0 ? &record.source_name : &record.target_name;
    if (role != "source" && role != "target" && role != "source_file" && role != "target_file") continue;
    // Of a state that is kept beside the result, the file that it was made of.
    if (!name->empty() && role.size() == 6) continue;
    *name = with_model(name_of_state(input.at("path")), input.value("model", std::size_t{1}));
  }
}

}  // namespace

RunRecord read_run_record(const std::string& vtp_path) {
  RunRecord record;
  const fs::path path = fs::path(vtp_path).replace_extension(".json");
  record.path = path.string();
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return record;
  require_regular_file(record.path);
  require_memory_for_json(record.path);
  std::ifstream in(path);
  if (!in) return record;
  try {
    const Json json = Json::parse(in);
    // An ensemble has no two structures.
    if (json.contains("plan") && json.contains("noise_floor")) return record;
    read_inputs(json.at("inputs"), path.parent_path(), record);
    read_superposition(json.at("superposition"), record.source_to_target);
    const Json& options = json.at("options");
    record.temperature_K = options.at("temperature_K");
    record.method = options.at("method");
    if (json.contains("by_offset") && !json.at("by_offset").empty())
      record.offset_A = json.at("by_offset").at(0).at("offset_A");
    if (json.contains("potential") && json.at("potential").is_object())
      record.potential = json.at("potential").at("label");
    record.trustworthy = json.at("certificate").at("trustworthy");
    const Json& certificate = json.at("certificate");
    certificate.at("reasons").get_to(record.reasons);
    if (const auto parts = certificate.find("untrusted_parts"); parts != certificate.end())
      parts->get_to(record.untrusted_parts);
    record.verdict = certificate.value("verdict", record.trustworthy ? "TRUSTWORTHY" : "NOT TRUSTWORTHY");
    read_parts(json, record.parts);
    read_names(json, record);
  } catch (const Json::exception& error) {
    throw no_record(record.path, detail_of(error));
  } catch (const std::out_of_range&) {
    throw no_record(record.path, "");
  }
  record.found = true;
  return record;
}

Molecule read_compared(const RunRecord& record, const RecordedInput& input, bool with_water,
                       const std::string& remedy) {
  if (!record.found) throw InputError(record.path + ": no such file; it names the structures" + remedy);
  if (input.path.empty()) throw InputError(record.path + ": names no file of a structure" + remedy);
  std::error_code ignored;
  if (!fs::exists(input.path, ignored)) throw InputError(input.path + " no longer exists" + remedy);
  const StructureFile file(input.path);
  if (file.sha256() != input.sha256) throw InputError(input.path + " has changed since the comparison" + remedy);
  StructureOptions options = input.read_with;
  if (with_water) options.include_hetero = options.include_water = true;
  return file.read(options);
}

}  // namespace espdiff
