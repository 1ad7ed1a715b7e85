// read_pqr.cpp: PQR lines, free or by columns.
#include "io/structures/formats/read_pqr.h"

#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/molecules/molecule_builder.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

struct PqrAtom {
  AtomEntry entry;
  double charge = 0;
  double radius = 0;
};

/// "52", "-3", "52A" (insertion code), "A52" (chain in front; only when `may_have_chain`).
bool parse_residue_number(std::string_view word, bool may_have_chain, AtomEntry& entry) {
  std::string chain;
  if (may_have_chain && word.size() > 1 && is_letter(word.front())) {
    chain = word.front();
    word.remove_prefix(1);
  }
  char insertion_code = ' ';
  if (word.size() > 1 && is_letter(word.back())) {
    insertion_code = word.back();
    word.remove_suffix(1);
  }
  long long number = 0;
  if (!parse_integer(word, number) || number > std::numeric_limits<int>::max() ||
      number < std::numeric_limits<int>::min()) {
    return false;
  }
  if (may_have_chain) entry.chain = chain;
  entry.residue_number = static_cast<int>(number);
  entry.insertion_code = insertion_code;
  return true;
}

/// Takes off the element that Amber's ambpdb writes behind the radius.
void drop_element(std::vector<std::string_view>& words) {
  const std::string_view last = words.empty() ? std::string_view() : words.back();
  if (!last.empty() && last.size() <= 2 && is_letter(last.front()) && is_letter(last.back())) words.pop_back();
}

/// Words of the line with a serial number that is glued to the record's name (HETATM10000) parted from it.
std::vector<std::string_view> pqr_words(std::string_view line) {
  std::vector<std::string_view> words = split_words(line);
  drop_element(words);
  if (words.front().size() > 6) {
    const std::string_view glued = words.front();
    words.front() = glued.substr(0, 6);
    words.insert(words.begin() + 1, glued.substr(6));
  }
  return words;
}

constexpr std::array<const char*, 5> kNumbers = {"x coordinate", "y coordinate", "z coordinate", "charge", "radius"};

/// Outcome of one way to read a line: the atom, or what did not fit.
struct Attempt {
  std::optional<PqrAtom> atom;
  std::string problem;
};

void set_numbers(PqrAtom& atom, const std::array<double, 5>& numbers) {
  atom.entry.position = {numbers[0], numbers[1], numbers[2]};
  atom.charge = numbers[3];
  atom.radius = numbers[4];
}

Attempt read_by_words(std::string_view line) {
  const std::vector<std::string_view> words = pqr_words(line);
  constexpr std::size_t kWithoutChain = 10, kWithChain = 11;
  if (words.size() != kWithoutChain && words.size() != kWithChain) {
    return {std::nullopt, std::to_string(words.size()) + " fields"};
  }
  PqrAtom atom;
  atom.entry.name = words[2];
  atom.entry.residue_name = words[3];
  const bool has_chain = words.size() == kWithChain;
  if (has_chain) atom.entry.chain = words[4];
  const std::string_view number = words[has_chain ? 5 : 4];
  if (!parse_residue_number(number, !has_chain, atom.entry)) {
    return {std::nullopt, "the residue number is " + in_quotes(number)};
  }
  std::array<double, 5> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string_view word = words[words.size() - 5 + i];
    if (!parse_number(word, numbers[i])) {
      return {std::nullopt, std::string("the ") + kNumbers[i] + " is " + in_quotes(word)};
    }
  }
  set_numbers(atom, numbers);
  return {std::move(atom), {}};
}

/// Charge and radius: two words, or, glued together, as %8.4f and %7.4f.
bool parse_charge_and_radius(std::string_view tail, double& charge, double& radius) {
  auto words = split_words(tail);
  drop_element(words);
  if (words.size() == 2) return parse_number(words[0], charge) && parse_number(words[1], radius);
  constexpr std::size_t kChargeWidth = 8;
  return words.size() == 1 && tail.size() > kChargeWidth &&
         parse_number(trimmed(tail.substr(0, kChargeWidth)), charge) &&
         parse_number(trimmed(tail.substr(kChargeWidth)), radius);
}

