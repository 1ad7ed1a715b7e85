// matrix.cpp: pairs and shards, the same bits as one comparison, results, and runs that are interrupted or in parts.
#include "matrix/matrix.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "io/files/read_csv.h"
#include "matrix/made_variants.h"
#include "matrix/write_matrix.h"
#include "options/options.h"
#include "prepare/surface_radii.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::Matrix;
using espdiff::MatrixCell;
using espdiff::MatrixPair;
using espdiff::MatrixReport;
using espdiff::MatrixRun;
using espdiff::Progress;
using espdiff::Variant;

namespace {

MatrixRun run_to(const std::string& output) {
  MatrixRun run;
  run.output = output;
  run.potential = "maps";
  return run;
}

/// Stops itself at the n-th report that begins a pair.
struct Stopper {
  int n_left;
  std::string seen;
  std::unique_ptr<Progress> progress;
  explicit Stopper(int n) : n_left(n) {
    progress = std::make_unique<Progress>([this](const std::string& stage, double) {
      const std::string pair = stage.substr(0, stage.find(' ', 5));
      if (pair != seen && --n_left < 0) progress->request_cancel();
      seen = pair;
    });
  }
};

}  // namespace

TEST_SUITE_BEGIN("matrix");

TEST_CASE("pairs go source by source without the diagonal, and shards part them evenly") {
  const auto all = espdiff::matrix_pairs(3);
  CHECK(all == std::vector<MatrixPair>{{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}});
  CHECK(espdiff::matrix_pairs(1).empty());
  CHECK(
      message_of([] {
        espdiff::matrix_pairs(1000000);
      }).find("a matrix of 1000000 variants, of whose 999999000000 ordered pairs this run has 999999000000: needs ") ==
      0);
  for (const int count : {1, 2, 5, 7, 42, 50}) {
    std::vector<MatrixPair> joined;
    std::set<std::size_t> sizes;
    for (int index = 1; index <= count; ++index) {
      const auto part = espdiff::matrix_pairs(7, {index, count});
      sizes.insert(part.size());
      joined.insert(joined.end(), part.begin(), part.end());
    }
    CHECK(joined == espdiff::matrix_pairs(7));
    CHECK(*sizes.rbegin() - *sizes.begin() <= 1);
  }
}

TEST_CASE("a shard is i/n and nothing else") {
  const auto shard = espdiff::parse_shard("2/8");
  CHECK(shard.index == 2);
  CHECK(shard.count == 8);
  for (const char* wrong : {"", "2", "0/4", "5/4", "a/4", "1/0", "1/4/2", "-1/4"})
    CHECK_MESSAGE(contains(message_of([&] { espdiff::parse_shard(wrong); }), "is not i/n"), wrong);
}

TEST_CASE("every cell holds the bits of the comparison of its pair") {
  const auto engine = cpu_engine();
  const std::vector<Variant> variants = made_variants(3);
  std::size_t n = 0;
  espdiff::compute_pairs(*engine, variants, matrix_options(), espdiff::matrix_pairs(3), false,
                         [&](const MatrixCell& cell) {
                           const Variant &a = variants[cell.source], &b = variants[cell.target];
                           const CompareResult alone =
                               compare(*engine, {&a.molecule, &*a.map}, {&b.molecule, &*b.map}, matrix_options(), {});
                           for (std::size_t m = 0; m < espdiff::matrix_metrics().size(); ++m) {
                             INFO(espdiff::matrix_metrics()[m].name);
                             CHECK(cell.values[m] == value_of(espdiff::matrix_metrics()[m], alone));
                           }
                           CHECK(cell.trustworthy == alone.certificate.trustworthy);
                           CHECK(cell.reasons.size() == alone.certificate.reasons.size());
                           ++n;
                         },
                         {});
  CHECK(n == 6);
}

TEST_CASE("pairs by several threads are handed over in order, with the bits and the error of one after the other") {
  std::vector<Variant> variants = made_variants(4);
  const std::vector<MatrixPair> pairs = espdiff::matrix_pairs(4);
  const auto cells_by = [&](int n_threads, std::vector<MatrixCell>& cells) {
    return message_of([&] {
      espdiff::compute_pairs(*cpu_engine(n_threads), variants, matrix_options(), pairs, false,
                             [&](const MatrixCell& cell) { cells.push_back(cell); }, {});
    });
  };
  std::vector<MatrixCell> one, three;
  cells_by(1, one);
  cells_by(3, three);
  REQUIRE(one.size() == pairs.size());
  REQUIRE(three.size() == pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    CHECK(MatrixPair(three[p].source, three[p].target) == pairs[p]);
    for (std::size_t m = 0; m < one[p].values.size(); ++m) {
      const double a = one[p].values[m], b = three[p].values[m];
      CHECK((a == b || (std::isnan(a) && std::isnan(b))));
    }
    CHECK(one[p].reasons == three[p].reasons);
  }
  variants[2].map->lattice.origin += Vec3d{500, 0, 0};  // covers nothing
  std::vector<MatrixCell> before_one, before_three;
  const std::string error = cells_by(1, before_one);
  CHECK(contains(error, "v0 to v2: "));
  CHECK(cells_by(3, before_three) == error);
  CHECK(before_one.size() == 1);
  CHECK(before_three.size() == 1);
}

