// fields.cpp: fields as cells of a matrix: a pair's numbers, resumed and in parts, given values, and what is refused.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "field/field.h"
#include "field/given_values.h"
#include "io/files/read_csv.h"
#include "matrix/made_variants.h"
#include "matrix/matrix_table.h"
#include "options/options.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;
using espdiff::MatrixCell;
using espdiff::MatrixReport;
using espdiff::MatrixRun;
using espdiff::Variant;

namespace {

/// Values of the made molecule's residues, which are numbered from 1.
std::string residue_table(double slope) {
  std::string text = "chain,residue_number,value\n";
  for (int r = 1; r <= 6; ++r) text += "A," + std::to_string(r) + "," + std::to_string(slope * r) + "\n";
  return text;
}

CompareOptions options_with(std::vector<espdiff::FieldRequest> fields) {
  CompareOptions options = matrix_options();
  options.fields = std::move(fields);
  return options;
}

std::vector<Variant> variants_with(std::size_t n, const CompareOptions& options) {
  std::vector<Variant> variants = made_variants(n);
  set_fields(variants, options);
  return variants;
}

MatrixRun fields_run(const std::string& output) {
  MatrixRun run;
  run.output = output;
  run.potential = "maps";
  return run;
}

std::string refusal(std::size_t n, const CompareOptions& options) {
  return message_of([&] { variants_with(n, options); });
}

}  // namespace

TEST_SUITE_BEGIN("matrix fields");

TEST_CASE("a cell has the bits of the comparison of its pair, for each field") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  const CompareOptions options =
      options_with({{"charge", "charge"}, {"slope", "residues:" + folder.write("slope.csv", residue_table(0.5))}});
  const std::vector<Variant> variants = variants_with(3, options);
  const auto compared = espdiff::parts_and_fields(options);
  const auto& metrics = espdiff::matrix_metrics(compared);
  std::size_t n = 0;
  espdiff::compute_pairs(
      *engine, variants, options, espdiff::matrix_pairs(3), false,
      [&](const MatrixCell& cell) {
        const Variant &a = variants[cell.source], &b = variants[cell.target];
        const CompareResult alone = compare(*engine, {&a.molecule, &*a.map}, {&b.molecule, &*b.map}, options, {});
        REQUIRE(cell.values.size() == metrics.size());
        for (std::size_t m = 0; m < metrics.size(); ++m) {
          INFO(metrics[m].name);
          CHECK(cell.values[m] == value_of(metrics[m], alone));
        }
        CHECK(cell.values[find_metric("charge_mean_abs_difference", compared)] > 0);
        CHECK(cell.values[find_metric("slope_area_A2", compared)] > 0);
        ++n;
      },
      {});
  CHECK(n == 6);
}

TEST_CASE("files tell the fields; a resumed run and merged parts have the same bytes, and another table is refused") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  const std::string table = folder.write("slope.csv", residue_table(0.5));
  const CompareOptions options = options_with({{"charge", "charge"}, {"slope", "residues:" + table}});
  const std::vector<Variant> variants = variants_with(3, options);
  MatrixRun run = fields_run(folder.file("whole"));
  run.cluster_by = "slope_mean_abs_difference";
  const MatrixReport whole = run_matrix(*engine, variants, options, run, {});
  const std::string csv = read_file(folder.file("whole.csv")), text = read_file(folder.file("whole.json"));
  const auto json = nlohmann::json::parse(text);
  CHECK(json["clustering"]["metric"] == "slope_mean_abs_difference");
  CHECK(json["fields"]["slope"]["files"][0]["path"] == table);
  CHECK(json["fields"]["charge"]["unit"] == "e");
  CHECK(json["metrics"]["charge_mean_abs_difference"]["unit"] == "e");
  CHECK(json["metrics"]["slope_correlation"]["values"][0][1].get<double>() > 0.5);
  CHECK(espdiff::read_csv(folder.file("whole.csv")).find("charge_hodgkin_index") >= 0);
  std::ostringstream printed;
  print_matrix(printed, *whole.matrix, metric_to_cluster_by(run, *whole.matrix));
  CHECK(contains(printed.str(), "Mean absolute difference, slope"));

  std::vector<std::string> parts;
  for (const int index : {2, 1}) {
    MatrixRun part = fields_run(folder.file("part"));
    part.shard = {index, 2};
    part.resume = true;
    parts.push_back(run_matrix(*engine, variants, options, part, {}).files[0]);
    const std::string before = read_file(parts.back());
    CHECK(run_matrix(*engine, variants, options, part, {}).n_resumed == 3);
    CHECK(read_file(parts.back()) == before);
  }
  MatrixRun merged = fields_run(folder.file("merged"));
  merged.cluster_by = run.cluster_by;
  merge_matrix(parts, merged);
  CHECK(read_file(folder.file("merged.csv")) == csv);
  CHECK(read_file(folder.file("merged.json")) == text);

  folder.write("slope.csv", residue_table(0.75));
  MatrixRun other = fields_run(folder.file("part"));
  other.shard = {1, 2};
  other.resume = true;
  CHECK(contains(message_of([&] { run_matrix(*engine, variants_with(3, options), options, other, {}); }),
                 "the file of the field slope has changed"));
}

