// write_compare.cpp: the files of a result and its table, on a small hand-made result.
#include "report/write_compare.h"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "certificate/result.h"
#include "engine/deform_stage.h"
#include "options/options.h"
#include "options/settings.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/sections/provenance.h"
#include "support/nan.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::kNan;
using espdiff_test::message_of;
using espdiff_test::read_file;
using espdiff_test::ScratchFolder;
using Json = nlohmann::json;

namespace {

Molecule made_molecule(const std::string& name) {
  Molecule molecule;
  molecule.name = name;
  molecule.residues = {{"ALA", "A", 7, ' '}, {"GLY", "A", 7, 'B'}, {"LYS", "", 9, ' '}};
  molecule.radii_origin = ValueOrigin::kFile;
  return molecule;
}

/// A tetrahedron whose last vertex lies outside a map.
CompareResult made_result() {
  CompareResult result;
  result.rmsd_A = 0.25;
  result.alignment.pairing.method = "sequence alignment";
  result.alignment.pairing.pairs = {{0, 0}, {1, 2}, {2, 3}};
  result.alignment.pairing.n_aligned_residues = 3;
  result.alignment.pairing.n_substituted_residues = 1;
  result.alignment.n_superposed_atoms = 3;
  result.alignment.source_to_target.translation = {1, 2, 3};
  result.potential.compared = true;
  result.potential.unit = PotentialUnit::kKtPerE;
  result.potential.metrics = {10, 1.5, 2.5, -0.5, 0.25, 0.75, 0.8, 1.25, 1.75};
  result.potential.metrics_all = {12, 1.6, 2.6, -0.6, 0.3, std::nan(""), 0.7, 1.5, 2};
  result.potential.n_outside_target_map = 1;
  result.source_surface = {4, 4, 1, 2, 11, 3};
  result.target_surface = {5, 6, 1, 0, 12, 0};
  result.area_mapped_A2 = 12;
  result.certificate.corrupt_area_fraction = 0.125;
  result.certificate.mapped_to_target = {0.01, 0.05, 0.5, 0, 0.01, nullptr};
  result.certificate.target_to_mapped = {0.02, 0.06, 1.5, 0.25, 0.015, nullptr};
  result.certificate.unmatched_target = 0.25;
  result.certificate.converged = true;
  result.certificate.reasons = {"12.5 % of the mapped area is corrupt (limit 0.1 %)"};
  result.certificate.self_intersecting_pairs = 3;
  result.certificate.not_checked = {"something_else"};
  result.mapping.regularize.iterations = 17;
  result.n_steps = 42;
  result.residues = {{{6, 1, -1, 2, 1, 0.5}, 0, 1, 2, 0.25, 0, -1.5, 5},
                     {{4, 2, 2, 0, 2, 0}, 1, 1.5, 3, 3.5, 0.5, 2.5, 4},
                     {{0, kNan, kNan, kNan, kNan, kNan}, 2, kNan, kNan, kNan, kNan, kNan, kNan}};
  result.residues[0].trusted_area_fraction = 1;
  result.residues[1].trusted_area_fraction = 0.5;
  result.residues[2].trusted_area_fraction = kNan;
  MappedSurface& s = result.surface;
  s.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  s.source_positions = {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
  s.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  s.source_normals = s.normals;
  s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  s.potential_source = {1, -1, 0, 2};
  s.potential_target = {-1, -3, -2, kNan};
  s.displacement = {1, 1, 1, 1};
  s.path_length = {1.5, 1, 2, 1};
  s.residue = {0, 1, 2, -1};
  s.target_residue = {0, 2, 2, -1};
  s.corrupt = {0, 0, 1, 0};
  s.why = {0, 7, 2, 4};
  result.time_ms = {{"align", 1.5}, {"total", 20}};
  return result;
}

Provenance made_provenance() {
  Provenance provenance;
  provenance.version = "1.2.3";
  provenance.device = "cpu";
  provenance.threads = 2;
  provenance.inputs = {{"source", "a.pqr", "ab12"}, {"target_map", "b.dx", "cd34"}};
  provenance.command_line = "espdiff compare a.pqr b.pqr -o out";
  return provenance;
}

Json made_json(const CompareResult& result, const espdiff::OptionSpelling& spelling = espdiff::bare_name) {
  CompareOptions options;
  options.method = espdiff::Method::kDeform;
  return compare_json(made_molecule("a.pqr"), made_molecule("b.pqr"), result, options, made_provenance(), spelling);
}

void write(const std::string& prefix, const CompareResult& result = made_result()) {
  write_compare(prefix, made_molecule("a.pqr"), made_molecule("b.pqr"), result, {}, made_provenance());
}

std::string made_table(const CompareResult& result) {
  std::ostringstream out;
  print_table(out, made_json(result, [](const espdiff::NamedOption& o) { return "--" + o.name; }));
  return out.str();
}

}  // namespace

TEST_CASE("OUT.json has every key of the contract, with its type") {
  const Json json = made_json(made_result());
  for (const char* key : {"rmsd_A", "mean_abs_difference", "rms_difference", "mean_signed_difference",
                          "sign_change_area_fraction", "mean_displacement_A"}) {
    CHECK_MESSAGE(json.at(key).is_number_float(), key);
  }
  for (const char* key : {"n_paired_atoms", "n_vertices", "n_triangles", "n_components", "iterations", "threads"}) {
    CHECK_MESSAGE(json.at(key).is_number_integer(), key);
  }
  for (const char* key : {"potential_unit", "device", "version"}) CHECK_MESSAGE(json.at(key).is_string(), key);
  for (const char* key : {"area_A2", "certificate", "time_ms", "options"}) CHECK_MESSAGE(json.at(key).is_object(), key);
  for (const char* key : {"source", "mapped", "trusted"}) CHECK_MESSAGE(json.at("area_A2").at(key).is_number(), key);
  const Json& certificate = json.at("certificate");
  for (const char* key : {"corrupt_area_fraction", "flipped_area_fraction", "irregularity_A"}) {
    CHECK_MESSAGE(certificate.at(key).is_number(), key);
  }
  for (const char* surface : {"mapped_to_target_A", "target_to_mapped_A"}) {
    for (const char* key : {"mean", "p95", "max"}) CHECK_MESSAGE(certificate.at(surface).at(key).is_number(), key);
  }
  CHECK(certificate.at("no_counterpart_area_fraction").at("source").is_number());
  CHECK(certificate.at("no_counterpart_area_fraction").at("target").is_number());
  CHECK(certificate.at("converged").is_boolean());
  CHECK(certificate.at("trustworthy").is_boolean());
  CHECK(certificate.at("verdict").is_string());
  CHECK(certificate.at("untrusted_parts").is_array());
  CHECK(certificate.at("trusted_area_fraction").at("source").is_number());
  CHECK(certificate.at("not_trusted").size() == espdiff::kNumberOfWhys - 1);
  CHECK(certificate.at("reasons").is_array());
}

TEST_CASE("OUT.json has the result's values") {
  const Json json = made_json(made_result());
  CHECK(json["rmsd_A"] == 0.25);
  CHECK(json["n_paired_atoms"] == 3);
  CHECK(json["potential_unit"] == "kT/e");
  CHECK(json["mean_signed_difference"] == -0.5);
  CHECK(json["hodgkin_index"] == 0.75);
  CHECK(json["area_A2"] == Json({{"source", 11}, {"target", 12}, {"mapped", 12}, {"trusted", 10}}));
  CHECK(json["mean_displacement_A"] == 1.25);
  CHECK(json["mean_path_length_A"] == 1.75);
  CHECK(json["metrics_all_triangles"]["mean_abs_difference"] == 1.6);
  CHECK(json["certificate"]["target_to_mapped_A"]["max"] == 1.5);
  CHECK(json["certificate"]["reasons"][0] == "12.5 % of the mapped area is corrupt (limit 0.1 %)");
  CHECK(json["superposition"]["rotation_row_major"] == Json({1, 0, 0, 0, 1, 0, 0, 0, 1}));
  CHECK(json["superposition"]["translation_A"] == Json({1, 2, 3}));
  CHECK(json["superposition"]["n_substituted_residues"] == 1);
  CHECK(json["n_vertices"] == 4);
  CHECK(json["n_triangles"] == 4);
  CHECK(json["n_cavities_left_out"]["source"] == 2);
  CHECK(json["n_vertices_outside_map"]["target"] == 1);
  CHECK(json["radii_origin"]["source"] == "file");
  CHECK(json["iterations"] == 42);
  CHECK(json["time_ms"]["total"] == 20);
  CHECK(json["inputs"][1] == Json({{"role", "target_map"}, {"path", "b.dx"}, {"sha256", "cd34"}}));
  CHECK(json["version"] == "1.2.3");
}

TEST_CASE("a pair that was mapped twice says which mapping was kept, why, and what the other gave") {
  CompareResult result = made_result();
  Json motions = made_json(result)["motions"];
  CHECK(motions["domains"] == "none");
  CHECK(motions["because"].is_null());
  CHECK(motions["other"].is_null());
  CHECK(made_table(result).find("Mapped twice") == std::string::npos);
  result.mapping.domains = "local";
  result.certificate.same_residue_area_fraction = 0.75;
  result.mapping.other = {"more is on its own residue", "none", {"12.5 % slipped"}, 0.125, 0.5, 0.01, 0.02, 0.4925};
  motions = made_json(result)["motions"];
  CHECK(motions["domains"] == "local");
  CHECK(motions["own_residue_area_fraction"].get<double>() == doctest::Approx(0.75 * (11 + 0.75 * 12) / 23));
  CHECK(motions["because"] == "more is on its own residue");
  CHECK(motions["other"] == Json({{"domains", "none"},
                                  {"own_residue_area_fraction", 0.4925},
                                  {"beyond_3A_area_fraction", 0.125},
                                  {"same_residue_area_fraction", 0.5},
                                  {"no_counterpart_area_fraction", {{"source", 0.01}, {"target", 0.02}}},
                                  {"reasons", {"12.5 % slipped"}}}));
  const std::string table = made_table(result);
  CHECK(table.find("Mapped twice, kept") != std::string::npos);
  CHECK(table.find("local motions: more is on its own residue") != std::string::npos);
  CHECK(table.find("the superposition of the whole: 12.5 % beyond 3 A, 50 % on the same residue, unmatched 1 %, 2 %") !=
        std::string::npos);
}

TEST_CASE("OUT.json echoes all options under their names") {
  CompareOptions options;
  options.surface.grid_spacing_A = 0.5;
  options.align = AlignAtoms::kBackbone;
  options.field = DeformField::kDensity;
  options.deform.interpolation = Interpolation::kTricubic;
  options.round_trip = true;
  options.temperature_K = 301.23456789;
  const Molecule molecule = made_molecule("a.pqr");
  const Json json = compare_json(molecule, molecule, made_result(), options, made_provenance()).at("options");
  CHECK(json["align"] == "backbone");
  CHECK(json["field"] == "density");
  CHECK(json["grid_spacing_A"] == 0.5);
  CHECK(json["interpolation"] == "tricubic");
  CHECK(json["mu"] == 0.75);
  CHECK(json["min_displacement"] == 5e-4);
  CHECK(json["regularize_min_displacement"] == 7.5e-3);
  CHECK(json["rest_shape"] == "source");
  CHECK(json["round_trip"] == true);
  CHECK(json["cavities"] == false);
  CHECK(json["gvf_weight_A2"].is_number());
  CHECK(json["max_iterations"].is_number_integer());
  CHECK(json["temperature_K"] == 301.23456789);  // every digit
  for (const espdiff::Setting& setting : espdiff::settings()) {
    if (setting.name != espdiff::kThesisSetting) CHECK_MESSAGE(json.contains(setting.key()), setting.name);
  }
  CHECK(json.size() == espdiff::settings().size() - 1);
}

TEST_CASE("what has no value is null") {
  CompareResult result = made_result();
  Json json = made_json(result);
  CHECK(json["certificate"].at("self_intersecting_pairs") == 3);
  CHECK(json["certificate"]["not_checked"] == Json({"something_else"}));
  CHECK(json["metrics_all_triangles"].at("hodgkin_index").is_null());  // NaN

  result.potential.compared = false;
  result.rmsd_A = std::nan("");
  json = made_json(result);
  for (const char* key : {"rmsd_A", "potential_unit", "mean_abs_difference", "rms_difference", "mean_signed_difference",
                          "sign_change_area_fraction", "carbo_index"}) {
    CHECK_MESSAGE(json.at(key).is_null(), key);
  }
  // Shapes are compared all the same: (6 * 1 + 4 * 1.5) / 10.
  CHECK(json["area_A2"]["trusted"] == 10);
  CHECK(json["mean_displacement_A"].get<double>() == doctest::Approx(1.2));
  CHECK(json["mean_path_length_A"].get<double>() == doctest::Approx(2.4));
}

TEST_CASE("a path that is not UTF-8 does not spoil the JSON") {
  Provenance provenance = made_provenance();
  provenance.inputs[0].path = "caf\xe9.pqr";
  const Molecule molecule = made_molecule("a.pqr");
  const ScratchFolder folder;
  write_compare(folder.file("out"), molecule, molecule, made_result(), {}, provenance);
  CHECK_NOTHROW(Json::parse(read_file(folder.file("out.json"))));
}

TEST_CASE("OUT.residues.csv has one row a source residue, with units") {
  const ScratchFolder folder;
  write(folder.file("out"));
  CHECK(read_file(folder.file("out.residues.csv")) ==
        "chain,residue_number,insertion_code,residue_name,area [A^2],trusted_area_fraction,"
        "mean_abs_difference [kT/e],mean_signed_difference [kT/e],"
        "mean_source [kT/e],mean_target [kT/e],sign_change_area_fraction,mean_displacement [A],mean_path_length [A],"
        "own_difference [kT/e],own_area [A^2],mean_slip [A],slip_area_fraction\n"
        "A,7,,ALA,6,1,1,-1,2,1,0.5,1,2,-1.5,5,0.25,0\n"
        "A,7,B,GLY,4,0.5,2,2,0,2,0,1.5,3,2.5,4,3.5,0.5\n"
        ",9,,LYS,0,,,,,,,,,,,,\n");
}

TEST_CASE("OUT.vtp has the arrays of the contract") {
  const ScratchFolder folder;
  write(folder.file("out"));
  const std::string text = read_file(folder.file("out.vtp"));
  for (const char* name :
       {"source_position", "potential_source", "potential_target", "potential_difference", "sign_change",
        "displacement", "path_length", "normal", "source_normal", "residue_number", "corrupt"}) {
    CHECK_MESSAGE(text.find("Name=\"" + std::string(name) + "\"") != std::string::npos, name);
  }
  // Bytes of an array: after its length, where its offset says.
  const auto block = [&](const char* name, std::size_t n_bytes) {
    const std::size_t offset = text.find("offset=\"", text.find("Name=\"" + std::string(name) + "\"")) + 8;
    const std::size_t start = text.find('_', text.find("<AppendedData")) + 1 + std::stoul(text.substr(offset));
    return text.substr(start + sizeof(std::uint64_t), n_bytes);
  };
  // +1 to -1 changes sign; -1 to -3 does not; 0 to -2 does not, zero agrees with anything; nor does what lies outside a
  // map.
  CHECK(block("sign_change", 4) == std::string("\1\0\0\0", 4));
  CHECK(block("corrupt", 4) == std::string("\0\0\1\0", 4));
  float difference[4];
  std::memcpy(difference, block("potential_difference", sizeof difference).data(), sizeof difference);
  CHECK(difference[0] == -2.0F);
  CHECK(difference[2] == -2.0F);
  CHECK(std::isnan(difference[3]));
  std::int32_t number[4];
  std::memcpy(number, block("residue_number", sizeof number).data(), sizeof number);
  CHECK(number[1] == 7);
  CHECK(number[2] == 9);
  CHECK(number[3] == 0);
}

TEST_CASE("without potentials OUT.vtp has no potential arrays, and the table's columns are empty") {
  const ScratchFolder folder;
  CompareResult result = made_result();
  result.potential.compared = false;
  result.potential.unit = PotentialUnit::kUnknown;
  result.surface.potential_source.clear();
  result.surface.potential_target.clear();
  write(folder.file("out"), result);
  CHECK(read_file(folder.file("out.vtp")).find("potential") == std::string::npos);
  CHECK(read_file(folder.file("out.residues.csv")).find("\nA,7,,ALA,6,1,,,,,,1,2,,,0.25,0\n") != std::string::npos);
}

TEST_CASE("all files of a result appear, or none") {
  for (const char* taken : {"out.json", "out.vtp", "out.residues.csv"}) {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.file(taken));
    const std::string message = message_of([&] { write(folder.file("out")); });
    CHECK(message == folder.file(taken) + ": cannot write: this is a folder; name a file in it");
    CHECK(folder.n_files() == 1);
  }
  const ScratchFolder folder;
  write(folder.file("out"));
  CHECK(folder.n_files() == 3);
  CHECK(message_of([&] { write(folder.file("no/out")); }).find("does not exist; create it first") != std::string::npos);
  CHECK(folder.n_files() == 3);
}

