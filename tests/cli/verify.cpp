// verify.cpp: `espdiff verify` agrees with 20 real comparisons, finds a wrong number wherever it stands, and refuses
// damaged files.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/bent_row.h"
#include "cli/run_espdiff.h"
#include "io/read_csv.h"

using namespace espdiff_test;
using espdiff::CsvTable;
using espdiff::read_csv;
using OrderedJson = nlohmann::ordered_json;

namespace {

void write_file(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// Sets up a comparison of a small protein's models in a folder of its own; empty prefix without real inputs.
struct SmallResult {
  ScratchFolder folder;
  std::string prefix;

  /// @param options empty: nothing is compared
  explicit SmallResult(const std::string& options = "--potential none") {
    if (options.empty()) return;
    const auto file = real_input("nmr/1l2y.pdb");
    if (!file) return;
    prefix = folder.file("result");
    const Outcome compared =
        run_espdiff("compare " + *file + " " + *file + " --target-model 5 " + options + " -q --exit-zero -o " + prefix);
    REQUIRE(compared.status == 0);
  }
  OrderedJson record() const { return OrderedJson::parse(read_file(prefix + ".json")); }
  void set(const char* pointer, const OrderedJson& value) const {
    OrderedJson json = record();
    REQUIRE(json.contains(OrderedJson::json_pointer(pointer)));
    json[OrderedJson::json_pointer(pointer)] = value;
    write_file(prefix + ".json", json.dump(2));
  }
  Outcome verified() const { return run_espdiff("verify " + prefix); }
};

bool differs(const Outcome& outcome, const std::string& name) {
  std::size_t at = outcome.out.find("\n" + name + " ");
  if (at == std::string::npos) return false;
  const std::string line = outcome.out.substr(at + 1, outcome.out.find('\n', at + 1) - at - 1);
  return contains(line, "DIFFERS");
}

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

/// Two bent rows of atoms in vacuum: small, with potentials.
struct RowResult : SmallResult {
  RowResult() : SmallResult("") {
    prefix = folder.file("row");
    write_file(folder.file("a.pqr"), bent_row(0, 12));
    write_file(folder.file("b.pqr"), bent_row(0.6, 12));
    REQUIRE(run_espdiff("compare " + folder.file("a.pqr") + " " + folder.file("b.pqr") +
                        " --potential coulomb --device cpu -q -o " + prefix)
                .status == 0);
  }
  /// Whether a wrong file fails, or the report names what is wrong.
  bool finds(const std::string& name) const {
    const Outcome outcome = verified();
    return outcome.status != 0 || is_named(not_recomputed(outcome), name);
  }
};

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

TEST_CASE("20 real comparisons are verified") {
  const auto models = real_input("nmr/1l2y.pdb"), ph2 = real_input("pqr_pdb2pqr/1AJJ_pH2_AMBER.pqr"),
             ph7 = real_input("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr"), ph14 = real_input("pqr_pdb2pqr/1AJJ_pH14_AMBER.pqr"),
             m00 = real_input("series19_ubq_2k39/m00.pqr"), m07 = real_input("series19_ubq_2k39/m07.pqr"),
             hiv = real_input("pairs/1hhp.pdb"), other_hiv = real_input("pairs/3phv.pdb"),
             aaf = real_input("pairs/1aaf.pdb"), tim = real_input("pair_tim_maps/scTIM_chainA.pqr"),
             mutant = real_input("pair_tim_maps/dTIM_chainA.pqr");
  if (!models || !ph2 || !ph7 || !ph14 || !m00 || !m07 || !hiv || !other_hiv || !aaf || !tim || !mutant) return;
  std::vector<std::string> pairs;
  for (const char* const options : {"2", "9 --method deform", "17", "23 --align backbone", "31", "38 --domains auto"})
    pairs.push_back(*models + " " + *models + " --potential none --target-model " + options);
  pairs.push_back(*models + " " + *models + " --source-model 7 --target-model 21 --potential none --cavities");
  pairs.push_back(*models + " " + *models + " --source-model 3 --target-model 30 --potential none --grid-spacing 0.7");
  for (const char* const options : {"", "--method deform", "--offset 1.4", "--offset 0,3"}) {
    pairs.push_back(*ph2 + " " + *ph7 + " --potential coulomb " + options);
    pairs.push_back(*ph14 + " " + *ph7 + " --potential coulomb " + options);
  }
  pairs.push_back(*m00 + " " + *m07 + " --potential none");
  pairs.push_back(*aaf + " " + *aaf + " --target-model 10 --potential none");  // far, mapped twice, not trustworthy
  pairs.push_back(*hiv + " " + *other_hiv + " --potential none");
  pairs.push_back(*tim + " " + *mutant + " --source-map " + *real_input("pair_tim_maps/scTIM_chainA_pot-PE0.dx") +
                  " --target-map " + *real_input("pair_tim_maps/dTIM_chainA_pot-PE0.dx") +
                  " --source-map-unit kT/e --target-map-unit kT/e");
  CHECK(pairs.size() == 20);
  const ScratchFolder folder;
  const std::string prefix = folder.file("result");
  for (const std::string& pair : pairs) {
    CAPTURE(pair);
    const Outcome compared = run_espdiff("compare " + pair + " -q --exit-zero --overwrite -o " + prefix);
    REQUIRE(compared.status == 0);
    const Outcome verified = run_espdiff("verify " + prefix);
    CAPTURE(verified.out);
    CAPTURE(verified.err);
    CHECK(verified.status == 0);
    CHECK(contains(verified.out, "\nVERIFIED: "));
    CHECK_FALSE(contains(verified.out, "DIFFERS"));
  }
}

TEST_CASE("each leaf of OUT.json is found wrong, or named as not recomputed") {
  const RowResult result;
  const OrderedJson right = result.record(), leaves = right.flatten();
  const Outcome unchanged = result.verified();
  CAPTURE(unchanged.out);
  REQUIRE(unchanged.status == 0);
  const std::vector<std::string> names = not_recomputed(unchanged);
  for (const char* name : {"time_ms", "options", "warnings", "inputs/0/role"}) CHECK(is_named(names, name));
  CHECK_FALSE(is_named(names, "mean_abs_difference"));
  CHECK_FALSE(is_named(names, "certificate/slip/mean_A"));
  // Those with a line of their own are changed together: each line must differ.
  OrderedJson wrong = right;
  std::vector<std::string> with_line, alone;
  for (const auto& entry : leaves.items()) {
    const std::string leaf = entry.key().substr(1);
    if (is_named(names, leaf)) continue;
    const bool has_line = contains(unchanged.out, "\n" + leaf + " ");
    (has_line ? with_line : alone).push_back(leaf);
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
  CHECK(alone.size() > 20);
  // A number that is gone.
  wrong = right;
  wrong["certificate"]["irregularity_A"] = nullptr;
  write_file(result.prefix + ".json", wrong.dump(2));
  CHECK(differs(result.verified(), "certificate/irregularity_A"));
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
  const std::string table_path = result.prefix + ".residues.csv";
  const CsvTable table = read_csv(table_path);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::string text;
    for (std::size_t k = 0; k < table.columns.size(); ++k) text += (k > 0 ? "," : "") + table.columns[k];
    for (const auto& row : table.rows) {
      text += '\n';
      for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + (k == c ? "1" + row[k] : row[k]);
    }
    write_file(table_path, text + "\n");
    const std::string name = table.columns[c].substr(0, table.columns[c].find(" ["));
    CHECK_MESSAGE(result.finds("OUT.residues.csv/" + name), name);
  }
}

TEST_CASE("coarse lattices are verified: tolerances follow from the spacing") {
  const ScratchFolder folder;
  write_file(folder.file("a.pqr"), bent_row(0, 12));
  write_file(folder.file("b.pqr"), bent_row(0.6, 12));
  for (const char* const spacing : {"0.7", "1.5", "1.8"}) {
    const std::string prefix = folder.file(std::string("s") + spacing);
    REQUIRE(run_espdiff("compare " + folder.file("a.pqr") + " " + folder.file("b.pqr") +
                        " --potential none --device cpu -q --grid-spacing " + spacing + " -o " + prefix)
                .status == 0);
    const Outcome verified = run_espdiff("verify " + prefix);
    CAPTURE(verified.out);
    CHECK(verified.status == 0);
  }
}

TEST_CASE("a wrong number in OUT.vtp or OUT.residues.csv is found") {
  const SmallResult result;
  if (result.prefix.empty()) return;
  const std::string right = read_file(result.prefix + ".vtp");
  // The arrays stand in binary, one after the other, each behind its length.
  const std::size_t data = right.find("encoding=\"raw\"");
  REQUIRE(data != std::string::npos);
  const auto offset_of = [&](const std::string& name) {
    const std::size_t at = right.find("Name=\"" + name + "\"");
    return right.find('_', data) + 1 + 8 + std::stoul(right.substr(right.find("offset=\"", at) + 8));
  };
  const auto with_number = [&](const std::string& array, std::size_t place, float value) {
    std::string text = right;
    std::memcpy(&text[offset_of(array) + place * sizeof value], &value, sizeof value);
    write_file(result.prefix + ".vtp", text);
    return result.verified();
  };
  Outcome verified = with_number("slip", 100, 50.0F);
  CAPTURE(verified.out);
  CHECK(verified.status == 1);
  CHECK(differs(verified, "certificate/slip/max_A"));
  verified = with_number("displacement", 100, 4.5F);
  CHECK(differs(verified, "displacement at the vertices, largest deviation"));
  std::string text = right;
  const double away = 100;
  std::memcpy(&text[offset_of("Points") + 24 * 100], &away, sizeof away);  // one vertex lies elsewhere
  write_file(result.prefix + ".vtp", text);
  verified = result.verified();
  CHECK(verified.status == 1);
  CHECK(differs(verified, "area_A2/mapped"));
  CHECK(differs(verified, "certificate/mapped_to_target_A/max"));

  write_file(result.prefix + ".vtp", right);
  const std::string path = result.prefix + ".residues.csv";
  std::string table = read_file(path);
  const std::size_t second_row = table.find('\n') + 1, area = table.find("ASN,", second_row) + 4;
  table.insert(area, "9");
  write_file(path, table);
  CHECK(differs(result.verified(), "OUT.residues.csv, area"));
}

TEST_CASE("damaged results are refused with the file and the remedy") {
  const SmallResult result;
  if (result.prefix.empty()) return;
  const std::string json = result.prefix + ".json", vtp = result.prefix + ".vtp";
  const std::string right = read_file(json), surface = read_file(vtp);
  const auto refused = [&](const std::string& text) {
    const Outcome verified = result.verified();
    CAPTURE(verified.err);
    CHECK(verified.status == 2);
    CHECK(contains(verified.err, text));
    CHECK(n_lines(verified.err) == 1);
  };
  write_file(json, right.substr(0, right.size() / 2));
  refused(json + ": is not JSON, or is cut off; compare again");
  write_file(json, "[1, 2]");
  refused(json + ": is not the record of a comparison: it has no certificate, or no inputs; compare again");
  write_file(json, R"({"certificate": {}, "inputs": {}})");
  refused(json + ": is not the record of a comparison: it has no certificate, or no inputs; compare again");
  write_file(json, right);
  result.set("/superposition/paired_atoms", OrderedJson::array({OrderedJson::array({0, 0, 100000})}));
  refused(json + ": superposition/paired_atoms names atoms that the structures lack; compare again");
  result.set("/superposition/paired_atoms", OrderedJson::array({OrderedJson::array({0, -1, 2})}));
  refused(json + ": superposition/paired_atoms has an entry that is not three whole numbers; compare again");
  write_file(json, right);
  result.set("/inputs/0/sha256", "abc");
  refused("has changed since the comparison; compare again");
  write_file(json, right);

  std::string without_slip = surface;
  without_slip.replace(without_slip.find("Name=\"slip\""), 11, "Name=\"slap\"");
  write_file(vtp, without_slip);
  refused(vtp + ": has no array \"slip\", which a comparison writes; compare again");
  write_file(vtp, surface.substr(0, surface.size() / 2));
  refused(vtp);
  write_file(vtp, surface);
  CHECK(result.verified().status == 0);

  const Outcome absent = run_espdiff("verify " + result.folder.file("nothing"));
  CHECK(absent.status == 2);
  CHECK(contains(absent.err, "give the prefix of a result: OUT of OUT.json and OUT.vtp"));
}

TEST_SUITE_END();
