// atomic_file.cpp: files appear complete or not at all, and refusals say why and what to do.
#include "io/files/atomic_file.h"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <climits>
#include <csignal>

#include "base/error.h"
#include "io/files/sibling_file.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::read_file;
using espdiff_test::ScratchFolder;

namespace {

/// While it lives, a file cannot grow beyond a limit: the same path through the code as a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t n_bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = n_bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

}  // namespace

TEST_CASE("a file appears when it is committed, whole") {
  const ScratchFolder folder;
  const std::string path = folder.file("out.txt");
  {
    AtomicFile file(path);
    file.stream() << "hello " << 1.5;
    CHECK_FALSE(std::filesystem::exists(path));
    CHECK(folder.n_files() <= 1);  // the temporary, in the same folder, where it has a name
    file.commit();
  }
  CHECK(read_file(path) == "hello 1.5");
  CHECK(folder.n_files() == 1);
}

TEST_CASE("without commit, as after an exception, nothing is left and an older file stays") {
  const ScratchFolder folder;
  const std::string path = folder.write("out.txt", "old");
  try {
    AtomicFile file(path);
    file.stream() << "new";
    throw Cancelled();
  } catch (const Cancelled&) {
  }
  CHECK(read_file(path) == "old");
  CHECK(folder.n_files() == 1);
}

TEST_CASE("committing replaces an older file and leaves no copy of it") {
  const ScratchFolder folder;
  const std::string path = folder.write("out.txt", "old");
  AtomicFile file(path);
  file.stream() << "new";
  file.commit();
  CHECK(read_file(path) == "new");
  CHECK(folder.n_files() == 1);
}

