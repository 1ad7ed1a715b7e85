// metrics.cpp: the table of metrics: its names, values and units, and that OUT.json and the printed table show each
// row.
#include "report/records/metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "certificate/result.h"
#include "options/options.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/residue_values.h"
#include "report/sections/provenance.h"

using namespace espdiff;
using OrderedJson = nlohmann::ordered_json;

namespace {

/// Where every metric has a value.
CompareResult full_result() {
  CompareResult result;
  result.potential.compared = true;
  result.alignment.pairing.pairs = {{0, 0}, {1, 1}, {2, 2}};
  result.potential.unit = PotentialUnit::kKtPerE;
  result.certificate.round_trip = RoundTrip{0.1, 0.2, 0.3, 0.04};
  result.certificate.slip = SlipSummary{0.5, 0.3, 1.5, 4, 0.04, 0.02, 0.01};
  result.certificate.residues = ResidueCheck{0.95, 0.1, 2, 30};
  result.certificate.turned = {0.13, 0.4, {"LYS 118 of chain A"}};
  result.residues = {{{6, 1, -1, 2, 1, 0.5}, 0, 1, 2}, {{4, 2, 2, 0, 2, 0}, 1, 1.5, 3}};
  return result;
}

Molecule two_residues() {
  Molecule molecule;
  molecule.name = "two";
  molecule.residues.resize(2);
  return molecule;
}

OrderedJson json_of(const CompareResult& result) {
  return compare_json(two_residues(), two_residues(), result, {}, {});
}

std::string table_of(const CompareResult& result) {
  std::ostringstream out;
  print_table(out, json_of(result));
  return out.str();
}

}  // namespace

TEST_CASE("names and places in OUT.json are unique, and every row has a label, help and a value") {
  std::set<std::string> names, pointers;
  for (const Metric& metric : metrics()) {
    CAPTURE(metric.name);
    CHECK(names.insert(metric.name).second);
    CHECK(std::string(metric.label).size() > 3);
    CHECK(std::string(metric.help).size() > 10);
    const bool has_value = metric.has_result() || metric.has_residues();
    CHECK(has_value);
    if (metric.has_result()) CHECK(pointers.insert(metric.json_pointer()).second);
    CHECK(find_metric_or_null(metric.name) == &metric);
  }
  CHECK(find_metric_or_null("no_such_metric") == nullptr);
}

TEST_CASE("OUT.json and the printed table have every metric") {
  const CompareResult result = full_result();
  const OrderedJson json = json_of(result);
  const std::string table = table_of(result);
  for (const Metric& metric : metrics()) {
    CAPTURE(metric.name);
    if (!metric.has_result()) continue;
    REQUIRE(json.contains(OrderedJson::json_pointer(metric.json_pointer())));
    const OrderedJson& value = json.at(OrderedJson::json_pointer(metric.json_pointer()));
    CHECK(value.is_number());
    CHECK(value.get<double>() == value_of(metric, result));
    CHECK(value.is_number_integer() == (metric.unit == MetricUnit::kCount));
    if (metric.section == MetricSection::kMapping) continue;  // is told in words
    CHECK(table.find(*metric.line != '\0' ? metric.line : metric.label) != std::string::npos);
    CHECK(table.find(metric.word) != std::string::npos);
  }
}

TEST_CASE("what was not checked is null as a whole, and has no line") {
  CompareResult result = full_result();
  CHECK(table_of(result).find("Round-trip error") != std::string::npos);
  result.certificate.round_trip.reset();
  result.certificate.not_checked = {"round_trip"};
  CHECK(json_of(result)["certificate"]["round_trip"].is_null());
  CHECK(table_of(result).find("Round-trip error") == std::string::npos);
  CHECK(table_of(result).find("Not checked") != std::string::npos);
}

