// export_result.cpp: a result as files of other programs: what each holds, by the grammar of its format.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

#include "base/error.h"
#include "cli/run_espdiff.h"
#include "export/export_result.h"
#include "io/structures/structure_file.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

/// A comparison of two rows of atoms, whose residues have a name.
struct RowResult {
  ScratchFolder folder;
  std::string prefix = folder.file("pair");
  explicit RowResult(const std::string& residue = "ALA") {
    folder.write("a.pqr", row_of_atoms(8, 0, residue));
    folder.write("b.pqr", row_of_atoms(8, 0.4, residue));
    REQUIRE(run_espdiff(folder.file("a.pqr") + " " + folder.file("b.pqr") + " --potential coulomb -q -o " + prefix)
                .status == 0);
  }
  std::string exported(const std::string& format, const ExportOptions& options = {}, const std::string& output = "") {
    return read_file(export_result(prefix, export_format(format), output, options).at(0));
  }
};

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

float f32(const std::string& bytes, std::size_t at) {
  float value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

/// The two chunks of a binary glTF file.
struct Glb {
  nlohmann::json json;
  std::string binary;
  explicit Glb(const std::string& bytes) {
    REQUIRE(bytes.substr(0, 4) == "glTF");
    REQUIRE(u32(bytes, 4) == 2);
    REQUIRE(u32(bytes, 8) == bytes.size());
    const std::uint32_t n = u32(bytes, 12);
    REQUIRE(n % 4 == 0);
    REQUIRE(bytes.substr(16, 4) == "JSON");
    json = nlohmann::json::parse(bytes.substr(20, n));
    REQUIRE(bytes.substr(20 + n + 4, 4) == std::string("BIN\0", 4));
    binary = bytes.substr(20 + n + 8);
    REQUIRE(u32(bytes, 20 + n) == binary.size());
  }
  std::size_t begin(const nlohmann::json& accessor) const {
    return json.at("bufferViews").at(accessor.get<std::size_t>()).at("byteOffset").get<std::size_t>();
  }
};

}  // namespace

TEST_CASE("a glTF file has the positions, values and colours of its result") {
  RowResult result;
  const PairFiles files = read_pair_files(result.prefix);
  const Glb glb(result.exported("glb"));
  const auto& primitive = glb.json.at("meshes").at(0).at("primitives").at(0);
  const auto& attributes = primitive.at("attributes");
  const std::size_t positions = glb.begin(attributes.at("POSITION")),
                    values = glb.begin(attributes.at("_POTENTIAL_DIFFERENCE")),
                    source = glb.begin(primitive.at("targets").at(0).at("POSITION"));
  const VtpNumbers& difference = *find_array(files.surface.point_arrays, "potential_difference");
  const std::vector<Vec3d> on_source = superposed_source(files);
  for (std::size_t v = 0; v < files.surface.positions.size(); v += 7) {
    CHECK(f32(glb.binary, positions + 12 * v) == doctest::Approx(files.surface.positions[v].x));
    CHECK(f32(glb.binary, values + 4 * v) == doctest::Approx(difference.values[v]));
    CHECK(f32(glb.binary, source + 12 * v) ==
          doctest::Approx(on_source[v].x - files.surface.positions[v].x).epsilon(1e-4));
  }
  for (const auto& view : glb.json.at("bufferViews")) CHECK(view.at("byteOffset").get<std::size_t>() % 4 == 0);
  CHECK(glb.json.at("asset").at("extras").at("Surface").get<std::string>().rfind("Difference", 0) == 0);
  CHECK(attributes.contains("COLOR_0"));
}

