// ensemble_file.cpp: the file that grows: resuming, damage, merging, and what is refused.
#include "ensemble/file/ensemble_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "ensemble/ensemble_run.h"
#include "ensemble/planted_file.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

constexpr std::size_t kFrames = 30;

std::vector<float> values_of(const EnsembleFile& file, std::size_t frame) {
  std::vector<float> values(file.n_vertices());
  file.read_all_values(frame, 0, values.size(), values.data());
  return values;
}

/// Two of three vertices.
std::vector<std::uint8_t> planted_trust(std::size_t frame, std::size_t n) {
  std::vector<std::uint8_t> trusted(n);
  for (std::size_t v = 0; v < n; ++v) trusted[v] = (v + frame) % 3 != 0 ? 1 : 0;
  return trusted;
}

/// The values of a frame.
std::vector<float> planted(std::size_t frame, std::size_t n) {
  std::vector<float> values(n);
  for (std::size_t v = 0; v < n; ++v) values[v] = static_cast<float>(frame) + 0.001F * static_cast<float>(v);
  return values;
}

void fill(EnsembleFile& file, std::size_t begin, std::size_t end) {
  for (std::size_t f = begin; f < end; ++f)
    file.write(f, planted(f, file.n_vertices()), {1, 0.5, 0, 0, 1, 0.25, true, f == 3 ? "a note" : ""},
               planted_trust(f, file.n_vertices()));
}

std::string damaged(std::string bytes, std::size_t at) {
  bytes[at] = static_cast<char>(bytes[at] ^ 0x40);
  return bytes;
}

/// Where the values of a frame begin in the file's bytes.
std::size_t place_of(const std::string& bytes, std::size_t frame, std::size_t n_vertices) {
  const std::vector<float> values = planted(frame, n_vertices);
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(values.data()), 64));
  REQUIRE(at != std::string::npos);
  return at;
}

}  // namespace

TEST_SUITE_BEGIN("ensemble file");

TEST_CASE("what is written is read, before and after the file is closed") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  const EnsemblePlan plan = planted_plan(3, 2, 5);
  EnsembleFile::create(path, plan, planted_template(2));
  {
    EnsembleFile file(path, true);
    CHECK(file.n_done() == 0);
    fill(file, 0, 4);
    CHECK(values_of(file, 2) == planted(2, file.n_vertices()));
  }
  const EnsembleFile file(path, false);
  CHECK(file.n_done() == 4);
  CHECK(file.n_damaged() == 0);
  CHECK(values_of(file, 3) == planted(3, file.n_vertices()));
  std::vector<float> trusted(10);
  file.read_values(3, 5, 15, trusted.data());
  for (std::size_t v = 5; v < 15; ++v) {
    if (planted_trust(3, file.n_vertices())[v] != 0) CHECK(trusted[v - 5] == planted(3, file.n_vertices())[v]);
    if (planted_trust(3, file.n_vertices())[v] == 0) CHECK(std::isnan(trusted[v - 5]));
  }
  CHECK(file.numbers(3).note == "a note");
  CHECK(file.numbers(3).rmsd_A == 1);
  CHECK(file.numbers(3).trustworthy);
  CHECK(plan_difference(file.plan(), plan).empty());
  const TemplateSurface surface = planted_template(2);
  CHECK(file.surface().triangles == surface.triangles);
  CHECK(file.surface().positions.back().x == surface.positions.back().x);
  CHECK(file.surface().residue == surface.residue);
}

TEST_CASE("the bytes depend neither on the order of frames nor on interruptions") {
  const ScratchFolder folder;
  const EnsemblePlan plan = planted_plan(3, 3, 5);
  for (const char* name : {"a.h5", "b.h5"}) EnsembleFile::create(folder.file(name), plan, planted_template(2));
  {
    EnsembleFile file(folder.file("a.h5"), true);
    fill(file, 0, kFrames);
  }
  for (std::size_t f = kFrames; f > 0; --f) {
    EnsembleFile file(folder.file("b.h5"), true);
    fill(file, f - 1, f);
  }
  CHECK(read_file(folder.file("a.h5")) == read_file(folder.file("b.h5")));
}

