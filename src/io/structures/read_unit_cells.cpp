// read_unit_cells.cpp: CRYST1 records, model by model, and NAMD's .xsc files.
#include "io/structures/read_unit_cells.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "io/files/read_input.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

struct CellLine {
  long number;
  std::optional<UnitCell> cell;
};

/// Lengths in three fields of 9 columns, angles in three of 7, as the PDB format has it.
CellLine read_cell_line(std::string_view line, long number, const std::string& path) {
  constexpr std::size_t kStart = 6, kLength = 9, kAngle = 7;
  double values[6];
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t at = i < 3 ? kStart + i * kLength : kStart + 3 * kLength + (i - 3) * kAngle;
    const std::string_view field = at < line.size() ? trimmed(line.substr(at, i < 3 ? kLength : kAngle)) : "";
    if (!parse_number(field, values[i]))
      throw FormatError(path, number,
                        "the CRYST1 record's " + std::string(i < 3 ? "length" : "angle") + " is " + in_quotes(field) +
                            "; three lengths of 9 columns and three angles of 7 were expected");
  }
  if (std::min({values[0], values[1], values[2]}) <= 1) return {number, std::nullopt};
  return {number, UnitCell{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}}};
}

std::vector<CellLine> find_cell_lines(std::string_view text, const std::string& path) {
  std::vector<CellLine> cells;
  long number = 1;
  for (std::size_t start = 0; start < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = text.substr(start, end - start);
    if (line.substr(0, 6) == "CRYST1") cells.push_back(read_cell_line(line, number, path));
    start = end + 1;
  }
  return cells;
}

}  // namespace

std::vector<std::optional<UnitCell>> read_unit_cells(std::string_view text, const std::vector<AtomModel>& models,
                                                     const std::string& path) {
  const std::vector<CellLine> lines = find_cell_lines(text, path);
  std::vector<std::optional<UnitCell>> cells;
  std::optional<UnitCell> cell;
  std::size_t next = 0;  // models and lines are both in the order of the file
  for (const AtomModel& model : models) {
    if (model.empty()) {  // a model without atoms has none
      cells.emplace_back();
      continue;
    }
    for (; next < lines.size() && lines[next].number < model.front().number; ++next) cell = lines[next].cell;
    cells.push_back(cell);
  }
  return cells;
}

std::array<Vec3d, 4> read_xsc(const std::string& path) {
  const std::string text = read_text_file(path);
  std::vector<std::string> labels;
  std::map<std::string, double> values;
  TextCursor cursor(text, path);
  while (!cursor.at_end()) {
    const std::vector<std::string_view> words = split_words(cursor.rest_of_line());
    if (words.empty()) continue;
    if (words.front() == "#$LABELS") labels.assign(words.begin() + 1, words.end());
    if (words.front().front() == '#') continue;
    for (std::size_t i = 0; i < std::min(words.size(), labels.size()); ++i) {
      if (!parse_number(words[i], values[labels[i]]))
        cursor.fail("column " + labels[i] + " is " + in_quotes(words[i]) + "; a number was expected");
    }
  }
  std::array<Vec3d, 4> result;
  const char* const names[] = {"o", "a", "b", "c"};
  for (std::size_t v = 0; v < 4; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string label = std::string(names[v]) + '_' + "xyz"[axis];
      const auto found = values.find(label);
      if (found == values.end())
        throw FormatError(path, 0,
                          "no value for " + label +
                              "; an .xsc file has a line '#$LABELS step a_x ...' and one of "
                              "numbers");
      result[v][axis] = found->second;
    }
  }
  return result;
}

}  // namespace espdiff