Attempt read_by_columns(std::string_view line) {
  constexpr std::size_t kTail = 54;
  if (line.size() <= kTail) return {std::nullopt, "the line is too short for PDB columns"};
  PqrAtom atom;
  atom.entry.name = trimmed(line.substr(12, 4));
  atom.entry.residue_name = trimmed(line.substr(17, 4));
  atom.entry.chain = trimmed(line.substr(21, 1));
  if (!parse_residue_number(trimmed(line.substr(22, 5)), false, atom.entry)) {
    return {std::nullopt, "the residue number in columns 23 to 27 is " + in_quotes(trimmed(line.substr(22, 5)))};
  }
  std::array<double, 5> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string_view field = trimmed(line.substr(30 + 8 * i, 8));
    // Without its decimal point the field has been cut at the wrong place.
    if (!parse_number(field, numbers[i]) || field.find('.') == std::string_view::npos) {
      return {std::nullopt, std::string("the ") + kNumbers[i] + " in PDB columns is " + in_quotes(field)};
    }
  }
  if (!parse_charge_and_radius(line.substr(kTail), numbers[3], numbers[4])) {
    return {std::nullopt, "charge and radius are " + in_quotes(trimmed(line.substr(kTail)))};
  }
  set_numbers(atom, numbers);
  return {std::move(atom), {}};
}

/// Five characters are more than names have columns: "HD21AASN A 5" is atom, location and residue run together, and by
/// blanks looks like residue A without chain; "TIP3W 5" is residue and chain.
bool has_glued_names(const AtomEntry& entry) {
  constexpr std::size_t kWidest = 4;
  return entry.name.size() > kWidest || entry.residue_name.size() > kWidest;
}

PqrAtom read_atom(const std::string& path, const AtomLine& line) {
  Attempt by_words = read_by_words(line.text);
  if (by_words.atom && !has_glued_names(by_words.atom->entry)) return *std::move(by_words.atom);
  Attempt by_columns = read_by_columns(line.text);
  if (by_words.atom && by_columns.atom && !(by_words.atom->entry.position == by_columns.atom->entry.position)) {
    return *std::move(by_words.atom);  // a long name in a line that has other columns
  }
  if (by_columns.atom) return *std::move(by_columns.atom);
  if (by_words.atom) return *std::move(by_words.atom);
  throw FormatError(
      path, line.number,
      "this PQR line cannot be read: by blanks, " + by_words.problem + "; by columns, " + by_columns.problem +
          "; expected: record, serial, atom, residue, [chain,] number, x, y, z, charge, radius, finite and "
          "separated by blanks");
}

/// Digits behind the point of the line's last word.
std::size_t last_decimals(std::string_view line) {
  const std::string_view word = split_words(line).back();
  const std::size_t point = word.find('.');
  return point == std::string_view::npos ? 0 : word.size() - point - 1;
}

/// A file that was cut within its last number reads as another number.
void check_last_line(const std::string& path, const AtomModel& model) {
  if (model.size() < 2 || model.back().has_end) return;
  const std::size_t before = last_decimals(model[model.size() - 2].text), last = last_decimals(model.back().text);
  if (last >= before) return;
  throw FormatError(path, model.back().number,
                    "the file ends within this line, and its last number has " + std::to_string(last) +
                        " decimals instead of " + std::to_string(before) +
                        ": it seems to be cut; fetch it again, or end the line if it is whole");
}

}  // namespace

Molecule read_pqr(const std::string& path, const AtomModel& model, const StructureOptions& options) {
  MoleculeBuilder builder(path, options);
  for (const AtomLine& line : model) {
    PqrAtom atom = read_atom(path, line);
    if (!builder.wants(atom.entry.residue_name, line.is_hetatm())) continue;
    atom.entry.hetero = line.is_hetatm();
    atom.entry.line = line.number;
    builder.add(atom.entry, atom.charge, atom.radius);
  }
  check_last_line(path, model);
  return builder.finish();
}

}  // namespace espdiff