TEST_CASE("shards merge to the bytes of one process") {
  const ScratchFolder folder;
  const EnsemblePlan plan = planted_plan(3, 3, 5);
  std::vector<std::string> parts;
  EnsembleFile::create(folder.file("one.h5"), plan, planted_template(2));
  EnsembleFile one(folder.file("one.h5"), true);
  fill(one, 0, kFrames);
  for (std::size_t k = 0; k < 4; ++k) {
    parts.push_back(folder.file("part" + std::to_string(k)));
    EnsembleFile::create(parts.back(), plan, planted_template(2));
    EnsembleFile part(parts.back(), true);
    fill(part, k * kFrames / 4, (k + 1) * kFrames / 4);
  }
  EnsembleRun run;
  run.output = folder.file("all");
  CHECK(merge_ensemble(parts, run).n_frames == kFrames);
  CHECK(read_file(folder.file("all.h5")) == read_file(folder.file("one.h5")));
  CHECK(message_of([&] { merge_ensemble(parts, run); }) ==
        "the ensemble file " + run.output + ".h5 exists; overwrite replaces it");
  run.overwrite = true;
  parts.erase(parts.begin() + 1);
  CHECK(message_of([&] { merge_ensemble(parts, run); }) ==
        "none of the files has frame 7 (wild, replicate 2, frame 2); resume the shard that lacks it, or name its file "
        "too");
  EnsemblePlan other = plan;
  other.settings.back().second = "2";
  EnsembleFile::create(parts.back(), other, planted_template(2));
  CHECK(message_of([&] { merge_ensemble(parts, run); }) == parts.back() + ": this is a part of another ensemble than " +
                                                               parts.front() +
                                                               ": the setting grid-spacing is 2 there and 1 here");
}

TEST_CASE("a damaged or missing end costs the frames there, and no others") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(3, 3, 5), planted_template(2));
  std::size_t n_vertices = 0;
  {
    EnsembleFile file(path, true);
    n_vertices = file.n_vertices();
    fill(file, 0, kFrames);
  }
  const std::string whole = read_file(path);

  folder.write("a.h5", damaged(whole, place_of(whole, 12, n_vertices) + 40));
  {
    const EnsembleFile file(path, false);
    CHECK_FALSE(file.has(12));
    CHECK(file.n_damaged() == 1);
    CHECK(file.n_done() == kFrames - 1);
  }

  folder.write("a.h5", whole.substr(0, place_of(whole, 20, n_vertices) + 100));
  CHECK(message_of([&] { EnsembleFile(path, false); }) ==
        path + ": lost its end; resume computes again what is missing");
  EnsembleFile file(path, true);
  CHECK(file.n_done() == 20);
  CHECK(file.n_damaged() == 10);
  fill(file, 20, kFrames);
  CHECK(read_file(path) == whole);
}

TEST_CASE("other files and damage beyond the frames are refused") {
  const ScratchFolder folder;
  const std::string path = folder.write("text.h5", "not a file of numbers, but of words, which are longer than a head");
  CHECK(message_of([&] { EnsembleFile(path, false); }) ==
        path + ": not the OUT.h5 of an ensemble: no HDF5 file; begin anew with another output, or with overwrite");
  CHECK(message_of([&] { EnsembleFile(folder.file("none.h5"), false); }).find("none.h5: cannot be opened: ") !=
        std::string::npos);
  EnsembleFile::create(path, planted_plan(3, 3, 5), planted_template(2));
  const std::string whole = read_file(path);
  const std::vector<Vec3d> points = planted_template(2).positions;
  const std::size_t at = whole.find(std::string(reinterpret_cast<const char*>(points.data()), 200));
  REQUIRE(at != std::string::npos);
  folder.write("text.h5", damaged(whole, at + 70));
  CHECK(message_of([&] { EnsembleFile(path, true); }) ==
        path +
            ": the template or the description of the run in this file is damaged; begin anew with another output, or "
            "with overwrite");
}

TEST_CASE("every byte besides the frames is under a checksum; files of versions before are read without it") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1));
  std::size_t n_vertices = 0;
  {
    EnsembleFile file(path, true);
    n_vertices = file.n_vertices();
    fill(file, 0, 20);
  }
  const std::string whole = read_file(path), first_words = ": something besides the frames was changed in this file";
  const auto refusal = [&](const std::string& bytes) {
    folder.write("a.h5", bytes);
    return message_of([&] { EnsembleFile(path, false); });
  };
  // The unit, the type of the data set, the steps' times: nothing that we read.
  for (const std::string& text : {std::string("PolyData"), std::string("kT/e"), std::string("rmsd_A unmatched")}) {
    const std::size_t at = whole.find(text);
    REQUIRE(at != std::string::npos);
    CHECK(refusal(damaged(whole, at)).rfind(path + first_words, 0) == 0);
  }
  const double time = 13;
  const std::size_t at = whole.find(std::string(reinterpret_cast<const char*>(&time), sizeof time));
  REQUIRE(at != std::string::npos);
  CHECK(refusal(damaged(whole, at)).rfind(path + first_words, 0) == 0);
  CHECK(refusal(whole) == "(nothing thrown)");
  CHECK(refusal(damaged(whole, place_of(whole, 3, n_vertices))) == "(nothing thrown)");  // of one frame
}