TEST_CASE("a result that contradicts itself is not written over an older one") {
  const ScratchFolder folder;
  write(folder.file("out"));
  const std::string before = read_file(folder.file("out.json"));
  CompareResult broken = made_result();
  broken.rmsd_A = 9;
  broken.surface.displacement.pop_back();
  CHECK(message_of([&] { write(folder.file("out"), broken); }) ==
        "surface file: the array displacement has 3 entries for 4 points");
  CHECK(read_file(folder.file("out.json")) == before);
  CHECK(folder.n_files() == 3);
}

TEST_CASE("the table gives the verdict with its reasons, and units") {
  CompareResult result = made_result();
  std::string table = made_table(result);
  for (const char* part :
       {"a.pqr", "3 atoms, by sequence alignment (1 of 3 residues substituted)", "RMSD", "kT/e", "A^2",
        "converged after 42 iterations", "NOT TRUSTWORTHY:\n  - 12.5 % of the mapped area is corrupt",
        "Intersecting pairs of triangles", "Not checked", "something else"}) {
    CHECK_MESSAGE(table.find(part) != std::string::npos, part, " not in\n", table);
  }
  CHECK(table.find("nan") == std::string::npos);
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(line.size() <= 100, line);

  result.certificate.trustworthy = true;
  result.certificate.reasons.clear();
  result.certificate.trusted.source = 0.95;
  result.certificate.trusted.target = 1;
  result.certificate.untrusted_parts = {"GLY 7B of chain A (12 A^2): slipped off its atoms"};
  table = made_table(result);
  CHECK(table.find("\nTRUSTWORTHY: the numbers rest on 95 % of the source's surface and 100 % of the target's\n") !=
        std::string::npos);
  CHECK(table.find("NOT TRUSTWORTHY") == std::string::npos);
  CHECK(table.find("Not trusted:") == std::string::npos);

  result.certificate.trusted.source = 0.839;
  table = made_table(result);
  CHECK(table.find("\nTRUSTWORTHY ON 83 %: the numbers rest on 83.9 % of the source's surface") != std::string::npos);
  CHECK(table.find("\nNot trusted:\n  - GLY 7B of chain A (12 A^2): slipped off its atoms\n") != std::string::npos);

  result.potential.compared = false;
  table = made_table(result);
  CHECK(table.find("Shape (no potentials)") != std::string::npos);
  CHECK(table.find("kT/e") == std::string::npos);
}
