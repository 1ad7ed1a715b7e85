// open_file.cpp: reads and writes of made files, locks between two openings, and errors by their number.
#include "system/open_file.h"

#include <doctest/doctest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::ScratchFolder;

namespace {

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("open_file: what is missing, taken or a folder has an error's number") {
  const ScratchFolder folder;
  const std::string there = folder.write("there", "text");
  const OpenFile absent(folder.file("absent"), FileAccess::kRead);
  CHECK_FALSE(absent);
  CHECK(absent.error() == ENOENT);
  CHECK(OpenFile(folder.file("absent"), FileAccess::kAppend).error() == ENOENT);
  CHECK(OpenFile(there, FileAccess::kCreateNew).error() == EEXIST);
  CHECK(OpenFile(there, FileAccess::kFolder).error() == ENOTDIR);
  CHECK(OpenFile(folder.file(""), FileAccess::kReadWrite).error() == EISDIR);
  CHECK(folder.n_files() == 1);
}

TEST_CASE("open_file: reads to the end, at a place, and says where a file is too short") {
  const ScratchFolder folder;
  OpenFile file(folder.write("a", "0123456789"), FileAccess::kRead);
  REQUIRE(file);
  CHECK(file.size() == 10);
  char buffer[16] = {};
  std::size_t n_read = 0;
  CHECK(file.read(buffer, 4, n_read) == 0);
  CHECK(std::string(buffer, n_read) == "0123");
  CHECK(file.read(buffer, sizeof buffer, n_read) == 0);
  CHECK(std::string(buffer, n_read) == "456789");
  CHECK(file.read_at(7, buffer, 3) == 0);
  CHECK(std::string(buffer, 3) == "789");
  CHECK(file.read_at(8, buffer, 3) == OpenFile::kEndsTooEarly);
  CHECK(file.write("x", 1) == EBADF);
}

TEST_CASE("open_file: writes at a place, at the end, and shortens") {
  const ScratchFolder folder;
  const std::string path = folder.write("a", "0123456789");
  OpenFile file(path, FileAccess::kReadWrite);
  CHECK(file.write_at(2, "AB", 2) == 0);
  CHECK(content(path) == "01AB456789");
  CHECK(file.truncate(4) == 0);
  OpenFile more(path, FileAccess::kAppendOrCreate);
  CHECK(more.write("end", 3) == 0);
  CHECK(content(path) == "01ABend");
}

TEST_CASE("open_file: a lock holds until the file is closed, also when it has moved to another variable") {
  const ScratchFolder folder;
  const std::string path = folder.write("a", "text");
  OpenFile first(path, FileAccess::kRead), second(path, FileAccess::kReadWrite);
  CHECK(first.lock() == LockResult::kLocked);
  CHECK(second.lock() == LockResult::kBusy);
  OpenFile moved(std::move(first));
  CHECK(second.lock() == LockResult::kBusy);
  moved = OpenFile();
  CHECK(second.lock() == LockResult::kLocked);
}

TEST_CASE("open_file: a name that another file took is no longer this one's") {
  const ScratchFolder folder;
  const std::string path = folder.write("a", "text");
  const OpenFile file(path, FileAccess::kRead);
  CHECK(file.is_named(path));
  std::filesystem::rename(folder.write("b", "other"), path);
  CHECK_FALSE(file.is_named(path));
  std::filesystem::remove(path);
  CHECK_FALSE(file.is_named(path));
}

TEST_CASE("open_file: a file without a name leaves nothing, or gets one") {
  const ScratchFolder folder;
  {
    OpenFile file(folder.file(""), FileAccess::kUnnamed);
    if (!file) {
      MESSAGE("SKIPPED: this file system has no files without a name");
      return;
    }
    CHECK(file.write("text", 4) == 0);
    CHECK(folder.n_files() == 0);
    CHECK(content(file.own_path()) == "text");
    CHECK(file.link_as(folder.file("a")) == 0);
    CHECK(file.link_as(folder.file("a")) == EEXIST);
  }
  CHECK(content(folder.file("a")) == "text");
  { const OpenFile file(folder.file(""), FileAccess::kUnnamed); }
  CHECK(folder.n_files() == 1);
}

TEST_CASE("open_file: a file in memory is read from its start") {
  OpenFile file = OpenFile::in_memory();
  REQUIRE(file);
  CHECK(file.write("input", 5) == 0);
  file.rewind();
  char buffer[8] = {};
  std::size_t n_read = 0;
  CHECK(file.read(buffer, sizeof buffer, n_read) == 0);
  CHECK(std::string(buffer, n_read) == "input");
}
