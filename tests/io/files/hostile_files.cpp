// hostile_files.cpp: files that once crashed or hung a reader, or were believed: each is refused in one line, or read
// right.
#include <sys/stat.h>

#include <algorithm>

#include "base/error.h"
#include "base/text/printable.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/grids/read_grid.h"
#include "io/structures/structure_file.h"
#include "io/vtk/read_vtp.h"
#include "io/vtk/write_vtp.h"
#include "support/test_data.h"
#include "support/text.h"

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

/// A triangle, all in words.
std::string surface_of_text() {
  return "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\">\n<Points>\n"
         "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0.25 0 0 1 "
         "0</DataArray></Points>\n"
         "<PointData>\n"
         "<DataArray type=\"Float64\" Name=\"source_position\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 "
         "1 "
         "0.75</DataArray>\n"
         "<DataArray type=\"Float32\" Name=\"slip\" format=\"ascii\">1 nan 2</DataArray></PointData>\n<Polys>"
         "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>"
         "<DataArray type=\"Int64\" Name=\"offsets\" "
         "format=\"ascii\">3</DataArray></Polys></Piece></PolyData></VTKFile>\n";
}

std::string refusal_of_map(const std::string& name) {
  return refusal(corpus(name), [](const std::string& path) { read_grid(path); });
}

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

TEST_CASE("hostile structures: numbers that mean something else than they say") {
  const auto refused = [](const std::string& name) {
    return refusal(corpus(name), [](const std::string& path) { read_structure(path); });
  };
  CHECK(contains(refused("pqr_doubled_atoms.pqr"),
                 ":6: atom 'N' of ALA 1 is the one of line 1 again, at the same place"));
  CHECK(contains(refused("pqr_radius_1e300.pqr"), ":14: radius of atom 'C4' is 1e+300; at most 1000 Angstrom"));
  CHECK(contains(refused("pqr_cut_in_radius.pqr"), ":5: "));
#ifdef ESPDIFF_HAVE_GEMMI
  CHECK(contains(refused("cif_resid_overflow.cif"),
                 ": _atom_site.auth_seq_id of atom 1 is '4294967301'; an integer below"));
  CHECK(contains(refusal(corpus("cif_assembly_without_matrices.cif"),
                         [](const std::string& path) {
                           StructureOptions options;
                           options.assembly = "1";
                           read_structure(path, options);
                         }),
                 ": assembly '1' has 2 operations, and 0 are described"));
#endif
  CHECK(refused("ala.pqr") == "");
}

TEST_CASE("PQR: a file that ends within its last number is not believed") {
  const ScratchFolder scratch;
  const std::string whole = read_file(corpus("ala.pqr"));
  const auto message = [&](const std::string& text) {
    return refusal(scratch.write("a.pqr", text), [](const std::string& path) { read_structure(path); });
  };
  REQUIRE(whole.substr(whole.size() - 7) == "1.7000\n");
  CHECK(message(whole) == "");
  CHECK(message(whole.substr(0, whole.size() - 1)) == "");  // no line end, and nothing is missing
  for (std::size_t n = 2; n < 7; ++n) {
    CAPTURE(n);
    CHECK(contains(message(whole.substr(0, whole.size() - n)), ":5: "));
  }
  CHECK(contains(message(whole.substr(0, whole.size() - 5)),
                 "its last number has 0 decimals instead of 4: it seems to be cut; fetch it again, or end the line"));
}

TEST_CASE("PQR: charges and radii that no atom has are refused with file and line") {
  const ScratchFolder scratch;
  const auto message = [&](const std::string& charge) {
    const std::string text = "ATOM 1 N ALA 1 0 0 0 " + charge + " 1.5\n";
    return refusal(scratch.write("a.pqr", text), [](const std::string& path) { read_structure(path); });
  };
  CHECK(message("1e39") == ":1: charge of atom 'N' is 1e+39; elementary charges between -1e6 and 1e6 were expected");
  CHECK(message("-2") == "");
}

