// check_outputs.cpp: compares files by device and inode, and names by their folders.
#include "io/files/check_outputs.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "io/files/sibling_file.h"
#include "system/permissions.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

/// The folder's real path and the name in it; of a link that points nowhere, that of what it would be.
fs::path place_of(const std::string& path) {
  const fs::path target = followed_links(path);
  std::error_code error;
  const fs::path folder = fs::canonical(target.has_parent_path() ? target.parent_path() : fs::path("."), error);
  return (error ? target.parent_path() : folder) / target.filename();
}

/// Equal for all names of one file. Devices such as /dev/null are written by none of our writers, and read by many.
std::string identity_of(const std::string& path) {
  const std::string identity = file_identity(path);
  return identity.empty() ? place_of(path).string() : "file " + identity;
}

/// Bytes of the UTF-8 character at `at`; 0 if there is none: cut off, longer than it need be, a surrogate, too large.
std::size_t utf8_bytes(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
  };
  const unsigned char first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t n = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
  for (std::size_t i = 1; i < n; ++i) {
    if ((byte(at + i) & 0xc0U) != 0x80) return 0;
  }
  const unsigned char second = byte(at + 1);
  const bool is_wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return is_wrong ? 0 : n;
}

/// @throws InputError that shows other bytes than ASCII as '?'
void require_utf8(const std::string& path) {
  std::size_t at = 0, n = 1;
  while (at < path.size() && (n = utf8_bytes(path, at)) > 0) at += n;
  if (n > 0) return;
  std::string shown = path;
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; }, '?');
  throw InputError("'" + shown + "': this name is not UTF-8, so that no result can name the file; rename it");
}

std::string both_names(const std::string& a, const std::string& b) {
  return a == b ? "'" + a + "'" : "'" + a + "' and '" + b + "', which are one file";
}

}  // namespace

void check_outputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs, bool overwrite) {
  std::for_each(inputs.begin(), inputs.end(), require_utf8);
  std::for_each(outputs.begin(), outputs.end(), require_utf8);
  std::map<std::string, const std::string*> read, written;
  for (const std::string& input : inputs) {
    if (!input.empty()) read.emplace(identity_of(input), &input);
  }
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    const std::string identity = identity_of(output);
    if (const auto input = read.find(identity); input != read.end())
      throw InputError("an output would replace an input: " + both_names(output, *input->second) +
                       "; choose another name for the output");
    if (const auto [other, is_new] = written.emplace(identity, &output); !is_new)
      throw InputError("two outputs would have one name: " + both_names(*other->second, output) +
                       "; choose another for one of them");
  }
  for (const std::string& output : outputs) {
    std::error_code ignored;
    if (!overwrite && !output.empty() && fs::is_regular_file(output, ignored))
      throw InputError(Message(output + " exists; " + switched_on("overwrite") + " replaces it, another name keeps it")
                           .set_next({"", {{"overwrite", "", true}}}));
  }
  remove_leftovers(outputs);
}

}  // namespace espdiff
