// series_csv.cpp: a trajectory's file: its bytes, its lock, what a broken run leaves, and files of something else.
#include "trajectory/series_csv.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "support/test_data.h"
#include "trajectory/made_series_head.h"

using namespace espdiff_test;
using espdiff::ExistingFile;
using espdiff::SeriesCsv;
using espdiff::SeriesHead;
using espdiff::SeriesRow;

namespace {

constexpr const char* kNothing = "(nothing thrown)";

SeriesRow failed(int frame) { return {frame, "0", "no, \"surface\"\nat all"}; }

std::string write_rows(const std::string& path, int n) {
  SeriesCsv file(path, kSeriesHead, ExistingFile::kReplace);
  for (int frame = 0; frame < n; ++frame) file.add(failed(frame));
  return read_file(path);
}

}  // namespace

TEST_SUITE_BEGIN("trajectory");

TEST_CASE("a file that was cut off anywhere continues to the same bytes") {
  const ScratchFolder folder;
  const std::string whole = write_rows(folder.file("whole.csv"), 3), path = folder.file("part.csv");
  CHECK(whole.rfind("# espdiff: 1\n# frames: all\n# settings:", 0) == 0);
  for (std::size_t n = 1; n <= whole.size(); ++n) {
    folder.write("part.csv", whole.substr(0, n));
    SeriesCsv file(path, kSeriesHead, ExistingFile::kResume);
    for (int frame = static_cast<int>(file.rows().size()); frame < 3; ++frame) file.add(failed(frame));
    CHECK_MESSAGE(read_file(path) == whole, n);
  }
}

TEST_CASE("one run at a time writes a file") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.csv"),
                    refused = path + ": another run is writing this file; wait for its end, or name another output";
  {
    SeriesCsv first(path, kSeriesHead, ExistingFile::kRefuse);
    for (const ExistingFile existing : {ExistingFile::kRefuse, ExistingFile::kResume, ExistingFile::kReplace})
      CHECK(message_of([&] { SeriesCsv(path, kSeriesHead, existing); }) == refused);
    first.add(failed(0));
    for (const ExistingFile existing : {ExistingFile::kResume, ExistingFile::kReplace})
      CHECK(message_of([&] { SeriesCsv(path, kSeriesHead, existing); }) == refused);
    // In another process too.
    const pid_t child = ::fork();
    if (child == 0) {
      const bool is_refused = message_of([&] { SeriesCsv(path, kSeriesHead, ExistingFile::kResume); }) == refused;
      ::_exit(is_refused ? 0 : 1);
    }
    int status = -1;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK(status == 0);
  }
  SeriesCsv second(path, kSeriesHead, ExistingFile::kResume);
  CHECK(second.rows().size() == 1);
}

TEST_CASE("a run without a row leaves nothing, and an older file as it was") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.csv");
  { const SeriesCsv file(path, kSeriesHead, ExistingFile::kRefuse); }
  CHECK(folder.n_files() == 0);
  const std::string older = write_rows(path, 2);
  { const SeriesCsv file(path, kSeriesHead, ExistingFile::kReplace); }
  CHECK(read_file(path) == older);
  SeriesCsv file(path, {{"espdiff", "2"}}, ExistingFile::kReplace);
  file.add(failed(5));
  CHECK(read_file(path).rfind("# espdiff: 2\nframe,", 0) == 0);
  CHECK(file.rows().size() == 1);
}

TEST_CASE("what is known late belongs to the head, and must be the same when resumed") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.csv");
  {
    SeriesCsv file(path, kSeriesHead, ExistingFile::kRefuse);
    file.note("source_sha256", "abc");
    file.note("source_sha256", "abc");
    file.add(failed(0));
  }
  CHECK(read_file(path).find("\n# source_sha256: abc\nframe,") != std::string::npos);
  SeriesCsv file(path, kSeriesHead, ExistingFile::kResume);
  file.note("source_sha256", "abc");
  CHECK(message_of([&] { file.note("source_sha256", "def"); }) ==
        path + ": was made with source_sha256 'abc', not with 'def'; overwrite begins anew");
}

