// output_prefix.cpp: where the results of a pair go, and how they are found again.
#include "cli/output_prefix.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "base/error.h"
#include "base/text/system_message.h"

namespace espdiff::cli {
namespace {

namespace fs = std::filesystem;

/// Of the files that a result always has.
constexpr const char* kResultEndings[] = {".json", ".vtp", ".residues.csv"};
constexpr const char* kPictureEnding = ".png";

/// A file's name without its folder and its endings: "1ake" of data/1ake.pdb.gz.
std::string stem(const std::string& path) {
  fs::path name = fs::path(path).filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().string();
}

std::string name_of(const StateFile& state) {
  return stem(state.path) + (state.model == 1 ? "" : "-model" + std::to_string(state.model));
}

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// @throws IoError
void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder, "the folder of the results cannot be made: " + system_message(error.value()));
}

}  // namespace

bool has_result(const std::string& prefix) {
  std::error_code ignored;
  return std::any_of(std::begin(kResultEndings), std::end(kResultEndings),
                     [&](const char* ending) { return fs::exists(prefix + ending, ignored); });
}

void refuse_existing(const std::string& prefix, const std::string& picture) {
  std::error_code ignored;
  if (!has_result(prefix) && (picture.empty() || !fs::exists(picture, ignored))) return;
  throw InputError(Message("a result named " + prefix + " exists; " + switched_on("overwrite") +
                           " replaces it, another " + option("output") + " keeps it")
                       .set_next({"", {{"overwrite", "", true}}}));
}

std::string free_prefix(const std::string& prefix) {
  std::string free = prefix;
  for (int n = 2; has_result(free); ++n) free = prefix + '_' + std::to_string(n);
  return free;
}

std::string result_prefix(const std::string& given) {
  for (const std::string ending : kResultEndings) {
    if (ends_with(given, ending)) return given.substr(0, given.size() - ending.size());
  }
  return given;
}

std::string output_prefix(const std::string& given, bool overwrite, const StateFile& source, const StateFile& target) {
  std::error_code ignored;
  const bool is_folder = given.empty() || given.back() == '/' || fs::is_directory(given, ignored);
  if (is_folder) {
    if (!given.empty()) make_folder(given);
    const std::string named = (fs::path(given) / (name_of(source) + '_' + name_of(target))).string();
    return overwrite ? named : free_prefix(named);
  }
  const std::string picture = kPictureEnding;
  return ends_with(given, picture) ? given.substr(0, given.size() - picture.size()) : result_prefix(given);
}

std::string output_file(const std::string& input, const std::string& ending) { return stem(input) + ending; }

std::string surface_of_result(const std::string& given) {
  std::error_code ignored;
  const std::string surface = result_prefix(given) + ".vtp";
  return fs::exists(surface, ignored) ? surface : given;
}

}  // namespace espdiff::cli
