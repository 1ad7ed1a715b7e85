// pdb_text.cpp: column by column, what must be right in a PDB atom line.
#include "io/structures/formats/pdb_text.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

constexpr std::size_t kLeastWidth = 54;   // up to the z coordinate
constexpr std::size_t kCopiedWidth = 78;  // up to the element
constexpr std::size_t kSerialColumn = 6, kSerialWidth = 5;

/// Columns from 0, as in std::string; empty where the line is too short.
std::string_view columns(std::string_view line, std::size_t begin, std::size_t width) {
  return begin < line.size() ? line.substr(begin, width) : std::string_view();
}

/// Columns 21 and 22 are a chain name of two characters behind residues whose names never have a fourth letter.
bool has_long_chain_name(std::string_view line) {
  return line[20] != ' ' && is_standard_residue(std::string(trimmed(line.substr(17, 3))));
}

void check_coordinates(const std::string& path, const AtomLine& line) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t begin = 30 + 8 * axis;
    const std::string_view field = trimmed(line.text.substr(begin, 8));
    double unused = 0;
    if (parse_number(field, unused)) continue;
    throw FormatError(path, line.number,
                      std::string("the ") + "xyz"[axis] + " coordinate (columns " + std::to_string(begin + 1) + " to " +
                          std::to_string(begin + 8) + ") is " + in_quotes(field) +
                          "; a finite number was expected; are the columns shifted?");
  }
}

void check_residue_number(const std::string& path, const AtomLine& line) {
  const std::string_view field = trimmed(line.text.substr(22, 4));
  long long unused = 0;
  // Some writers of ligands leave it blank.
  if (field.empty() || parse_integer(field, unused)) return;
  // Beyond 9999 numbers continue in base 36 (hybrid-36) or hexadecimal.
  const auto is_base36 = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  if (field.size() == 4 && field[0] >= 'A' && std::all_of(field.begin(), field.end(), is_base36)) return;
  throw FormatError(path, line.number,
                    "the residue number (columns 23 to 26) is " + in_quotes(field) + "; an integer was expected");
}

void check_line(const std::string& path, const AtomLine& line) {
  if (line.text.find('\t') != std::string_view::npos) {
    throw FormatError(path, line.number, "a PDB atom line has a tab; its columns are fixed: replace tabs by spaces");
  }
  if (line.text.size() < kLeastWidth) {
    throw FormatError(path, line.number,
                      "a PDB atom line has " + std::to_string(line.text.size()) +
                          " columns; at least 54 were expected (z ends there); complete the line");
  }
  check_coordinates(path, line);
  check_residue_number(path, line);
}

/// Five columns for any number: decimal up to 99999, then base 36 from A0000 on (hybrid-36).
std::string serial_columns(std::size_t serial) {
  constexpr std::size_t kFirstBase36 = 100000;
  constexpr std::size_t kA0000 = std::size_t{10} * 36 * 36 * 36 * 36;
  const bool decimal = serial < kFirstBase36;
  const std::size_t base = decimal ? 10 : 36;
  std::size_t rest = decimal ? serial : serial - kFirstBase36 + kA0000;
  std::string digits(kSerialWidth, '0');
  for (std::size_t i = kSerialWidth; i-- > 0; rest /= base)
    digits[i] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"[rest % base];
  return digits;
}

}  // namespace

std::string pdb_residue_name(const AtomLine& line) {
  if (line.text.size() < 21) return {};
  const std::size_t width = has_long_chain_name(line.text) ? 3 : 4;
  return std::string(trimmed(line.text.substr(17, width)));
}

std::string pdb_chain_name(const AtomLine& line) {
  if (line.text.size() < 22) return {};
  return std::string(trimmed(has_long_chain_name(line.text) ? line.text.substr(20, 2) : line.text.substr(21, 1)));
}

bool has_pdb_element(const AtomLine& line) {
  const std::string_view field = columns(line.text, 76, 2);
  return std::any_of(field.begin(), field.end(), [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; });
}

CheckedPdb check_pdb(const std::string& path, const AtomModel& model, MoleculeBuilder& builder) {
  CheckedPdb checked;
  for (const AtomLine& line : model) {
    if (!builder.wants(pdb_residue_name(line), line.is_hetatm())) continue;
    check_line(path, line);
    checked.lines.push_back(line);
    std::string copy(columns(line.text, 0, kCopiedWidth));
    copy.resize(kCopiedWidth + 2, ' ');
    copy.replace(kSerialColumn, kSerialWidth, serial_columns(checked.lines.size()));
    checked.text += copy + '\n';
  }
  return checked;
}

}  // namespace espdiff