TEST_CASE("pairs that other threads have finished are kept when a run is cancelled") {
  const ScratchFolder folder;
  const auto engine = cpu_engine(3);
  const std::vector<Variant> variants = made_variants(4);
  run_matrix(*engine, variants, matrix_options(), run_to(folder.file("whole")), {});
  MatrixRun run = run_to(folder.file("stopped"));
  Stopper stopper(2);
  const std::string message =
      message_of([&] { run_matrix(*engine, variants, matrix_options(), run, *stopper.progress); });
  CHECK(contains(message, "of 12 pairs, which "));
  CHECK(contains(message, "resume continues"));
  run.resume = true;
  const MatrixReport report = run_matrix(*engine, variants, matrix_options(), run, {});
  CHECK(contains(message, "cancelled after " + std::to_string(report.n_resumed) + " of 12 pairs"));
  CHECK(report.n_resumed >= 2);
  CHECK(read_file(folder.file("stopped.csv")) == read_file(folder.file("whole.csv")));
  CHECK(read_file(folder.file("stopped.json")) == read_file(folder.file("whole.json")));
}

TEST_CASE("a variant whose radii are of another force field changes no cell but its own, which are its pairs'") {
  const auto engine = cpu_engine();
  std::vector<Variant> variants = made_variants(3);
  for (Variant& variant : variants) variant.molecule.radii_origin = espdiff::ValueOrigin::kFile;
  for (float& radius : variants[2].molecule.radii) radius *= 1.1F;
  const CompareOptions options = matrix_options();
  const auto cells_of = [&](std::size_t n) {
    std::vector<MatrixCell> cells;
    const std::vector<Variant> some(variants.begin(), variants.begin() + static_cast<long>(n));
    espdiff::compute_pairs(*engine, some, options, espdiff::matrix_pairs(n), false,
                           [&](const MatrixCell& cell) { cells.push_back(cell); }, {});
    return cells;
  };
  const std::vector<MatrixCell> two = cells_of(2), three = cells_of(3);
  const std::string note =
      "the radii of the structures are of different force fields; both surfaces take Bondi's radii by element";
  for (const MatrixCell& cell : three) {
    const bool differs = cell.source == 2 || cell.target == 2;
    CHECK((std::find(cell.warnings.begin(), cell.warnings.end(), note) != cell.warnings.end()) == differs);
    Variant a = variants[cell.source], b = variants[cell.target];
    const std::string because = espdiff::set_surface_radii({&a.molecule, &b.molecule}, options.input.radii);
    CHECK(because.empty() != differs);
    const CompareResult alone = compare(*engine, {&a.molecule, &*a.map}, {&b.molecule, &*b.map}, options, {});
    for (std::size_t m = 0; m < espdiff::matrix_metrics().size(); ++m)
      CHECK(cell.values[m] == value_of(espdiff::matrix_metrics()[m], alone));
  }
  for (const MatrixCell& cell : two) {
    const auto same = std::find_if(three.begin(), three.end(), [&](const MatrixCell& other) {
      return other.source == cell.source && other.target == cell.target;
    });
    CHECK(cell.values == same->values);
  }
}

TEST_CASE("a cell has what its states' preparation left doubtful among its warnings") {
  const auto engine = cpu_engine();
  std::vector<Variant> variants = made_variants(2);
  variants[1].origin.preparation.emplace();
  variants[1].origin.preparation->gaps = {"between GLY 10 and ALA 15 of chain A"};
  std::vector<MatrixCell> cells;
  espdiff::compute_pairs(*engine, variants, matrix_options(), {{0, 1}, {1, 0}}, false,
                         [&](const MatrixCell& cell) { cells.push_back(cell); }, {});
  REQUIRE(cells.size() == 2);
  const std::string text =
      " lacks residues between GLY 10 and ALA 15 of chain A; they are not modelled, and chain ends there stay "
      "uncharged";
  CHECK(std::count(cells[0].warnings.begin(), cells[0].warnings.end(), "the target" + text) == 1);
  CHECK(std::count(cells[1].warnings.begin(), cells[1].warnings.end(), "the source" + text) == 1);
}

