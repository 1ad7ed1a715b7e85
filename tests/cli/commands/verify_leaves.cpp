// verify_leaves.cpp: `espdiff verify` finds a wrong leaf of OUT.json, array of OUT.vtp or column of a table, or names
// it as not recomputed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/bent_row.h"
#include "cli/small_result.h"
#include "io/files/read_csv.h"

using namespace espdiff_test;
using espdiff::CsvTable;
using espdiff::read_csv;

namespace {

/// The names under "Not recomputed:".
std::vector<std::string> not_recomputed(const Outcome& outcome) {
  std::vector<std::string> names;
  for (std::size_t at = outcome.out.find("\n  - "); at != std::string::npos; at = outcome.out.find("\n  - ", at + 1)) {
    const std::string line = outcome.out.substr(at + 5, outcome.out.find(": ", at) - at - 5);
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(", ", begin), line.size());
      names.push_back(line.substr(begin, end - begin));
      begin = end + 2;
    }
  }
  return names;
}

bool is_named(const std::vector<std::string>& names, const std::string& leaf) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return leaf == name || leaf.compare(0, name.size() + 1, name + "/") == 0;
  });
}

/// Another value of the same kind.
OrderedJson other(const OrderedJson& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number_integer()) return value.get<int>() + 1;
  if (value.is_number()) return value.get<double>() + std::max(1.0, 0.5 * std::fabs(value.get<double>()));
  if (value.is_string()) return value.get<std::string>() + "x";
  return value.is_null() ? OrderedJson(7.5) : OrderedJson::array({"x"});
}

/// Two bent rows of atoms in two chains, in vacuum: small, with potentials.
struct RowResult : SmallResult {
  /// @param with_maps give the potentials as maps
  explicit RowResult(const std::string& options = "", bool with_maps = false) : SmallResult("") {
    prefix = folder.file("row");
    const std::string a = folder.write("a.pqr", two_chains(0)), b = folder.write("b.pqr", two_chains(0.3));
    std::string potentials = " --potential coulomb ";
    for (const std::string& state : {a, b}) {
      if (!with_maps) break;
      REQUIRE(run_espdiff("potential " + state + " --method coulomb -q -o " + state + ".dx").status == 0);
      potentials = " --source-map " + a + ".dx --target-map " + b + ".dx ";
    }
    const Outcome compared = run_espdiff("compare " + a + " " + b + potentials + options +
                                         " --device cpu --grid-spacing 1.5 -q --exit-zero --overwrite -o " + prefix);
    REQUIRE_MESSAGE(compared.status == 0, compared.err);
  }
  static std::string two_chains(double bend) {
    std::string text = bent_row(bend, 24);
    std::size_t at = 0;
    for (int n = 0; n < 24; ++n) {
      at = text.find("ALA A", at) + 4;
      if (n >= 12) text[at] = 'B';
    }
    return text;
  }
  /// Whether a wrong file fails, or the report names what is wrong.
  bool finds(const std::string& name) const {
    const Outcome outcome = verified();
    return outcome.status != 0 || is_named(not_recomputed(outcome), name);
  }
};

/// A leaf's place without the numbers of lists: "causes/#/unit".
std::string kind_of_leaf(const std::string& leaf) {
  std::string kind;
  for (const char c : leaf) {
    if (c < '0' || c > '9') {
      kind += c;
    } else if (kind.empty() || kind.back() != '#') {
      kind += '#';
    }
  }
  return kind;
}

/// Changes each leaf of OUT.json that is not named. Those with a line of their own are changed together: each line must
/// differ.
/// @param most of one kind, in long lists
void check_leaves(const RowResult& result, std::size_t most, std::size_t least_alone) {
  const OrderedJson right = result.record(), leaves = right.flatten();
  const Outcome unchanged = result.verified();
  CAPTURE(unchanged.out);
  REQUIRE(unchanged.status == 0);
  const std::vector<std::string> names = not_recomputed(unchanged);
  for (const char* name : {"time_ms", "options", "inputs/0/role"}) CHECK(is_named(names, name));
  CHECK_FALSE(is_named(names, "mean_abs_difference"));
  CHECK_FALSE(is_named(names, "certificate/slip/mean_A"));
  OrderedJson wrong = right;
  std::vector<std::string> with_line, alone;
  std::map<std::string, std::size_t> n_of_kind;
  for (const auto& entry : leaves.items()) {
    const std::string leaf = entry.key().substr(1);
    if (is_named(names, leaf)) continue;
    const bool has_line = contains(unchanged.out, "\n" + leaf + " ");
    if (has_line || ++n_of_kind[kind_of_leaf(leaf)] <= most) (has_line ? with_line : alone).push_back(leaf);
    const OrderedJson::json_pointer place(entry.key());
    if (has_line) wrong[place] = other(right[place]);
  }
  write_file(result.prefix + ".json", wrong.dump(2));
  const Outcome all_wrong = result.verified();
  CAPTURE(all_wrong.out);
  for (const std::string& leaf : with_line) CHECK_MESSAGE(differs(all_wrong, leaf), leaf);
  CHECK(with_line.size() > 60);
  for (const std::string& leaf : alone) {
    wrong = right;
    const OrderedJson::json_pointer place("/" + leaf);
    wrong[place] = other(right[place]);
    write_file(result.prefix + ".json", wrong.dump(2));
    CHECK_MESSAGE(result.finds(leaf), leaf);
  }
  CHECK(alone.size() > least_alone);
  write_file(result.prefix + ".json", right.dump(2));
}

