// amber_frames.cpp: columns of twelve; and the variables of Amber's NetCDF conventions.
#include "io/structures/amber_frames.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/files/file_kind.h"
#include "io/molecules/molecule_builder.h"
#include "io/text/column_lines.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

constexpr std::size_t kColumn = 12;  // characters

/// Edges of 1 A and less stand for none.
std::optional<UnitCell> cell_of(const std::vector<double>& edges, const std::vector<double>& angles) {
  if (edges.size() != 3 || angles.size() != 3 || !(*std::min_element(edges.begin(), edges.end()) > 1)) return {};
  return UnitCell{{edges[0], edges[1], edges[2]}, {angles[0], angles[1], angles[2]}};
}

}  // namespace

AmberRestart::AmberRestart(const FileContent& file) : path_(file.path) {
  ColumnLines lines{file.content};
  lines.next();
  long long count = 0;
  parse_integer(split_words(lines.next()).front(), count);  // recognise() has seen it
  const auto n_atoms = static_cast<std::size_t>(count);
  if (n_atoms > kMostAtoms)
    throw FormatError(path_, lines.number,
                      "the number of atoms is " + std::to_string(n_atoms) + ", and at most " +
                          std::to_string(kMostAtoms) + " are read");
  std::vector<double> numbers;
  const auto cut = [&] {
    throw FormatError(path_, lines.number,
                      "this Amber restart ends after " + std::to_string(numbers.size()) + " numbers, and " +
                          std::to_string(3 * n_atoms) +
                          " coordinates were expected, or as many velocities behind them; copy or write the file "
                          "again");
  };
  while (!lines.rest.empty()) {
    const std::string_view line = lines.next(), text = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    for (std::size_t at = 0; at < text.size(); at += kColumn) {
      const std::string_view field = trimmed(text.substr(at, kColumn));
      double number = 0;
      if (!parse_number(field, number))
        throw FormatError(path_, lines.number,
                          "a number of this Amber restart is " + in_quotes(field) +
                              "; six in columns of twelve were expected: write the file again, as NetCDF if the "
                              "molecule is far from the origin");
      numbers.push_back(number);
    }
    if (numbers.size() > 6 * n_atoms + 6)
      throw FormatError(path_, lines.number,
                        "this Amber restart has more numbers than coordinates, velocities and cell of its " +
                            std::to_string(n_atoms) + " atoms; is the number of atoms in its second line right?");
  }
  const std::size_t n_more = numbers.size() % (3 * n_atoms);
  if (numbers.size() < 3 * n_atoms || (n_more != 0 && n_more != 3 && n_more != 6)) cut();
  for (std::size_t i = 0; i < n_atoms; ++i)
    frame_.positions.push_back({static_cast<float>(numbers[3 * i]), static_cast<float>(numbers[3 * i + 1]),
                                static_cast<float>(numbers[3 * i + 2])});
  const std::vector<double> cell(numbers.end() - static_cast<std::ptrdiff_t>(n_more), numbers.end());
  if (n_more == 3) frame_.cell = cell_of(cell, {90, 90, 90});
  if (n_more == 6) frame_.cell = cell_of({cell.begin(), cell.begin() + 3}, {cell.begin() + 3, cell.end()});
}

AmberNetcdf::AmberNetcdf(ByteSource source) : file_(std::move(source)), coordinates_(file_.find("coordinates")) {
  if (coordinates_ == nullptr || coordinates_->lengths.size() != 2 || coordinates_->lengths[1] != 3)
    throw FormatError(path(), 0,
                      "this NetCDF file has no coordinates of atoms by Amber's conventions; give an Amber trajectory "
                      "or restart");
  const auto unit = coordinates_->notes.find("units");
  if (unit != coordinates_->notes.end() && lower_case(unit->second).substr(0, 8) != "angstrom")
    throw FormatError(path(), 0,
                      "its coordinates have the unit " + in_quotes(unit->second) + "; Angstrom was expected");
  if (coordinates_->lengths[0] == 0 || coordinates_->lengths[0] > kMostAtoms)
    throw FormatError(path(), 0,
                      "its frames have " + std::to_string(coordinates_->lengths[0]) + " atoms; 1 to " +
                          std::to_string(kMostAtoms) + " were expected");
  const std::size_t n = coordinates_->has_records ? file_.n_records() : 1;
  if (n < 1) throw FormatError(path(), 0, "holds no whole frame; copy or write the file again");
  n_frames_ = static_cast<int>(std::min<std::size_t>(n, std::numeric_limits<int>::max()));
}

const CoordinateFrame& AmberNetcdf::frame(int number) {
  if (held_ == number) return frame_;
  held_ = -1;
  const auto record = static_cast<std::size_t>(number);
  const std::vector<double> x = file_.read(*coordinates_, record);
  frame_.positions.resize(x.size() / 3);
  for (std::size_t i = 0; i < frame_.positions.size(); ++i)
    frame_.positions[i] = {static_cast<float>(x[3 * i]), static_cast<float>(x[3 * i + 1]),
                           static_cast<float>(x[3 * i + 2])};
  const NetcdfVariable *const edges = file_.find("cell_lengths"), *const angles = file_.find("cell_angles");
  frame_.cell.reset();
  if (edges != nullptr && angles != nullptr)
    frame_.cell = cell_of(file_.read(*edges, record), file_.read(*angles, record));
  held_ = number;
  return frame_;
}

std::unique_ptr<CoordinateFile> amber_frames(FileContent file) {
  if (recognise(file.content) == FileKind::kAmberRestart) return std::make_unique<AmberRestart>(file);
  return std::make_unique<AmberNetcdf>(bytes_of_text(file.path, std::move(file.content)));
}

}  // namespace espdiff
