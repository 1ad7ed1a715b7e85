// cause_lines.cpp: OUT.json's causes against the rows of OUT.causes.csv, which holds all contributions.
#include "verify/cause_lines.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "verify/mapped_file.h"

namespace espdiff {
namespace {

/// Of the largest of a column: numbers of tables have six digits.
constexpr double kDigits = 1e-5;

/// The rows of one reading.
class CauseRows {
 public:
  CauseRows(const CsvTable& table, const std::string& reading) : table_(table) {
    const std::size_t name = at("reading");
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      if (table.rows[r][name] == reading) rows_.push_back(r);
    }
  }
  std::size_t size() const { return rows_.size(); }
  double number(std::size_t row, const char* column) const { return table_.number(rows_[row], at(column)); }
  const std::string& text(std::size_t row, const char* column) const { return table_.rows[rows_[row]][at(column)]; }
  double sum(const char* column) const {
    double all = 0;
    for (std::size_t r = 0; r < size(); ++r) all += number(r, column);
    return all;
  }
  double largest(const char* column) const {
    double most = 1e-12;
    for (std::size_t r = 0; r < size(); ++r) most = std::max(most, std::fabs(number(r, column)));
    return most;
  }

 private:
  std::size_t at(const std::string& name) const {
    for (std::size_t k = 0; k < table_.columns.size(); ++k) {
      if (table_.columns[k] == name || table_.columns[k].rfind(name + " [", 0) == 0) return k;
    }
    return table_.require(name);
  }
  const CsvTable& table_;
  std::vector<std::size_t> rows_;
};

/// Numbers that are the same, or both none.
bool same_number(double a, double b, double tolerance) {
  return (std::isnan(a) && std::isnan(b)) || std::fabs(a - b) <= tolerance;
}

/// "LYS 118", with its chain where there are several; what is not compared has its name alone.
bool is_name_of(const std::string& text, const CauseRows& rows, std::size_t r) {
  const std::string &name = rows.text(r, "residue_name"), &number = rows.text(r, "residue_number");
  if (number.empty()) return text == name;
  const std::string alone = name + " " + number + rows.text(r, "insertion_code");
  return text == alone || text == alone + " " + rows.text(r, "chain");
}

/// How many fields of OUT.json's largest contributions the table has otherwise.
double wrong_contributions(const ResultRecord& record, const std::string& reading, const CauseRows& rows) {
  const std::size_t n = record.size(reading + "/largest");
  double wrong = n == std::min<std::size_t>(rows.size(), 30) ? 0 : 1;
  const auto json_number = [&](const std::string& name) { return record.number(name).value_or(std::nan("")); };
  for (std::size_t r = 0; r < std::min(n, rows.size()); ++r) {
    const std::string one = reading + "/largest/" + std::to_string(r) + "/";
    for (const auto& [name, column] :
         {std::pair("chain", "chain"), std::pair("insertion_code", "insertion_code"), std::pair("name", "residue_name"),
          std::pair("kind", "kind"), std::pair("detail", "detail")})
      wrong += record.text(one + name) == rows.text(r, column) ? 0 : 1;
    for (const auto& [name, column] :
         {std::pair("source", "source"), std::pair("target", "target"), std::pair("difference", "difference"),
          std::pair("distance_A", "distance"), std::pair("moved_A", "moved"),
          std::pair("place/source/relative_b", "relative_b_source"),
          std::pair("place/target/relative_b", "relative_b_target"),
          std::pair("place/source/occupancy", "occupancy_source"),
          std::pair("place/target/occupancy", "occupancy_target")})
      wrong += same_number(json_number(one + name), rows.number(r, column), kDigits * rows.largest(column)) ? 0 : 1;
    if (!rows.text(r, "residue_number").empty())
      wrong += json_number(one + "number") == rows.number(r, "residue_number") ? 0 : 1;
    wrong += is_name_of(record.text(one + "residue"), rows, r) ? 0 : 1;
    // A state without the residue has null for its place.
    for (const char* state : {"source", "target"}) {
      const std::string occupancy = rows.text(r, (std::string("occupancy_") + state).c_str());
      wrong += record.number(one + "place/" + state) || (occupancy.empty() && record.size(one + "place/" + state) > 0)
                   ? 1
                   : 0;
    }
    for (const char* flag : {"has_alternates", "is_rebuilt"}) {
      const bool either = record.flag(one + "place/source/" + flag) || record.flag(one + "place/target/" + flag);
      wrong += rows.text(r, flag) == (either ? "1" : "0") ? 0 : 1;
    }
    wrong += rows.text(r, "poorly_known") == (record.flag(one + "poorly_known") ? "1" : "0") ? 0 : 1;
  }
  return wrong;
}

void add_kinds_of_causes(const ResultRecord& record, const std::string& reading, const CauseRows& rows,
                         double tolerance, Lines& lines) {
  std::map<std::string, std::pair<double, double>> kinds;  // difference, number of residues
  double poorly_known = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    auto& kind = kinds[rows.text(r, "kind")];
    kind.first += rows.number(r, "difference");
    ++kind.second;
    if (rows.text(r, "poorly_known") == "1") poorly_known += rows.number(r, "difference");
  }
  const std::size_t n = record.size(reading + "/by_kind");
  lines.add_deviation(reading + "/by_kind, kinds that differ", n == kinds.size() ? 0 : 1, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const std::string one = reading + "/by_kind/" + std::to_string(k);
    const auto& [difference, n_residues] = kinds[record.text(one + "/kind")];
    lines.add(one + "/difference", difference, tolerance);
    lines.add(one + "/n_residues", n_residues, 0);
    lines.cover(one + "/kind");
  }
  if (record.number(reading + "/poorly_known")) lines.add(reading + "/poorly_known", poorly_known, tolerance);
}