TEST_CASE("cells of a file whose first model is empty") {
  const StructureFile file(corpus("empty_model_cryst1.pqr"));
  CHECK(file.n_models() == 2);
  CHECK_FALSE(file.unit_cell(1).has_value());
  REQUIRE(file.unit_cell(2).has_value());
  CHECK(file.unit_cell(2)->lengths.x == 60);
}

#ifdef ESPDIFF_HAVE_GEMMI
TEST_CASE("mmCIF: integers beyond 32 bits are refused in every column that has them") {
  const ScratchFolder scratch;
  const auto message = [&](const std::string& id, const std::string& label, const std::string& model) {
    const std::string path = scratch.write(
        "a.cif",
        "data_a\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
        "_atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n"
        "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n"
        "_atom_site.B_iso_or_equiv\n_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n"
        "_atom_site.pdbx_PDB_model_num\nATOM " +
            id + " N N . ALA A " + label + " 1 2 3 1 0 1 A " + model + "\n");
    return refusal(path, [](const std::string& name) { read_structure(name); });
  };
  CHECK(message("1", "1", "1") == "");
  CHECK(contains(message("-4294967297", "1", "1"), "_atom_site.id of atom 1 is '-4294967297'; an integer below 2^31"));
  CHECK(contains(message("1", "9999999999", "1"), "_atom_site.label_seq_id of atom 1 is '9999999999'; an integer"));
  CHECK(contains(message("1", "1", "4294967297"), "_atom_site.pdbx_PDB_model_num of atom 1 is '4294967297'; an "));
}

TEST_CASE("mmCIF without occupancies, alternate locations or B factors is read") {
  const ScratchFolder scratch;
  const std::string head =
      "data_X\nloop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_comp_id\n"
      "_atom_site.label_asym_id\n_atom_site.auth_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  const Molecule m = read_structure(scratch.write("a.cif", head + "1 N N ALA A 7 1 2 3\n2 C CA ALA A 7 2 2 3\n"));
  REQUIRE(m.size() == 2);
  CHECK(m.residues[0].number == 7);
  CHECK(m.positions[1] == Vec3d{2, 2, 3});
  // One atom may stand as pairs of tag and value.
  const Molecule one = read_structure(scratch.write(
      "b.cif",
      "data_X\n_atom_site.id 1\n_atom_site.type_symbol N\n_atom_site.label_atom_id N\n_atom_site.label_comp_id ALA\n"
      "_atom_site.label_asym_id A\n_atom_site.auth_seq_id 7\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n"
      "_atom_site.Cartn_z 3\n"));
  CHECK(one.size() == 1);
}
#endif

TEST_CASE("cube: numbers that touch are parted as Fortran wrote them") {
  const ScratchFolder scratch;
  const std::string head = "t\nu\n0 0 0 0\n2 1 0 0\n2 0 1 0\n2 0 0 1\n";
  const Grid grid = read_grid(scratch.write(
      "a.cube", head + "-0.12345E-01-0.22345E-01 0.32345E-01 0.42345-102\n-0.52345-101-0.62345E+01 7.5-8.25\n"));
  const std::vector<float> expected = {-0.012345F, -0.022345F, 0.032345F, 0, 0, -6.2345F, 7.5F, -8.25F};
  const std::size_t x_fastest[] = {0, 4, 2, 6, 1, 5, 3, 7};  // the file has z fastest
  for (std::size_t i = 0; i < 8; ++i) CHECK(grid.values[i] == expected[x_fastest[i]]);
  CHECK(contains(
      refusal(scratch.write("b.cube", head + "1 2 3 4 5 6 7 8..5\n"), [](const std::string& path) { read_grid(path); }),
      "value 8 is '8..5'"));
}