TEST_CASE("each variant may have a table of its own, and comes with values of its own") {
  const ScratchFolder folder;
  for (int i = 0; i < 3; ++i) folder.write("v" + std::to_string(i) + ".csv", residue_table(1 + i));
  const CompareOptions options =
      options_with({{"own", "residues:" + folder.file("{label}.csv")}, {"given", "given:flex"}});
  std::vector<Variant> variants = made_variants(3);
  for (Variant& variant : variants) {
    auto given = std::make_shared<espdiff::GivenValues>(variant.molecule);
    std::vector<float> values(variant.molecule.size(), 1.0F + static_cast<float>(variant.label.back() - '0'));
    given->add("flex", values);
    variant.fields.given = given;
  }
  set_fields(variants, options);
  CHECK(variants[2].inputs.back().role == "field own");
  CHECK(variants[2].inputs.back().path == folder.file("v2.csv"));
  CHECK((*variants[2].fields.made)[0].atoms.back() == doctest::Approx(18));  // the sixth residue
  const auto engine = cpu_engine();
  const auto compared = espdiff::parts_and_fields(options);
  espdiff::compute_pairs(*engine, variants, options, {{0, 2}, {2, 1}}, false,
                         [&](const MatrixCell& cell) {  // constants differ by the difference of the labels
                           const double d = static_cast<double>(cell.target) - static_cast<double>(cell.source);
                           const std::size_t signed_mean = find_metric("given_mean_signed_difference", compared);
                           CHECK(cell.values[signed_mean] == doctest::Approx(d).epsilon(1e-6));
                           CHECK(std::isnan(cell.values[find_metric("given_correlation", compared)]));
                         },
                         {});
}

TEST_CASE("what one variant lacks, and files that variants cannot share, are refused before the work") {
  const ScratchFolder folder;
  const std::string table = folder.write("a.csv", residue_table(1)), map = folder.write("a.dx", "");
  CHECK(refusal(2, options_with({{"b-factor", "b-factor"}})).rfind("v0: field b-factor: the variant (", 0) == 0);
  CHECK(contains(refusal(2, options_with({{"given", "given:user"}})),
                 "comes without values; the field given:user is of"));
  CHECK(
      contains(refusal(2, options_with({{"t", "residues:" + table + "," + table}})),
               "names a file for the source and one for the target, and here are many states; give one for all, or one "
               "for each by a place in its name ({label}, {group})"));
  CHECK(contains(refusal(2, options_with({{"w", "map:" + map}})),
                 "each variant needs a map of its own, in its place; name them by the label, as in map:{label}.dx"));
  CHECK(contains(refusal(2, options_with({{"own", "residues:" + folder.file("{label}.csv")}})), "v0.csv"));
  CHECK(contains(refusal(2, options_with({{"own", "residues:" + folder.file("%d.csv")}})),
                 "has the place %d, which is the number of a frame; this state is none"));
}

TEST_SUITE_END();