void add_lines_of_reading(const ResultRecord& record, const std::string& reading, const CsvTable& table, Lines& lines) {
  const CauseRows rows(table, record.text(reading + "/reading"));
  lines.cover(reading + "/reading");
  lines.add_text(reading + "/unit", record.text("potential_unit"), "potential_unit");
  const double tolerance = kDigits * std::max(rows.largest("source"), rows.largest("target")) *
                           std::sqrt(1.0 + static_cast<double>(rows.size()));
  lines.add(reading + "/n_residues", static_cast<double>(rows.size()), 0);
  lines.add(reading + "/sum_of_contributions/source", rows.sum("source"), tolerance);
  lines.add(reading + "/sum_of_contributions/target", rows.sum("target"), tolerance);
  lines.add(reading + "/difference",
            record.number(reading + "/target").value_or(0) - record.number(reading + "/source").value_or(0), tolerance);
  double largest = 0;
  for (std::size_t r = 0; r < rows.size(); ++r)
    largest = std::max(largest,
                       std::fabs(rows.number(r, "target") - rows.number(r, "source") - rows.number(r, "difference")));
  lines.add_deviation(reading + ", target less source of a row, largest deviation", largest, tolerance);
  add_kinds_of_causes(record, reading, rows, tolerance, lines);
  lines.add_deviation(reading + "/largest, fields that OUT.causes.csv has otherwise",
                      wrong_contributions(record, reading, rows), 0);
  lines.cover(reading + "/largest");
}

}  // namespace

void add_cause_lines(const std::string& prefix, const ResultRecord& record, Lines& lines) {
  const std::string path = prefix + ".causes.csv";
  const std::size_t n = record.size("causes");
  std::error_code ignored;
  if (n == 0 && !std::filesystem::exists(path, ignored)) return;
  const CsvTable table = read_csv(path);
  if (n == 0) {
    lines.has("OUT.causes.csv");
    lines.explain("OUT.causes.csv", "OUT.json has no causes, so that the file is of an earlier result");
    return;
  }
  for (std::size_t k = 0; k < n; ++k) add_lines_of_reading(record, "causes/" + std::to_string(k), table, lines);
  for (const std::string& name : table.columns) lines.cover("OUT.causes.csv/" + name.substr(0, name.find(" [")));
}

}  // namespace espdiff