TEST_CASE("a pair that cannot be compared stops the run, or becomes a cell with the reason") {
  const auto engine = cpu_engine();
  std::vector<Variant> variants = made_variants(3);
  variants[1].map->lattice.origin += Vec3d{500, 0, 0};  // covers nothing
  std::vector<MatrixCell> cells;
  const auto keep = [&](const MatrixCell& cell) { cells.push_back(cell); };
  const std::string message = message_of(
      [&] { espdiff::compute_pairs(*engine, variants, matrix_options(), espdiff::matrix_pairs(3), false, keep, {}); });
  CHECK(contains(message, "v0 to v1: "));
  CHECK(contains(message, "does not cover"));
  cells.clear();
  espdiff::compute_pairs(*engine, variants, matrix_options(), espdiff::matrix_pairs(3), true, keep, {});
  REQUIRE(cells.size() == 6);
  for (const MatrixCell& cell : cells) {
    const bool fails = cell.source == 1 || cell.target == 1;
    CHECK(cell.error.empty() != fails);
    CHECK(std::isnan(cell.values[1]) == fails);
    CHECK((fails && cell.trustworthy) == false);
  }
}

TEST_CASE("shapes alone: metrics of potentials have no values, and variants cluster by displacement") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  std::vector<Variant> variants = made_variants(3);
  for (Variant& v : variants) v.map.reset();
  const MatrixReport report = run_matrix(*engine, variants, matrix_options(), run_to(folder.file("m")), {});
  const auto json = nlohmann::json::parse(read_file(folder.file("m.json")));
  CHECK(json["potential"] == "");
  CHECK(json["hodgkin"].is_null());
  CHECK(json["metrics"]["mean_abs_difference"]["values"][0][1].is_null());
  CHECK(json["metrics"]["mean_displacement_A"]["values"][0][1].get<double>() > 0);
  CHECK(json["clustering"]["metric"] == "mean_displacement_A");
}

TEST_CASE("an interrupted run continues and writes the same bytes; so do parts that are merged") {
  const ScratchFolder folder;
  const auto engine = cpu_engine(1);  // pairs one after the other, so that the fifth is the last
  const std::vector<Variant> variants = made_variants(4);
  run_matrix(*engine, variants, matrix_options(), run_to(folder.file("whole")), {});
  const std::string csv = read_file(folder.file("whole.csv")), json = read_file(folder.file("whole.json"));
  CHECK_FALSE(std::filesystem::exists(folder.file("whole.state")));

  MatrixRun run = run_to(folder.file("stopped"));
  Stopper stopper(5);
  const std::string message =
      message_of([&] { run_matrix(*engine, variants, matrix_options(), run, *stopper.progress); });
  CHECK(contains(message, "cancelled after 5 of 12 pairs"));
  CHECK_FALSE(std::filesystem::exists(folder.file("stopped.csv")));
  CHECK(contains(message_of([&] { run_matrix(*engine, variants, matrix_options(), run, {}); }), "resume continues"));
  run.resume = true;
  const MatrixReport report = run_matrix(*engine, variants, matrix_options(), run, {});
  CHECK(report.n_resumed == 5);
  CHECK(report.n_pairs == 12);
  CHECK(read_file(folder.file("stopped.csv")) == csv);
  CHECK(read_file(folder.file("stopped.json")) == json);

  std::vector<std::string> parts;
  for (const int index : {3, 1, 2}) {
    MatrixRun part = run_to(folder.file("part"));
    part.shard = {index, 3};
    const MatrixReport of_part = run_matrix(*engine, variants, matrix_options(), part, {});
    CHECK(of_part.n_pairs == 4);
    CHECK_FALSE(of_part.matrix.has_value());
    parts.insert(parts.end(), of_part.files.begin(), of_part.files.end());
  }
  merge_matrix(parts, run_to(folder.file("merged")));
  CHECK(read_file(folder.file("merged.csv")) == csv);
  CHECK(read_file(folder.file("merged.json")) == json);
  CHECK(contains(message_of([&] {
                   merge_matrix({parts[0], parts[1]}, run_to(folder.file("two")));
                 }),
                 parts[0] + " and 1 more file: 4 of 12 pairs are missing, the first v1 to v2; resume the shard"));
  CHECK(contains(message_of([&] { merge_matrix(parts, run_to(folder.file("merged"))); }), "overwrite replaces it"));
  // A part of a run with another setting.
  MatrixRun other = run_to(folder.file("other"));
  other.shard = {2, 3};
  CompareOptions finer = matrix_options();
  finer.deform.rho = 0.4;
  parts[2] = run_matrix(*engine, variants, finer, other, {}).files[0];
  const std::string refusal = message_of([&] { merge_matrix(parts, run_to(folder.file("mixed"))); });
  CHECK(contains(refusal, "a part of another matrix"));
  CHECK(contains(refusal, "the setting rho is 0.4 there and 0.3 here"));
}