TEST_CASE("files of a study have the widest scales of all its results") {
  RowResult one;
  one.folder.write("c.pqr", std::regex_replace(row_of_atoms(8, 0.4), std::regex(" 0\\.5000"), " -2.000"));
  const std::string other = one.folder.file("other");
  REQUIRE(run_espdiff(one.folder.file("a.pqr") + " " + one.folder.file("c.pqr") + " --potential coulomb -q -o " + other)
              .status == 0);
  ExportOptions with_other, with_one;
  with_other.range_of = {other};
  with_one.range_of = {one.prefix};
  const ExportedResult alone = read_exported_result(one.prefix, {}), widest = read_exported_result(other, {});
  REQUIRE(alone.scale.limit < widest.scale.limit);
  REQUIRE(alone.residue_scale.limit < widest.residue_scale.limit);
  for (const ExportedResult& shared :
       {read_exported_result(one.prefix, with_other), read_exported_result(other, with_one)}) {
    CHECK(shared.scale.limit == widest.scale.limit);
    CHECK(shared.residue_scale.limit == widest.residue_scale.limit);
  }
  with_other.limit = 1;
  CHECK_THROWS_WITH_AS(read_exported_result(one.prefix, with_other), doctest::Contains("exclude each other"),
                       InputError);
  with_one.range_of = {one.folder.file("none")};
  CHECK_THROWS_WITH_AS(read_exported_result(one.prefix, with_one), doctest::Contains("none.vtp"), IoError);
}

TEST_CASE("a PLY file has a line for every number of a vertex") {
  RowResult result;
  const PairFiles files = read_pair_files(result.prefix);
  const std::string ply = result.exported("ply");
  CHECK(ply.rfind("ply\nformat binary_little_endian 1.0\ncomment Title: b.pqr against a.pqr\n", 0) == 0);
  for (const SurfaceQuantity& quantity : surface_quantities(files))
    CHECK(contains(ply, "property float " + quantity.values->name + "\n"));
  CHECK(contains(ply, "element vertex " + std::to_string(files.surface.positions.size()) + "\n"));
  const std::size_t body = ply.find("end_header\n") + 11;
  const std::size_t n_floats = 9 + surface_quantities(files).size();
  CHECK(ply.size() - body == files.surface.positions.size() * (4 * n_floats + 3) + files.surface.triangles.size() * 13);
  CHECK(f32(ply, body) == doctest::Approx(files.surface.positions[0].x));
}

TEST_CASE("no line of a PLY file's head is longer than MeshLab reads, and none is cut inside a character") {
  RowResult result;
  ExportOptions options;
  options.title = std::string(399, 'a');
  for (int i = 0; i < 400; ++i) options.title += "\u00e5";
  options.title += " counted_faces 1";
  const std::string ply = result.exported("ply", options);
  std::istringstream head(ply.substr(0, ply.find("end_header\n")));
  std::string title;
  for (std::string line; std::getline(head, line);) {
    CHECK(line.size() <= 511);
    CHECK((line.size() < 11 || (static_cast<unsigned char>(line[10]) & 0xC0U) != 0x80U));
    if (title.empty() ? line.rfind("comment Title: ", 0) == 0 : line.rfind("comment   ", 0) == 0)
      title += title.empty() ? line.substr(15) : line.substr(10);
  }
  CHECK(title.rfind(std::string(399, 'a') + "\u00e5\u00e5", 0) == 0);
}

TEST_CASE("residues carry their values in PDB and mmCIF files, in the target's frame") {
  RowResult result;
  const CsvTable table = read_csv(result.prefix + ".residues.csv");
  const double value = table.number(2, table.require("mean_abs_difference [kT/e in vacuum]"));
  ExportOptions options;
  for (const std::string format : {"pdb", "cif"}) {
    CAPTURE(format);
    const std::string path = export_result(result.prefix, export_format(format), "", options).at(0);
    if (format == "cif") {
      const std::string text = read_file(path);
      CHECK(contains(text, "_espdiff_residue.mean_abs_difference\n"));
      CHECK(contains(text, "ATOM 3 C CA . ALA A 1 3 ? "));
#ifndef ESPDIFF_HAVE_GEMMI
      continue;
#endif
    }
    const Molecule molecule = read_structure(path);
    REQUIRE(molecule.size() == 8);
    CHECK(molecule.atoms[2].b_factor == doctest::Approx(value).epsilon(0.01));
    CHECK(molecule.positions[0].x == doctest::Approx(0.4).epsilon(0.01));  // the target's row begins there
  }
}

