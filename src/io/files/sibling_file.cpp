// sibling_file.cpp: names beside a file, and whose process still lives.
#include "io/files/sibling_file.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "system/this_process.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTemporary = ".tmp";
constexpr const char* kAside = ".old";
constexpr const char* kEarlierVersions = ".new-";

/// A name as sibling_name() makes them.
struct Sibling {
  std::string target, kind;
  int process = 0;
};

std::optional<Sibling> parse_sibling(const std::string& name) {
  for (const std::string kind : {kTemporary, kAside, kEarlierVersions}) {
    const std::size_t at = name.rfind(kind);
    if (at == std::string::npos) continue;
    const std::string numbers = name.substr(at + kind.size());
    const std::size_t dash = numbers.find('-');
    const bool has_two = kind != kEarlierVersions;
    if (numbers.empty() || numbers.find_first_not_of("0123456789-") != std::string::npos ||
        (dash != std::string::npos) != has_two)
      continue;
    return Sibling{name.substr(0, at), kind, static_cast<int>(std::strtol(numbers.c_str(), nullptr, 10))};
  }
  return std::nullopt;
}

/// A process locks its file as long as it lives, also on another machine. Earlier versions did not.
bool is_abandoned(const std::string& path, const Sibling& sibling) {
  const bool lives = is_process(sibling.process);
  if (sibling.kind != kTemporary) return !lives;
  OpenFile file(path, FileAccess::kRead);
  if (!file) return false;
  const LockResult lock = file.lock();
  return lock == LockResult::kLocked || (lock == LockResult::kImpossible && !lives);
}

}  // namespace

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string sibling_name(const std::string& target, const char* suffix) {
  static std::atomic<unsigned> counter{0};
  return target + "." + suffix + std::to_string(process_number()) + "-" + std::to_string(counter++);
}

OpenFile make_sibling(const std::string& target, std::string& name) {
  for (;;) {
    name = sibling_name(target, "tmp");
    OpenFile file(name, FileAccess::kCreateNew);
    if (!file && file.error() == EEXIST) continue;
    if (!file) return file;
    // Who removes leftovers may have taken it for one before it was locked.
    const LockResult lock = file.lock();
    if (lock == LockResult::kImpossible || (lock == LockResult::kLocked && file.is_named(name))) return file;
  }
}

int name_sibling(const OpenFile& file, const std::string& target, std::string& name) {
  for (;;) {
    name = sibling_name(target, "tmp");
    const int error = file.link_as(name);
    if (error != EEXIST) return error;
  }
}

void remove_leftovers(const std::vector<std::string>& targets) {
  std::map<std::string, std::set<std::string>> by_folder;
  for (const std::string& target : targets) {
    if (target.empty()) continue;
    const std::string followed = followed_links(target);
    by_folder[folder_of(followed)].insert(fs::path(followed).filename().string());
  }
  for (const auto& [folder, names] : by_folder) {
    std::error_code error;
    std::vector<std::pair<fs::path, Sibling>> abandoned;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      const std::optional<Sibling> sibling = parse_sibling(at->path().filename().string());
      std::error_code ignored;
      if (!sibling || names.count(sibling->target) == 0 || !fs::is_regular_file(at->symlink_status(ignored))) continue;
      if (is_abandoned(at->path().string(), *sibling)) abandoned.emplace_back(at->path(), *sibling);
    }
    for (const auto& [path, sibling] : abandoned) {
      const fs::path target = fs::path(folder) / sibling.target;
      if (sibling.kind == kAside && !fs::exists(target, error)) {
        fs::rename(path, target, error);
      } else {
        fs::remove(path, error);
      }
    }
  }
}

std::string followed_links(const std::string& path) {
  fs::path current = path;
  std::error_code error;
  for (int depth = 0; depth < 40 && fs::is_symlink(fs::symlink_status(current, error)); ++depth) {
    const fs::path next = fs::read_symlink(current, error);
    if (error) break;
    current = next.is_absolute() ? next : current.parent_path() / next;
  }
  return current.string();
}

}  // namespace espdiff