TEST_CASE("the files say what the cells say") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  const Matrix matrix = *run_matrix(*engine, made_variants(4), matrix_options(), run_to(folder.file("m")), {}).matrix;
  const auto json = nlohmann::json::parse(read_file(folder.file("m.json")));
  const auto table = espdiff::read_csv(folder.file("m.csv"));
  REQUIRE(table.rows.size() == 12);
  const std::size_t hodgkin = espdiff::find_metric("hodgkin_index");
  for (std::size_t row = 0; row < 12; ++row) {
    const MatrixCell& cell = matrix.cells[row];
    CHECK(table.rows[row][0] == "v" + std::to_string(cell.source));
    CHECK(table.rows[row][3] == std::string(1, static_cast<char>('A' + cell.target / 2)));
    CHECK(table.number(row, table.require("hodgkin_index")) == doctest::Approx(cell.values[hodgkin]).epsilon(1e-5));
    CHECK(json["metrics"]["hodgkin_index"]["values"][cell.source][cell.target] == cell.values[hodgkin]);
    CHECK(json["trustworthy"][cell.source][cell.target] == cell.trustworthy);
  }
  CHECK(json["metrics"]["rmsd_A"]["unit"] == "A");
  CHECK(json["metrics"]["rms_difference"]["unit"] == "kT/e");
  CHECK(json["metrics"]["rmsd_A"]["values"][2][2].is_null());
  CHECK(json["variants"][3]["group"] == "B");
  CHECK(json["clustering"]["order"].size() == 4);
  CHECK(json["hodgkin"]["correlation"].get<double>() <= 1);
  CHECK(json["not_trustworthy"].size() ==
        static_cast<std::size_t>(std::count_if(matrix.cells.begin(), matrix.cells.end(),
                                               [](const MatrixCell& c) { return !c.trustworthy; })));
}

TEST_CASE("asymmetry, distances and groups of a matrix made by hand") {
  Matrix matrix;
  for (const char* label : {"a", "b", "c"}) matrix.plan.variants.push_back({label, "", {}});
  matrix.plan.variants[0].group = matrix.plan.variants[2].group = "G";
  const double rms[] = {1, 4, 3, 6, 4, 6}, sign[] = {1, 2, -1, 5, -2, -3};
  const std::size_t metric = espdiff::find_metric("rms_difference"),
                    signed_metric = espdiff::find_metric("mean_signed_difference");
  for (std::size_t p = 0; p < 6; ++p) {
    MatrixCell cell;
    cell.source = espdiff::matrix_pairs(3)[p].first;
    cell.target = espdiff::matrix_pairs(3)[p].second;
    cell.values.assign(espdiff::matrix_metrics().size(), 0.0);
    cell.values[metric] = rms[p];
    cell.values[signed_metric] = sign[p];
    cell.trustworthy = p == 1;
    matrix.cells.push_back(cell);
  }
  const auto a = espdiff::asymmetry(matrix, metric);  // |1 - 3|, 0, 0 over a mean of 4
  CHECK(a.max == doctest::Approx(0.5));
  CHECK(a.mean == doctest::Approx(0.5 / 3));
  CHECK(a.first == 0);
  CHECK(a.second == 1);
  const auto s = espdiff::asymmetry(matrix, signed_metric);  // 0, 0, |5 - 3| over a mean of 14 / 6
  CHECK(s.max == doctest::Approx(2 / (14.0 / 6)));
  CHECK(s.second == 2);
  const auto d = espdiff::symmetric_distances(matrix, metric);
  CHECK(d[0 * 3 + 1] == 2);
  CHECK(d[2 * 3 + 0] == 4);
  CHECK(d[1 * 3 + 1] == 0);
  CHECK(espdiff::symmetric_distances(matrix, signed_metric)[1 * 3 + 2] == 4);
  matrix.cells[0].values[espdiff::find_metric("hodgkin_index")] = 0.5;
  matrix.cells[2].values[espdiff::find_metric("hodgkin_index")] = 0.5;
  CHECK(espdiff::symmetric_distances(matrix, espdiff::find_metric("hodgkin_index"))[1] == doctest::Approx(1));
  const auto groups = espdiff::group_means(matrix, metric);
  REQUIRE(groups.size() == 1);
  CHECK(groups[0].n == 2);
  CHECK(groups[0].mean == 4);
  CHECK(groups[0].n_trustworthy == 1);
}

TEST_SUITE_END();