TEST_CASE("potentials that cannot be are refused, when they are written and when they are read") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1));
  EnsembleFile file(path, true);
  std::vector<float> values(file.n_vertices(), 1);
  const std::string end = ", and potentials are within 1e+09; its map or charges cannot be right";
  CHECK(message_of([&] {
          file.write(2, values, {1, 0.5, 0, 0, 1, 1e300, true, ""});
        }) == path + ": frame 2 has a value of 1e+300" + end);
  values[5] = -std::numeric_limits<float>::infinity();
  CHECK(message_of([&] { file.write(2, values, {}); }) == path + ": frame 2 has a value of -inf" + end);
  values[5] = std::numeric_limits<float>::quiet_NaN();
  CHECK_NOTHROW(file.write(2, values, {}));
}

TEST_CASE("a file is not made through a link, and what killed runs left does not stay") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5"), victim = folder.write("victim", "secret");
  for (int i = 0; i < 3; ++i)
    std::filesystem::create_symlink("victim",
                                    folder.file("a.h5.tmp" + std::to_string(::getpid()) + "-" + std::to_string(i)));
  EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1));
  CHECK(read_file(victim) == "secret");
  CHECK(EnsembleFile(path, false).n_done() == 0);
}

TEST_CASE("a merge that fails leaves the earlier file as it was") {
  const ScratchFolder folder;
  const std::string path = folder.write("a.h5", "an earlier result");
  CHECK(message_of([&] {
          EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1), [](EnsembleFile& file) {
            fill(file, 0, 4);
            throw InputError("in the midst");
          });
        }) == "in the midst");
  CHECK(read_file(path) == "an earlier result");
  CHECK(folder.n_files() == 1);
}

TEST_CASE("sizes, addresses and counts that lie, wherever in the file's structure, are refused or do no harm") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1));
  {
    EnsembleFile file(path, true);
    fill(file, 0, 4);
  }
  const std::string whole = read_file(path);
  std::fstream bytes(path, std::ios::binary | std::ios::in | std::ios::out);
  const auto patch = [&](std::size_t at, const std::string& text) {
    bytes.seekp(static_cast<std::streamoff>(at));
    bytes << text << std::flush;
  };
  int n_refused = 0;
  // HDF5's structure is in the first kilobytes; its numbers have 2, 4 or 8 bytes.
  for (std::size_t at = 0; at < 12288; at += 2) {
    if (whole.substr(at, 8) == std::string(8, '\0')) continue;
    for (const std::string& lie :
         {std::string(8, '\xff'), std::string(7, '\xff') + '\x7f', std::string("\0\0\0\0\1\0\0\0", 8),
          std::string("\xff\xff", 2), std::string("\1\0", 2)}) {
      patch(at, lie);
      try {
        const EnsembleFile file(path, false);
        CHECK(file.n_vertices() == file.surface().positions.size());
      } catch (const Error& error) {
        ++n_refused;
        CHECK(std::string(error.what()).find(path) == 0);
      }
      patch(at, whole.substr(at, lie.size()));
    }
  }
  CHECK(n_refused > 500);
  CHECK(EnsembleFile(path, false).n_done() == 4);
}

TEST_CASE("points that the file has no bytes for take no memory") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1));
  const std::string whole = read_file(path);
  const std::size_t n = planted_template(1).positions.size();
  // The size of the points: [n][3] 64-bit numbers.
  std::string size(16, '\0'), huge(16, '\0');
  for (std::size_t i = 0; i < 8; ++i) size[i] = static_cast<char>(n >> (8 * i));
  size[8] = huge[8] = 3;
  huge[4] = 1;  // 2^32
  const std::size_t at = whole.find(size);
  REQUIRE(at != std::string::npos);
  folder.write("a.h5", whole.substr(0, at) + huge + whole.substr(at + 16));
  CHECK(message_of([&] { EnsembleFile(path, false); }).find("is larger than the file; begin anew") !=
        std::string::npos);
}

TEST_CASE("one process at a time writes a file") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(3, 2, 5), planted_template(1));
  const EnsembleFile first(path, true);
  CHECK(message_of([&] { EnsembleFile(path, true); }) ==
        path + ": another run is writing this file; wait for its end, or name another output");
  CHECK(EnsembleFile(path, false).n_done() == 0);
  // Nor is it replaced under the run that writes it.
  const std::string before = read_file(path);
  CHECK(message_of([&] { EnsembleFile::create(path, planted_plan(2, 2, 5), planted_template(1)); }) ==
        path + ": another run is writing this file; wait for its end, or name another output");
  CHECK(read_file(path) == before);
  CHECK(folder.n_files() == 1);
}

TEST_CASE("a file that no run writes is replaced") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  for (const std::size_t n : {3, 2}) {
    EnsembleFile::create(path, planted_plan(n, 2, 5), planted_template(1));
    CHECK(EnsembleFile(path, true).plan().n_frames() == planted_plan(n, 2, 5).n_frames());
    CHECK(folder.n_files() == 1);
  }
}

TEST_SUITE_END();