TEST_CASE("a resumed file depends on the same things, no more and no less") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.csv"), end = "; overwrite begins anew";
  SeriesHead with_frames_of = kSeriesHead;
  with_frames_of.emplace_back("frames-of", "pep9.pqr, 1680 bytes");
  const auto refusal = [&](const SeriesHead& head) {
    return message_of([&] { SeriesCsv(path, head, ExistingFile::kResume).require_all_noted(); });
  };
  write_rows(path, 2);
  CHECK(refusal(kSeriesHead) == kNothing);
  CHECK(refusal(with_frames_of) ==
        path + ": was made without frames-of, and this run has 'pep9.pqr, 1680 bytes'" + end);
  {
    SeriesCsv file(path, kSeriesHead, ExistingFile::kResume);
    CHECK(message_of([&] { file.note("target_sha256", "abc"); }) ==
          path + ": was made without target_sha256, and this run has 'abc'" + end);
  }
  {
    SeriesCsv file(path, with_frames_of, ExistingFile::kReplace);
    file.add(failed(0));
    file.note("target_sha256", "abc");  // known after an error of the first frame
  }
  CHECK(refusal(with_frames_of) == kNothing);
  CHECK(refusal(kSeriesHead) ==
        path + ": was made with frames-of 'pep9.pqr, 1680 bytes', which this run has not" + end);
}

TEST_CASE("rows that were changed, exchanged or put under another head are found by their checksums") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.csv"), whole = write_rows(path, 3);
  CHECK(whole.find(",error,checksum\n") != std::string::npos);
  const auto refusal = [&](const std::string& text) {
    folder.write("a.csv", text);
    return message_of([&] { SeriesCsv(path, kSeriesHead, ExistingFile::kResume); });
  };
  CHECK(refusal(whole) == kNothing);
  std::vector<std::size_t> ends = {whole.find("checksum\n") + 9};
  for (int i = 0; i < 3; ++i) ends.push_back(whole.find('\n', ends.back()) + 1);
  const std::string head = whole.substr(0, ends[0]), first = whole.substr(ends[0], ends[1] - ends[0]),
                    second = whole.substr(ends[1], ends[2] - ends[1]), third = whole.substr(ends[2]);
  const std::string words = ": this row, or the head above it, was changed or is damaged: its checksum is ";
  CHECK(refusal(head + "1" + first.substr(1) + second).rfind(path + ":5" + words, 0) == 0);
  CHECK(refusal(head + first + third).rfind(path + ":6" + words, 0) == 0);
  CHECK(refusal(head + second + first).rfind(path + ":5" + words, 0) == 0);
  CHECK(refusal(head + first + second + third) == kNothing);
  // Rows of a run with another setting.
  SeriesHead other = kSeriesHead;
  other[1].second = "0:2";
  SeriesCsv(folder.file("b.csv"), other, ExistingFile::kReplace).add(failed(0));
  const std::string mixed = read_file(folder.file("b.csv"));
  CHECK(refusal(head + mixed.substr(mixed.find("checksum\n") + 9)).rfind(path + ":5" + words, 0) == 0);
}

TEST_CASE("files of something else are refused and left as they are") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.csv"), good = write_rows(path, 1);
  const auto refusal = [&](const SeriesHead& head) {
    return message_of([&] { SeriesCsv(path, head, ExistingFile::kResume); });
  };
  CHECK(message_of([&] { SeriesCsv(path, kSeriesHead, ExistingFile::kRefuse); }) ==
        path + ": the file exists; resume continues it, overwrite replaces it");
  CHECK(refusal({{"settings", "mu 0.5"}}) ==
        path + ": was made with settings '', not with 'mu 0.5'; overwrite begins anew");
  for (const char* other : {"a,b\n1,2\n", "no table", "# a comment\n", "frame,reference_frame,time_ms\n"}) {
    folder.write("a.csv", other);
    CAPTURE(other);
    CHECK_FALSE(refusal(kSeriesHead).empty());
    CHECK(read_file(path) == other);
  }
  folder.write("a.csv", "a,b\n1,2\n");
  CHECK(refusal(kSeriesHead) == path + ":1: this is not this version's line of columns; give another file");
  folder.write("a.csv", good + "2,too,few\n");
  CHECK(refusal(kSeriesHead).find(path + ":6: 3 fields instead of ") == 0);
  CHECK_THROWS_AS(SeriesCsv(folder.file("absent/a.csv"), kSeriesHead, ExistingFile::kRefuse), espdiff::IoError);
}

TEST_SUITE_END();
