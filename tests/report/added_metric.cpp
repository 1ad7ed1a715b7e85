// added_metric.cpp: a metric that is added to the table as CONTRIBUTING shows it is in every file and table. A program
// of its own, since the columns of files are fixed once they were used.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "certificate/result.h"
#include "matrix/matrix_table.h"
#include "matrix/write_matrix.h"
#include "options/options.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/records/metrics.h"
#include "report/residue_values.h"
#include "report/write_compare.h"
#include "support/test_data.h"
#include "support/text.h"
#include "trajectory/series_csv.h"

using namespace espdiff;
using espdiff_test::contains;
using espdiff_test::read_file;
using espdiff_test::ScratchFolder;

namespace {

double shrinkage(const espdiff::MeasuredSurface& result) {
  return 1 - result.area_mapped_A2 / result.source_surface.area_A2;
}

/// What CONTRIBUTING asks for.
const Metric kShrinkage{"shrinkage_fraction",
                        "Shrinkage",
                        MetricSection::kShape,
                        MetricUnit::kFraction,
                        kInSeries | kInMatrix,
                        "Share of the source's area that the mapping lost",
                        shrinkage};
const Metric kTravel{"travel_A",
                     "Travel",
                     MetricSection::kShape,
                     MetricUnit::kAngstrom,
                     0,
                     "The way once more",
                     {&Metrics::mean_path_length_A, &ResidueRow::mean_path_length_A}};
const bool kAdded = [] {
  add_metric(kShrinkage);
  add_metric(kTravel);
  return true;
}();

Molecule one_residue(const char* name) {
  Molecule molecule;
  molecule.name = name;
  molecule.residues.resize(1);
  molecule.residues[0].name = "ALA";
  return molecule;
}

CompareResult result_of(double mapped_area) {
  CompareResult result;
  result.source_surface.area_A2 = 10;
  result.area_mapped_A2 = mapped_area;
  result.time_ms = {{"total", 1.0}};
  result.residues = {{{6, 0, 0, 0, 0, 0}, 0, 1, 2.5}};
  return result;
}

/// The fields of the last line under the names of the first that is no comment.
std::string field(const std::string& csv, const std::string& column) {
  std::istringstream lines(csv);
  std::string line, names, last;
  while (std::getline(lines, line)) {
    if (line.empty() || line[0] == '#') continue;
    (names.empty() ? names : last) = line;
  }
  std::istringstream columns(names), fields(last);
  std::string name, value;
  while (std::getline(columns, name, ',')) {
    std::getline(fields, value, ',');
    if (name == column) return value;
  }
  return "no column " + column + " in " + names;
}

}  // namespace

TEST_CASE("the added metric is in OUT.json, the printed table and the residues' files") {
  REQUIRE(kAdded);
  const ScratchFolder folder;
  const Molecule source = one_residue("a"), target = one_residue("b");
  const CompareResult result = result_of(7.5);
  CHECK(compare_json(source, target, result, {}, {})["shrinkage_fraction"] == 0.25);
  CHECK(compare_json(source, target, result, {}, {})["travel_A"] == 2.5);
  std::ostringstream table;
  print_table(table, compare_json(source, target, result, {}, {}));
  CHECK(contains(table.str(), "Shrinkage"));
  CHECK(contains(table.str(), "25 %"));
  write_compare(folder.file("out"), source, target, result, {}, {});
  CHECK(field(read_file(folder.file("out.residues.csv")), "travel [A]") == "2.5");
  CHECK(residue_values(result, "travel_A") == std::vector<double>{2.5});
}

TEST_CASE("the added metric is a column of a trajectory") {
  const Molecule source = one_residue("a"), target = one_residue("b");
  const auto& columns = series_columns();
  CHECK(std::count(columns.begin(), columns.end(), "shrinkage_fraction") == 1);
  CHECK(std::count(columns.begin(), columns.end(), "travel_A") == 0);
  const SeriesRow row(3, "first", source, target, result_of(7.5), {});
  CHECK(row["shrinkage_fraction"] == "0.25");
}

TEST_CASE("the added metric is a table of a matrix, and can be clustered by") {
  const ScratchFolder folder;
  const std::size_t added = find_metric("shrinkage_fraction");
  Matrix matrix;
  matrix.plan.variants = {{"a", "", {}}, {"b", "", {}}};
  for (const auto& [source, target] : matrix_pairs(2)) {
    MatrixCell cell;
    cell.source = source;
    cell.target = target;
    for (const Metric& metric : matrix_metrics())
      cell.values.push_back(value_of(metric, result_of(source == 0 ? 9 : 8)));
    matrix.cells.push_back(cell);
  }
  const auto json = matrix_json(matrix, added);
  CHECK(json["metrics"]["shrinkage_fraction"]["title"] == "Shrinkage");
  CHECK(json["metrics"]["shrinkage_fraction"]["values"][1][0].get<double>() == doctest::Approx(0.2));
  CHECK(json["clustering"]["metric"] == "shrinkage_fraction");
  write_matrix(folder.file("m"), matrix, added);
  CHECK(std::stod(field(read_file(folder.file("m.csv")), "shrinkage_fraction")) == doctest::Approx(0.2));
  std::ostringstream table;
  print_matrix(table, matrix, added);
  CHECK(contains(table.str(), "Shrinkage"));
}

TEST_CASE("a name is there once") { CHECK_THROWS_AS(add_metric(kShrinkage), Error); }
