// atomic_file.cpp: write aside, check, rename.
#include "io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <locale>
#include <utility>

#include "base/error.h"
#include "base/system_message.h"
#include "system/permissions.h"
#include "system/this_process.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// Says for the errors that users meet what they can do about them.
std::string with_remedy(int error_number) {
  const std::string reason = system_message(error_number);
  switch (error_number) {
    case EACCES:
    case EPERM: return reason + "; write to a folder that you may write to, or change its permissions";
    case EROFS: return reason + "; write to another folder";
    case ENOSPC:
#if defined(EDQUOT)  // not on Windows
    case EDQUOT:
#endif
    case EFBIG: return reason + "; free some space or write to another folder";
    case ENAMETOOLONG: return reason + "; choose a shorter name";
    default: return reason;
  }
}

/// Refuses what no rename can replace, before any work is done.
void check_target(const std::string& path, const std::string& target) {
  if (path.empty()) throw IoError("(empty name)", "cannot write to a file without a name; name the output");
  constexpr std::size_t kLongestName = 255 - 30;  // less what a temporary name has besides
  if (fs::path(target).filename().string().size() > kLongestName)
    throw IoError(path, "cannot write: " + with_remedy(ENAMETOOLONG));
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) throw IoError(path, "cannot write: this is a folder; name a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw IoError(path, "cannot write: this is not a regular file; choose another name");
  }
  const std::string folder = folder_of(target);
  const fs::file_status folder_status = fs::status(folder, error);
  if (!fs::exists(folder_status))
    throw IoError(path, "cannot write: the folder " + folder + " does not exist; create it first");
  if (!fs::is_directory(folder_status))
    throw IoError(path, "cannot write: " + folder + " is not a folder; choose another name");
  if (fs::exists(status) && !may_write(target)) {
    throw IoError(path, "cannot write: the file exists and is read-only; remove it or choose another name");
  }
}

/// A name beside `target` that no other process or thread uses.
std::string sibling(const std::string& target, const char* suffix) {
  static std::atomic<unsigned> counter{0};
  return target + "." + suffix + std::to_string(process_number()) + "-" + std::to_string(counter++);
}

/// Creates the temporary file, with the permissions that any new file gets.
std::string create_sibling(const std::string& path, const std::string& target) {
  for (;;) {
    const std::string name = sibling(target, "tmp");
    const OpenFile file(name, FileAccess::kCreateNew);
    if (file) return name;
    if (file.error() != EEXIST) throw IoError(path, "cannot write: " + with_remedy(file.error()));
  }
}

}  // namespace

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

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(followed_links(path_)) {
  check_target(path_, target_);
  stream_.imbue(std::locale::classic());
  open_unnamed();
  if (!unnamed_) open_named();
}

AtomicFile::~AtomicFile() {
  stream_.close();
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

/// Leaves `unnamed_` closed where the file system or a system without /proc cannot do it.
void AtomicFile::open_unnamed() {
  unnamed_ = OpenFile(folder_of(target_), FileAccess::kUnnamed);
  if (!unnamed_) return;
  stream_.open(unnamed_.own_path(), std::ios::binary);
  if (stream_) return;
  stream_.clear();
  unnamed_.close();
}

void AtomicFile::open_named() {
  temporary_ = create_sibling(path_, target_);
  errno = 0;
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (stream_) return;
  const int error_number = errno;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  throw IoError(path_, "cannot write: " + with_remedy(error_number));
}

/// The permissions of an older file.
void AtomicFile::keep_mode() const {
  std::error_code error;
  const fs::file_status older = fs::status(target_, error);
  if (!fs::exists(older)) return;
  fs::permissions(unnamed_ ? unnamed_.own_path() : temporary_, older.permissions() & fs::perms::all, error);
}

/// A file without a name gets a temporary one, which a rename can turn into the target's.
void AtomicFile::name_temporary() {
  if (!unnamed_) return;
  for (;;) {
    const std::string name = sibling(target_, "tmp");
    const int error = unnamed_.link_as(name);
    if (error == EEXIST) continue;
    if (error != 0) throw IoError(path_, "not written: " + with_remedy(error));
    temporary_ = name;
    unnamed_.close();
    return;
  }
}

/// Brings everything to the file system; a write that failed earlier shows here at the latest.
void AtomicFile::finish() {
  errno = 0;
  const bool written = static_cast<bool>(stream_.flush());
  const int flush_error = errno;
  stream_.close();
  if (written && stream_) return;
  const int error_number = written ? errno : flush_error;
  throw IoError(path_,
                "not written: " + (error_number != 0 ? with_remedy(error_number)
                                                     : std::string("a write failed; see that the disk is not full")));
}

void AtomicFile::rename_to_target() {
  std::error_code error;
  if (fs::is_directory(target_, error))
    throw IoError(path_, "not written: this has become a folder; choose another name");
  keep_mode();
  name_temporary();
  if (fs::exists(target_, error)) {
    // A second link keeps the older file; where the file system has no links, it steps aside.
    const std::string aside = sibling(target_, "old");
    fs::create_hard_link(target_, aside, error);
    if (error) fs::rename(target_, aside, error);
    if (!error) previous_ = aside;
  }
  fs::rename(temporary_, target_, error);
  if (error) {
    restore_target();
    throw IoError(path_, "not written: " + with_remedy(error.value()));
  }
  temporary_.clear();
  renamed_ = true;
}

/// Undoes rename_to_target(): the older file comes back, or nothing has this name.
void AtomicFile::restore_target() {
  std::error_code error;
  if (!previous_.empty()) {
    fs::rename(previous_, target_, error);
    if (error) return;             // keep the copy rather than lose it
    fs::remove(previous_, error);  // still there when both names were links to one file
    previous_.clear();
  } else if (renamed_) {
    fs::remove(target_, error);
  }
  renamed_ = false;
}

void AtomicFile::forget_previous() {
  std::error_code ignored;
  if (!previous_.empty()) fs::remove(previous_, ignored);
  previous_.clear();
}

void AtomicFile::commit() { commit_all({this}); }

void commit_all(const std::vector<AtomicFile*>& files) {
  for (AtomicFile* file : files) file->finish();
  try {
    for (AtomicFile* file : files) file->rename_to_target();
  } catch (...) {
    for (AtomicFile* file : files) file->restore_target();
    throw;
  }
  for (AtomicFile* file : files) file->forget_previous();
}

void remove_leftovers(const std::string& path) {
  const fs::path target = followed_links(path);
  const std::string start = target.filename().string() + ".tmp";
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator at(folder_of(target.string()), error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    // sibling() adds a process and a number: digits, a dash, digits.
    const bool is_ours = name.size() > start.size() && name.compare(0, start.size(), start) == 0 &&
                         name.find_first_not_of("0123456789-", start.size()) == std::string::npos;
    if (is_ours) leftovers.push_back(at->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove(leftover, error);
}

}  // namespace espdiff