/// Changes each column of a table in turn.
/// @param file "residues.csv"
void check_columns(const RowResult& result, const std::string& file) {
  const std::string path = result.prefix + "." + file, right = read_file(path);
  const CsvTable table = read_csv(path);
  REQUIRE(result.verified().status == 0);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::string text;
    for (std::size_t k = 0; k < table.columns.size(); ++k) text += (k > 0 ? "," : "") + table.columns[k];
    for (const auto& row : table.rows) {
      text += '\n';
      for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + (k == c ? "1" + row[k] : row[k]);
    }
    write_file(path, text + "\n");
    const std::string name = table.columns[c].substr(0, table.columns[c].find(" ["));
    CHECK_MESSAGE(result.finds("OUT." + file + "/" + name), name);
  }
  write_file(path, right);
}

/// Where each array of a VTP file lies, by name.
struct ArrayPlace {
  std::string name, type;
  std::size_t offset = 0, n = 0;
};

std::vector<ArrayPlace> arrays_of(const std::string& vtp) {
  std::vector<ArrayPlace> places;
  const std::size_t data = vtp.find('_', vtp.find("encoding=\"raw\"")) + 1;
  const auto attribute = [&](const char* name, std::size_t from) {
    const std::size_t at = vtp.find(std::string(name) + "=\"", from) + std::strlen(name) + 2;
    return vtp.substr(at, vtp.find('"', at) - at);
  };
  for (std::size_t at = vtp.find("<DataArray"); at != std::string::npos; at = vtp.find("<DataArray", at + 1)) {
    ArrayPlace place{attribute("Name", at), attribute("type", at), data + std::stoul(attribute("offset", at)), 0};
    std::uint64_t n_bytes = 0;
    std::memcpy(&n_bytes, &vtp[place.offset], sizeof n_bytes);
    place.offset += sizeof n_bytes;
    const std::size_t size = place.type == "UInt8" ? 1 : place.type == "Float32" || place.type == "Int32" ? 4 : 8;
    place.n = static_cast<std::size_t>(n_bytes) / size;
    places.push_back(place);
  }
  return places;
}

template <typename T>
void change(std::string& vtp, const ArrayPlace& place, const std::function<double(double)>& of) {
  for (std::size_t k = 0; k < place.n; ++k) {
    T value;
    std::memcpy(&value, &vtp[place.offset + k * sizeof value], sizeof value);
    value = static_cast<T>(of(static_cast<double>(value)));
    std::memcpy(&vtp[place.offset + k * sizeof value], &value, sizeof value);
  }
}

}  // namespace

TEST_SUITE_BEGIN("verify");

TEST_CASE("each leaf of OUT.json is found wrong, or named as not recomputed") {
  const RowResult result;
  check_leaves(result, 1000, 20);
  // A number that is gone.
  result.set("/certificate/irregularity_A", nullptr);
  CHECK(differs(result.verified(), "certificate/irregularity_A"));
}

TEST_CASE("each leaf of what options add is found wrong, or named; each column of OUT.causes.csv") {
  const RowResult result(
      "--causes whole --causes 'patch end' --region //A/1-8 --patch end=//B/15-20 --offset 0,1 --round-trip");
  check_leaves(result, 1, 30);
  check_columns(result, "causes.csv");
  // Rows that are gone, one twice, and a file that is of another result.
  const std::string path = result.prefix + ".causes.csv", right = read_file(path);
  write_file(path, right.substr(0, right.rfind('\n', right.size() - 2) + 1));
  CHECK(differs(result.verified(), "causes/1/n_residues"));
  write_file(path, right + right.substr(right.find('\n') + 1));
  CHECK(differs(result.verified(), "causes/0/sum_of_contributions/source"));
  write_file(path, right);
  result.set("/causes", OrderedJson::array());
  CHECK(is_named(not_recomputed(result.verified()), "OUT.causes.csv"));
}

TEST_CASE("each leaf of a result with given maps is found wrong, or named") {
  const RowResult result("--source-map-unit kT/e --target-map-unit kT/e", true);
  CHECK(result.record()["given_maps"]["source"].is_object());
  check_leaves(result, 1, 10);
}

TEST_CASE("each array of OUT.vtp and each column of OUT.residues.csv is found wrong, or named") {
  const RowResult result;
  const std::string path = result.prefix + ".vtp", right = read_file(path);
  const std::vector<ArrayPlace> places = arrays_of(right);
  CHECK(places.size() > 15);
  for (const ArrayPlace& place : places) {
    const bool is_real = place.type.compare(0, 5, "Float") == 0;
    for (int kind = 0; kind < (is_real ? 3 : 1); ++kind) {
      std::string wrong = right;
      const auto changed = [kind](double x) { return kind == 0 ? 1 - x : kind == 1 ? 0.0 : std::nan(""); };
      if (place.type == "Float64") change<double>(wrong, place, changed);
      if (place.type == "Float32") change<float>(wrong, place, changed);
      if (place.type == "Int32") change<std::int32_t>(wrong, place, changed);
      if (place.type == "Int64") change<std::int64_t>(wrong, place, changed);
      if (place.type == "UInt8") change<std::uint8_t>(wrong, place, changed);
      if (wrong == right) continue;
      write_file(path, wrong);
      CHECK_MESSAGE(result.finds("OUT.vtp/" + place.name), place.name << ", change " << kind);
    }
  }
  for (std::size_t at = right.find("type=\"String\""); at != std::string::npos;
       at = right.find("type=\"String\"", at + 1)) {
    std::string wrong = right;
    char& digit = wrong[wrong.find("ascii\">", at) + 7];
    digit = digit == '2' ? '3' : '2';
    write_file(path, wrong);
    CHECK_MESSAGE(result.finds("OUT.vtp/text"), wrong.substr(at, 80));
  }
  write_file(path, right);
  check_columns(result, "residues.csv");
}

TEST_SUITE_END();