TEST_CASE("a scene for Mol* has a node for every residue, and a colour for every group of triangles") {
  RowResult result;
  const auto scene = nlohmann::json::parse(result.exported("mvsj"));
  const auto& root = scene.at("root");
  const auto& mesh = root.at("children").at(1).at("children").at(0).at("params");
  const PairFiles files = read_pair_files(result.prefix);
  CHECK(mesh.at("vertices").size() == 3 * files.surface.positions.size());
  CHECK(mesh.at("triangle_groups").size() == files.surface.triangles.size());
  for (const auto& group : mesh.at("triangle_groups"))
    REQUIRE(mesh.at("group_colors").contains(std::to_string(group.get<int>())));
  const auto& structure = root.at("children").at(0).at("children").at(0).at("children").at(0);
  CHECK(structure.at("children").size() == 2 + 8);
  CHECK(structure.at("children").at(2).at("params").at("selector").at("auth_seq_id") == 1);
  CHECK(result.exported("mvsj") == result.exported("mvsj"));
}

TEST_CASE("scripts come with the files that they load") {
  RowResult result;
  for (const ExportFormat& format : export_formats()) {
    const std::vector<std::string> written =
        export_result(result.prefix, format, result.folder.file("x" + format.ending), {});
    CHECK(written.size() == 1 + format.loads.size());
    CHECK(written == export_outputs(result.prefix, format, result.folder.file("x" + format.ending)));
    const std::string script = read_file(written[0]);
    for (std::size_t i = 1; i < written.size(); ++i) {
      CHECK(std::filesystem::exists(written[i]));
      CHECK(contains(script, '"' + std::filesystem::path(written[i]).filename().string() + '"'));
    }
  }
}

TEST_CASE("names in files stay names") {
  RowResult result("'#_");
  ExportOptions options;
  options.title = "\"]\nimport os\n'''; open x # @MESH@";
  const std::string title = "\"]?import os?'''; open x # @MESH@";
  CHECK(contains(result.exported("ply", options), "comment Title: " + title + "\n"));
  CHECK(contains(result.exported("pymol", options), "# Title: " + title + "\n"));
  CHECK(contains(result.exported("chimerax", options), "2dlabels text \" ]?import os?     open x   @MESH@\" "));
  CHECK(contains(result.exported("cif", options), " CA . \"'#_\" A "));
  CHECK(nlohmann::json::parse(result.exported("mvsj", options)).at("metadata").at("title") == title);
  const std::string named = result.folder.file("a'b.cxc");
  CHECK_THROWS_WITH_AS(export_result(result.prefix, export_format("chimerax"), named, options),
                       doctest::Contains("a'b.glb: a command of ChimeraX cannot name a file with quotes"), InputError);
  CHECK(!std::filesystem::exists(named));
  const std::string bytes = result.folder.file("\xff.pymol.py");
  CHECK_THROWS_WITH_AS(export_result(result.prefix, export_format("pymol"), bytes, options),
                       doctest::Contains("this name is not UTF-8, so that no result can name the file; rename it"),
                       InputError);
}

TEST_CASE("a result that cannot be exported is refused in one line") {
  RowResult result;
  const auto fails = [&](const std::string& arguments) {
    const Outcome outcome = run_espdiff("export " + result.prefix + ' ' + arguments);
    CHECK(outcome.status == 2);
    CHECK(n_lines(outcome.err) == 1);
    return outcome.err;
  };
  CHECK(contains(fails("--to obj"), "obj"));
  CHECK(contains(fails("--to glb --array none"), "has no point array 'none': there are potential_difference, "));
  CHECK(contains(fails("--to pdb --residues none"),
                 "has no column 'none': there are area, trusted_area_fraction, mean_abs_difference, "));
  CHECK(contains(fails("--to glb --range -3"), "--range: '-3' is not a number of 0 or more"));
  CHECK(contains(fails("--to pdb -o " + result.folder.file("a.pqr")), "a.pqr"));
  result.folder.write("a.pqr", row_of_atoms(8, 1));
  CHECK(contains(fails("--to pdb"), "a.pqr has changed since the comparison; compare again, or export the surface"));
  CHECK(run_espdiff("export " + result.prefix + ".vtp --to glb --overwrite").status == 0);
  const std::string json = read_file(result.prefix + ".json");
  result.folder.write("pair.json", "{\"certificate\": {}, \"superposition\": 3}");
  CHECK(contains(fails("--to glb"), "not a record that `espdiff compare` wrote; compare again"));
  auto other = nlohmann::json::parse(json);
  other["n_vertices"] = 3;
  result.folder.write("pair.json", other.dump());
  CHECK(contains(fails("--to glb"), "vertices, and not those of "));
}
