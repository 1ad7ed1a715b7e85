// atomic_file.cpp: write aside, check, rename.
#include "io/files/atomic_file.h"

#include <cerrno>
#include <filesystem>
#include <locale>
#include <utility>

#include "base/error.h"
#include "base/text/system_message.h"
#include "io/files/sibling_file.h"
#include "system/permissions.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), target_(followed_links(path_)) {
  check_target(path_, target_);
  stream_.imbue(std::locale::classic());
  open_unnamed();
  if (!file_) open_named();
}

AtomicFile::~AtomicFile() {
  stream_.close();
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

/// Leaves `file_` closed where the file system or a system without /proc cannot do it.
void AtomicFile::open_unnamed() {
  file_ = OpenFile(folder_of(target_), FileAccess::kUnnamed);
  if (!file_) return;
  file_.lock();
  stream_.open(file_.own_path(), std::ios::binary);
  if (stream_) return;
  stream_.clear();
  file_.close();
}

void AtomicFile::open_named() {
  file_ = make_sibling(target_, temporary_);
  if (!file_) {
    temporary_.clear();
    throw IoError(path_, "cannot write: " + with_remedy(file_.error()));
  }
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
  fs::permissions(temporary_.empty() ? file_.own_path() : temporary_, older.permissions() & fs::perms::all, error);
}

/// A file without a name gets a temporary one, which a rename can turn into the target's.
void AtomicFile::name_temporary() {
  if (!temporary_.empty()) return;
  const int error = name_sibling(file_, target_, temporary_);
  if (error == 0) return;
  temporary_.clear();
  throw IoError(path_, "not written: " + with_remedy(error));
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
    const std::string aside = sibling_name(target_, "old");
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
  file_.close();  // and with it the lock
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

}  // namespace espdiff
