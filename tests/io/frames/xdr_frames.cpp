// xdr_frames.cpp: XTC and TRR trajectories, whole, cut off at every byte, and damaged.
#include "io/frames/xdr_frames.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

std::string xdr(const std::vector<std::uint32_t>& numbers) {
  std::string bytes;
  for (const std::uint32_t number : numbers) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> static_cast<unsigned>(shift));
  }
  return bytes;
}

/// As GROMACS writes it: magic, atoms, step, time, box (9), atoms; then coordinates as they are, or 8 numbers, the size
/// of the packed ones and these, filled up to four bytes. @param magic 2023: the size has 64 bits
std::string xtc_frame(std::uint32_t n_atoms, std::uint32_t n_packed, std::uint32_t magic = 1995) {
  std::string frame = xdr({magic, n_atoms, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, n_atoms});
  if (n_atoms <= 9) return frame + xdr(std::vector<std::uint32_t>(3 * n_atoms));
  frame += xdr(std::vector<std::uint32_t>(8));
  frame += magic == 2023 ? xdr({0, n_packed}) : xdr({n_packed});
  return frame + std::string((n_packed + 3) / 4 * 4, 'x');
}

/// Magic, "GMX_trn_file", the sizes of ten blocks (the third is the box, the eighth the positions), atoms, step,
/// energies, time and lambda, the blocks.
std::string trr_frame(std::uint32_t n_atoms, std::uint32_t real, bool has_positions = true) {
  const std::uint32_t n = 3 * real * n_atoms;
  const std::uint32_t positions = has_positions ? n : 0, velocities = has_positions ? 0 : n;
  return xdr({1993, 13, 12}) + "GMX_trn_file" +
         xdr({0, 0, 9 * real, 0, 0, 0, 0, positions, velocities, 0, n_atoms, 0, 0}) +
         std::string(2 * real + 9 * real + n, '\0');
}

std::string repeated(const std::string& frame, int n) {
  std::string text;
  for (int i = 0; i < n; ++i) text += frame;
  return text;
}

}  // namespace

TEST_CASE("the whole frames of an XTC or TRR are counted from their sizes, and what is missing is told") {
  const ScratchFolder folder;
  for (const std::string& frame : {xtc_frame(3, 0), xtc_frame(9, 0), xtc_frame(10, 41), xtc_frame(10, 44, 2023),
                                   trr_frame(7, 4), trr_frame(7, 8)}) {
    const std::string whole = repeated(frame, 3);
    const auto frames_of = [&](std::size_t n) {
      return read_xdr_frames(folder.write("a.xtc", whole.substr(0, n))).value();
    };
    CHECK(frames_of(whole.size()).n_whole == 3);
    CHECK(frames_of(whole.size()).missing.empty());
    CHECK(frames_of(whole.size()).have_positions);
    CHECK(frames_of(2 * frame.size()).missing.empty());
    for (std::size_t n = 2 * frame.size() + 1; n < whole.size(); ++n) {
      const XdrFrames cut = frames_of(n);
      CHECK(cut.n_whole == 2);
      CHECK(cut.missing.rfind("is cut off in frame 2 (" + std::to_string(n - 2 * frame.size()) + " ", 0) == 0);
    }
    CHECK(frames_of(whole.size() - 1).missing == "is cut off in frame 2 (" + std::to_string(frame.size() - 1) + " of " +
                                                     std::to_string(frame.size()) + " bytes)");
    CHECK(frames_of(2 * frame.size() + 6).missing == "is cut off in frame 2 (6 bytes of it are there)");
    const XdrFrames damaged = read_xdr_frames(folder.write("a.xtc", frame + "rubbish" + frame)).value();
    CHECK(damaged.n_whole == 1);
    CHECK(damaged.missing == "is damaged: no frame begins where frame 1 should");
  }
}

TEST_CASE("a TRR with frames of velocities alone says so; other files are left to their readers") {
  const ScratchFolder folder;
  const auto frames = read_xdr_frames(folder.write("a.trr", trr_frame(5, 4) + trr_frame(5, 4, false)));
  REQUIRE(frames.has_value());
  CHECK(frames->n_whole == 2);
  CHECK_FALSE(frames->have_positions);
  for (const std::string& other : {std::string(), std::string("x"), std::string("ATOM      1"), xdr({84})})
    CHECK_FALSE(read_xdr_frames(folder.write("b", other)).has_value());
  CHECK_FALSE(read_xdr_frames(folder.file("none")).has_value());
}