TEST_CASE("a new file gets the permissions of any new file") {
  const ScratchFolder folder;
  const mode_t before = umask(027);
  AtomicFile file(folder.file("out.txt"));
  umask(before);
  file.commit();
  struct stat status {};
  REQUIRE(stat(folder.file("out.txt").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
}

TEST_CASE("a file that is replaced keeps its permissions") {
  const ScratchFolder folder;
  const std::string path = folder.write("out.txt", "old");
  REQUIRE(chmod(path.c_str(), 0600) == 0);
  AtomicFile file(path);
  file.stream() << "new";
  file.commit();
  struct stat status {};
  REQUIRE(stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0600);
}

TEST_CASE("what killed processes left beside a file is removed, and nothing else") {
  const ScratchFolder folder;
  const std::string path = folder.write("out.csv", "x"), dead = std::to_string(INT_MAX);
  for (const std::string& left :
       {"out.csv.tmp" + dead + "-0", "out.csv.old" + dead + "-1", "out.h5.new-" + dead, "out.h5.old" + dead + "-0"})
    folder.write(left, "x");
  folder.write("out.csv.tmp1-0", "x");  // of a process that lives, but has not locked it
  for (const char* other : {"out.csv.tmp", "out.csv.tmpx", "out.csv.old1-2", "out.h5.new-1", "another.csv.tmp1-1"})
    folder.write(other, "");
  std::filesystem::create_symlink("another.csv.tmp1-1", folder.file("out.csv.tmp7-7"));
  AtomicFile other_run(path);
  remove_leftovers({path, folder.file("out.h5"), ""});
  CHECK(folder.n_files() == 8);  // an older result has come back as out.h5
  CHECK(read_file(folder.file("out.h5")) == "x");
  CHECK_FALSE(std::filesystem::exists(folder.file("out.csv.tmp1-0")));
  other_run.stream() << "y";
  other_run.commit();
  CHECK(read_file(path) == "y");
}

TEST_CASE("a temporary file with a name is kept from those who remove leftovers, and not made through a link") {
  const ScratchFolder folder;
  const std::string path = folder.file("out.csv"), victim = folder.write("victim", "x");
  std::string name;
  const OpenFile file = make_sibling(path, name);
  REQUIRE(file);
  remove_leftovers({path});
  CHECK(std::filesystem::exists(name));
  // The next name is taken by a link.
  const std::size_t dash = name.rfind('-');
  const std::string next = name.substr(0, dash + 1) + std::to_string(std::stoul(name.substr(dash + 1)) + 1);
  std::filesystem::create_symlink("victim", next);
  std::string other;
  CHECK(make_sibling(path, other));
  CHECK(other != next);
  CHECK(read_file(victim) == "x");
}

TEST_CASE("a symbolic link is followed, not replaced") {
  const ScratchFolder folder;
  const std::string target = folder.write("target.txt", "old"), link = folder.file("link.txt");
  std::filesystem::create_symlink("target.txt", link);
  AtomicFile file(link);
  file.stream() << "new";
  file.commit();
  CHECK(std::filesystem::is_symlink(link));
  CHECK(read_file(target) == "new");
}

TEST_CASE("what cannot be written is refused at once, with reason and remedy") {
  const ScratchFolder folder;
  CHECK(message_of([&] { AtomicFile file(folder.file("no/such/out.txt")); }) ==
        folder.file("no/such/out.txt") + ": cannot write: the folder " + folder.file("no/such") +
            " does not exist; create it first");
  CHECK(message_of([&] { AtomicFile file(folder.file("")); }).find("this is a folder; name a file in it") !=
        std::string::npos);
  CHECK(message_of([] { AtomicFile file(""); }).find("name the output") != std::string::npos);
  CHECK(message_of([] { AtomicFile file("/dev/null"); }).find("/dev/null: cannot write: this is not a regular file") ==
        0);
  const std::string plain = folder.write("plain", "");
  CHECK(message_of([&] { AtomicFile file(plain + "/out.txt"); }).find(plain + " is not a folder") != std::string::npos);
  const std::string long_name = folder.file(std::string(300, 'x'));
  CHECK(message_of([&] { AtomicFile file(long_name); }).find("choose a shorter name") != std::string::npos);
  CHECK_THROWS_AS(AtomicFile(folder.file("no/such/out.txt")), IoError);
  CHECK(folder.n_files() == 1);
}

TEST_CASE("permissions are respected, though a rename could get around them") {
  if (geteuid() == 0) {
    MESSAGE("SKIPPED: the superuser may write anywhere");
    return;
  }
  const ScratchFolder folder;
  const std::string path = folder.write("out.txt", "old");
  std::filesystem::permissions(path, std::filesystem::perms::owner_read);
  CHECK(message_of([&] { AtomicFile file(path); }).find("the file exists and is read-only") != std::string::npos);
  std::filesystem::create_directory(folder.file("locked"));
  std::filesystem::permissions(folder.file("locked"), std::filesystem::perms::owner_exec);
  CHECK(message_of([&] {
          AtomicFile file(folder.file("locked/out.txt"));
        }).find("Permission denied; write to a folder") != std::string::npos);
  std::filesystem::permissions(folder.file("locked"), std::filesystem::perms::owner_all);
}

TEST_CASE("a disk that fills up is an error, and the older file stays") {
  const ScratchFolder folder;
  const std::string path = folder.write("out.txt", "old");
  const std::string content(100000, 'x');
  std::string message;
  {
    const FileSizeLimit limit(4096);
    AtomicFile file(path);
    for (int i = 0; i < 10; ++i) file.stream() << content;
    message = message_of([&] { file.commit(); });
  }
  CHECK(message.find(path + ": not written: ") == 0);
  CHECK(read_file(path) == "old");
  CHECK(folder.n_files() == 1);
}

TEST_CASE("files committed together appear together") {
  const ScratchFolder folder;
  AtomicFile a(folder.file("a")), b(folder.file("b"));
  a.stream() << "A";
  b.stream() << "B";
  commit_all({&a, &b});
  CHECK(read_file(folder.file("a")) == "A");
  CHECK(read_file(folder.file("b")) == "B");
  CHECK(folder.n_files() == 2);
}

TEST_CASE("when one of several names is taken meanwhile, all files stay as they were") {
  const ScratchFolder folder;
  const std::string old = folder.write("old", "old");
  {
    AtomicFile a(old), b(folder.file("fresh")), c(folder.file("taken"));
    a.stream() << "A";
    b.stream() << "B";
    std::filesystem::create_directory(folder.file("taken"));
    CHECK(message_of([&] {
            commit_all({&a, &b, &c});
          }).find("not written: this has become a folder") != std::string::npos);
  }
  CHECK(read_file(old) == "old");
  CHECK_FALSE(std::filesystem::exists(folder.file("fresh")));
  CHECK(folder.n_files() == 2);  // the old file and the folder
}

TEST_CASE("when one of several files cannot be finished, none appears") {
  const ScratchFolder folder;
  std::string message;
  {
    const FileSizeLimit limit(4096);
    AtomicFile small(folder.file("small")), large(folder.file("large"));
    small.stream() << "fits";
    large.stream() << std::string(100000, 'x');
    message = message_of([&] { commit_all({&small, &large}); });
  }
  CHECK(message.find("large: not written") != std::string::npos);
  CHECK(folder.n_files() == 0);
}