TEST_CASE("DX: words may stand on several lines, and tabs between them") {
  const ScratchFolder scratch;
  const Grid grid = read_grid(scratch.write(
      "a.dx",
      "object\t1\tclass\ngridpositions\n  counts 2\n2 2\norigin 0 0 0\ndelta 1 0 0\ndelta 0 1 0\ndelta 0 0 1\n"
      "object 2 class gridconnections\ncounts 2 2 2\nobject 3 class array type double\nrank 0 items\n8 data "
      "follows\n1 2 3 4 5 6 7 8\nattribute \"dep\" string \"positions\"\n"));
  CHECK(grid.values == std::vector<float>{1, 5, 3, 7, 2, 6, 4, 8});
}

TEST_CASE("what espdiff wrote itself is read from files only: a pipe in its place would block") {
  const ScratchFolder scratch;
  const std::string pipe = scratch.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(refusal(pipe, [](const std::string& path) { sha256_of_file(path); }) ==
        ": is a pipe or a device; save its content as a file and give that");
}

TEST_CASE("names with control characters do not reach the terminal") {
  CHECK(printable("a\nb\x1b[31m\xc2\x9b.pqr: \xc3\x85 is fine") == "a?b?[31m??.pqr: \xc3\x85 is fine");
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
  CHECK(contains(attempt(replaced(good, one, by + "\"1001\"")), "NumberOfComponents is 1001, but 1 to 1000"));
  CHECK(
      contains(attempt(replaced(good, "NumberOfPoints=\"4\"", "NumberOfPoints=\"400000000\"")), "bytes, but its type"));
  CHECK(contains(attempt(replaced(good, "NumberOfPolys=\"4\"", "NumberOfPolys=\"-4\"")), "NumberOfPolys is -4"));
}

TEST_CASE("VTP: values that a surface cannot have are refused with the line of their array") {
  const ScratchFolder scratch;
  const auto attempt = [&](const std::string& old, const std::string& text) {
    return refusal(scratch.write("a.vtp", replaced(surface_of_text(), old, text)),
                   [](const std::string& path) { read_vtp(path); });
  };
  const std::string again = "; write or fetch the file again";
  CHECK(attempt("", "") == "");
  CHECK(attempt("nan", "0") == "");
  for (const std::string text : {"nan", "-inf", "1e+30"}) {
    const std::string what = " has the coordinate " + text + "; at most 10^6 Angstrom were expected" + again;
    CHECK(attempt("0.25", text) == ":3: vertex 1" + what);
    CHECK(attempt("0.75", text) == ":5: vertex 2" + what);
  }
  CHECK(attempt("nan", "inf") == ":6: array 'slip' has an infinite value; numbers or nan were expected" + again);
  CHECK(attempt("0.75", "half") ==
        ":5: value 9 of array 'source_position' is 'half', but a number was expected" + again);
  CHECK(attempt(" 0.75", "") ==
        ":5: array 'source_position' has 8 values, but its type and the number of points ask for 9" + again);
}

TEST_CASE("hostile VTP: more elements, and deeper ones, than are read are refused") {
  const ScratchFolder scratch;
  const auto with = [&](const std::string& more) {
    std::string text = surface_text();
    text.insert(text.find("<PolyData>") + 10, more);
    return refusal(scratch.write("a.vtp", text), [](const std::string& path) { read_vtp(path); });
  };
  const auto repeated = [](const std::string& item, int n) {
    std::string text;
    for (int i = 0; i < n; ++i) text += item;
    return text;
  };
  CHECK(with(repeated("<A/>", 1000)) == "");
  CHECK(contains(with(repeated("<A/>\n", 100'000)), "there are more than 100000 elements"));
  CHECK(with(repeated("<A>", 60) + repeated("</A>", 60)) == "");
  CHECK(contains(with(repeated("<A>", 65)), "elements lie in each other more than 64 deep"));
  CHECK(contains(with(repeated("<A>", 5'000'000)), "elements lie in each other more than 64 deep"));
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
