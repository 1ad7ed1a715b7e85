// series_head.cpp: a run's description as names and texts.
#include "trajectory/series_head.h"

#include <filesystem>

#include "base/error.h"
#include "base/version.h"
#include "field/field_kinds.h"
#include "frames/frame_range.h"
#include "io/files/sha256.h"
#include "options/settings.h"
#include "prepare/read_earlier_patch.h"
#include "report/sections/field_json.h"

namespace espdiff {
namespace {

/// "NAME, 123 bytes"
std::string described(const std::string& path) {
  std::error_code error;
  const auto n_bytes = std::filesystem::file_size(path, error);
  if (error) throw IoError(path, "its size cannot be read: " + error.message());
  return std::filesystem::path(path).filename().string() + ", " + std::to_string(n_bytes) + " bytes";
}

template <typename Text>
std::string joined(const std::vector<std::string>& paths, Text text) {
  std::string all;
  for (const std::string& path : paths) all += (all.empty() ? "" : "; ") + text(path);
  return all;
}

/// Settings that differ from their defaults. Equal settings give the same text, however they were given.
std::string settings_in_words(const CompareOptions& options) {
  const CompareOptions usual;
  std::string text;
  for (const Setting& setting : settings()) {
    const std::string value = setting.get(options);
    if (value != setting.get(usual)) text += (text.empty() ? "" : " ") + setting.name + " " + value;
  }
  return text;
}

}  // namespace

SeriesHead series_head(const SeriesDescription& run, const CompareOptions& options) {
  refuse_patches_of(options, "a trajectory");
  SeriesHead head = {{"espdiff", kVersion}};
  if (run.files.empty()) {
    head.insert(head.end(), run.molecule.begin(), run.molecule.end());
  } else {
    head.emplace_back("file", joined(run.files, described));
    head.emplace_back("atoms", std::string(run.structure.include_hetero ? "hetero" : "no hetero") +
                                   (run.structure.include_water ? ", water" : ", no water"));
  }
  head.emplace_back("frames", frames_in_words(run.frames));
  if (!run.frames_of.empty()) head.emplace_back("frames-of", described(run.frames_of));
  head.emplace_back("reference", run.reference);
  head.emplace_back("map", run.map.empty() ? "none" : run.map);
  head.emplace_back("reference-map", run.reference_map);
  head.emplace_back("start", run.start == StartFrom::kPrevious ? "previous" : "source");
  head.emplace_back("settings", settings_in_words(options));
  std::vector<std::string> patch_files;
  for (const PatchRequest& patch : options.input.patches) {
    if (const auto earlier = earlier_patch_name(patch.selection))
      patch_files.insert(patch_files.end(), {earlier->path, surface_beside(*earlier)});
  }
  if (!patch_files.empty()) head.emplace_back("patch_sha256", joined(patch_files, sha256_of_file));
  for (const FieldDescription& field : describe(make_fields(options.fields)))
    head.emplace_back(kFieldInHead + field.quantity.name, field_head_text(field));
  if (!run.files.empty()) head.emplace_back("file_sha256", joined(run.files, sha256_of_file));
  if (!run.reference_files.empty()) head.emplace_back("reference_sha256", joined(run.reference_files, sha256_of_file));
  return head;
}

}  // namespace espdiff