TEST_CASE("the residues' metrics are those of the table, the path length among them") {
  const CompareResult result = full_result();
  const std::vector<std::string> quantities = residue_quantities();
  CHECK(quantities == std::vector<std::string>{"share", "contribution", "area_A2", "trusted_area_fraction",
                                               "mean_abs_difference", "mean_signed_difference", "mean_source",
                                               "mean_target", "sign_change_area_fraction", "mean_displacement_A",
                                               "mean_path_length_A", "own_difference", "own_area_A2", "mean_slip_A",
                                               "slip_area_fraction"});
  CHECK(residue_values(result, "mean_path_length_A") == std::vector<double>{2, 3});
  CHECK(residue_unit(result, "mean_path_length_A") == "A");
  CHECK(residue_unit(result, "mean_source") == "kT/e");
  CHECK(residue_unit(result, "sign_change_area_fraction").empty());
  const std::vector<double> areas = residue_values(result, "area_A2");
  const std::vector<double> differences = residue_values(result, "mean_abs_difference");
  const std::vector<double> shares = residue_values(result, "share");
  CHECK(shares[0] + shares[1] == doctest::Approx(1));
  CHECK(shares[0] * areas[1] * differences[1] == doctest::Approx(shares[1] * areas[0] * differences[0]));
}

TEST_CASE("units and formats follow from the kind of a metric") {
  const auto shown = [](const char* name, double value) {
    const Metric& metric = *find_metric_or_null(name);
    return formatted(metric, value) + "|" + unit_of(metric, "mV") + "|" + shown_unit(metric, "mV").unit;
  };
  CHECK(shown("rms_difference", 1.23456) == "1.235|mV|mV");
  CHECK(shown("corrupt_area_fraction", 0.01234) == "1.23 %||%");
  CHECK(shown("area_mapped_A2", 1234.56) == "1234.6|A^2|A^2");
  CHECK(shown("iterations", 24) == "24||");
  CHECK(shown("hodgkin_index", std::nan("")) == "-||");
}

TEST_CASE("without potentials the numbers of the shape come from the residues") {
  CompareResult result = full_result();
  result.potential.compared = false;
  CHECK(value_of(*find_metric_or_null("mean_displacement_A"), result) == doctest::Approx(1.2));
  CHECK(value_of(*find_metric_or_null("mean_path_length_A"), result) == doctest::Approx(2.4));
  CHECK(value_of(*find_metric_or_null("area_A2"), result) == 10);
  CHECK(std::isnan(value_of(*find_metric_or_null("hodgkin_index"), result)));
  CHECK(std::isnan(value_of(*find_metric_or_null("mean_source"), result, result.residues[0])));
  result.residues.clear();
  CHECK(std::isnan(value_of(*find_metric_or_null("mean_displacement_A"), result)));
}

TEST_CASE("lines that are zero by construction say so, and what was removed stands below them") {
  CompareResult result = full_result();
  CHECK(json_of(result)["certificate"]["zero_by_construction"].empty());
  CHECK(table_of(result).find("by construction") == std::string::npos);
  result.certificate.zero_by_construction = true;
  result.certificate.removed = {0.02, 0.003, 0.0004, 0.01, 0.05, 0.06};
  const OrderedJson certificate = json_of(result)["certificate"];
  CHECK(certificate["zero_by_construction"] ==
        OrderedJson({"corrupt_area_fraction", "flipped_area_fraction", "self_intersecting_pairs"}));
  CHECK(certificate["removed"]["torn"] == 0.02);
  CHECK(certificate["removed"]["grown"] == 0.06);
  const std::string table = table_of(result);
  for (const char* const text :
       {"  Corrupt area                                       0 %  by construction, see Removed\n",
        "  Flipped area                                       0 %  by construction, see Removed\n",
        "  Intersecting pairs of triangles                      0  by construction, see Removed\n",
        "  Removed of the source as                      torn 2 %", "crossing 0.3 %", "flipped 0.04 %",
        "    or for its place, as                     corrupt 1 %", "far 5 %", "grown 6 %\n"}) {
    CAPTURE(std::string(text));
    CHECK(table.find(text) != std::string::npos);
  }
}

TEST_CASE("warnings and reasons end within 100 columns") {
  CompareResult result = full_result();
  std::string names;
  for (int i = 1; i < 60; ++i) names += (i == 1 ? "" : ", ") + std::string("residue ") + std::to_string(i);
  result.inputs.warnings.push_back({"much differs: " + names, true});
  result.certificate.reasons.push_back("much differs: " + names);
  const std::string table = table_of(result);
  std::istringstream lines(table);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  CHECK(longest <= 100);
  const std::size_t begin = table.find("  - much differs: residue 1, residue 2");
  REQUIRE(begin != std::string::npos);
  const std::string second = table.substr(table.find('\n', begin) + 1, 11);
  CHECK(second == "    residue");
  CHECK(table.find("residue 59\n", begin) != std::string::npos);
}
