// hostile_files.cpp: files that once crashed or hung a reader, or were believed: each is refused in one line, or read
// right.
#include <cmath>

#include "base/error.h"
#include "io/read_grid.h"
#include "io/read_structure.h"
#include "io/read_vtp.h"
#include "io/write_vtp.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

std::string corpus(const std::string& name) { return ESPDIFF_SOURCE_DIR "/tests/io/corpus/" + name; }

/// The message of the error that reading ends with, without the path; "" when the file is read.
template <typename Read>
std::string refusal(const std::string& path, Read read) {
  try {
    read(path);
  } catch (const Error& error) {
    std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.find(path) == 0);
    return message.substr(std::min(path.size(), message.size()));
  }
  return "";
}

std::string refusal_of_map(const std::string& name) {
  return refusal(corpus(name), [](const std::string& path) { read_grid(path); });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("hostile VTI: what crashed or hung VTK's reader is refused") {
  CHECK(contains(refusal_of_map("vti_sigfpe_header_type_empty.vti"), ":2: header_type is '', but UInt32 or UInt64"));
  CHECK(
      contains(refusal_of_map("vti_sigfpe_header_uint32.vti"), ":6: array 'potential' has a damaged table of blocks"));
  CHECK(contains(refusal_of_map("vti_sigsegv_type_string.vti"), ":6: the type of array 'potential' is 'String'"));
  CHECK(contains(refusal_of_map("vti_sigsegv_dupbyte.vti"), ":5: <Array> has no attribute type"));
  CHECK(contains(refusal_of_map("vti_hang_ncomp.vti"), ":6: NumberOfComponents is '4294967297'"));
  CHECK(contains(refusal_of_map("vti_internal_offset1.vti"), ":6: array 'potential' has a damaged table of blocks"));
  CHECK(contains(refusal_of_map("vti_vtk_log_on_stderr.vti"), ":6: the type of array 'potential' is 'Float33'"));
}

TEST_CASE("hostile VTI: nonsense that VTK's reader believes is refused") {
  CHECK(contains(refusal_of_map("vti_spacing_nan_accepted.vti"), ":3: Spacing is 'nan 1 1', but 3 finite numbers"));
  CHECK(contains(refusal_of_map("vti_spacing_two_numbers_accepted.vti"), ":3: Spacing is '2 2', but 3 finite"));
  CHECK(contains(refusal_of_map("vti_origin_comma_becomes_0.vti"), ":3: Origin is '1,5 -3 -3', but 3 finite"));
  CHECK(contains(refusal_of_map("vti_origin_1.5.2_accepted.vti"), ":3: Origin is '1.5.2 -3 -3', but 3 finite"));
  CHECK(contains(refusal_of_map("vti_type_int8_accepted.vti"),
                 ":9: array 'potential' has 2048 bytes, but its type and the number of points ask for 512"));
  CHECK(contains(refusal_of_map("vti_extent_other_than_data_accepted.vti"),
                 ":9: array 'potential' has 2048 bytes, but its type and the number of points ask for 560"));
}

namespace {

/// A surface file as espdiff writes it.
std::string surface_text() {
  const std::vector<Vec3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const std::vector<std::uint8_t> corrupt = {0, 0, 1, 0};
  VtpSurface surface;
  surface.points = VtpArray("Points", points);
  surface.triangles = &triangles;
  surface.cell_arrays.emplace_back("corrupt", corrupt);
  surface.texts = {{"written_by", "espdiff"}};
  std::ostringstream text;
  write_vtp(text, surface);
  return text.str();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  REQUIRE(contains(text, what));
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("hostile VTP: what crashed or hung VTK's reader is refused or read") {
  const ScratchFolder scratch;
  const auto attempt = [&](const std::string& text) {
    return refusal(scratch.write("a.vtp", text), [](const std::string& path) { read_vtp(path); });
  };
  const std::string good = surface_text();
  REQUIRE(attempt(good) == "");
  // A NUL within a text of the field data: the text ends there.
  CHECK(attempt(replaced(good, "102 102 0", "0 102 0")) == "");
  CHECK(read_vtp(scratch.file("a.vtp")).texts[0].second == "espdi");
  const std::string one = "Name=\"corrupt\" NumberOfComponents=\"1\"";
  const std::string by = "Name=\"corrupt\" NumberOfComponents=";
  CHECK(contains(attempt(replaced(good, one, by + "\"9223372036854775807\"")),
                 "NumberOfComponents is '9223372036854775807'"));
  CHECK(contains(attempt(replaced(good, one, by + "\"-1\"")), "NumberOfComponents is -1, but 1 to 1000"));
  CHECK(
      contains(attempt(replaced(good, "NumberOfPoints=\"4\"", "NumberOfPoints=\"400000000\"")), "bytes, but its type"));
  CHECK(contains(attempt(replaced(good, "NumberOfPolys=\"4\"", "NumberOfPolys=\"-4\"")), "NumberOfPolys is -4"));
}

TEST_CASE("VTI and VTP: every truncation of a good file is refused") {
  const ScratchFolder scratch;
  const std::string surface = surface_text();
  for (std::size_t n = 1; n + 1 < surface.size(); ++n) {
    CAPTURE(n);
    const std::string path = scratch.write("a.vtp", surface.substr(0, n));
    CHECK(refusal(path, [](const std::string& p) { read_vtp(p); }) != "");
  }
  const std::string map = read_file(corpus("vti_origin_comma_becomes_0.vti"));
  const std::string good = replaced(map, "1,5", "1.5");
  CHECK(refusal(scratch.write("a.vti", good), [](const std::string& p) { read_grid(p); }) == "");
  for (std::size_t n = 1; n + 1 < good.size(); ++n) {
    CAPTURE(n);
    const std::string path = scratch.write("a.vti", good.substr(0, n));
    CHECK(refusal(path, [](const std::string& p) { read_grid(p); }) != "");
  }
}
