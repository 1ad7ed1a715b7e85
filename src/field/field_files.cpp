// field_files.cpp: tables of residues' and atoms' values, matched to molecules.
#include "field/field_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/molecule/residue_label.h"
#include "field/file_pattern.h"
#include "io/files/read_csv.h"
#include "io/files/sha256.h"

namespace espdiff {

SideFiles::SideFiles(const std::string& kind, const std::string& argument) : kind_(kind) {
  const std::size_t comma = argument.find(',');
  source_ = argument.substr(0, comma);
  if (comma != std::string::npos) target_ = argument.substr(comma + 1);
  if (source_.empty() || (comma != std::string::npos && target_.empty()) || target_.find(',') != std::string::npos)
    throw InputError(option("field") + ": '" + kind + ":" + argument + "' is not " + kind + ":FILE, or " + kind +
                     ":SOURCE_FILE,TARGET_FILE");
}

std::string SideFiles::what() const { return kind_ + ":" + source_ + (target_.empty() ? "" : "," + target_); }

const std::string& SideFiles::pattern_of(const FieldSide& side) const {
  if (side.is_one_of_many() && !target_.empty())
    throw InputError(what() + " names a file for the source and one for the target, and here are many states; give " +
                     "one for all, or one for each by a place in its name (" +
                     (side == FieldSide::kVariant ? "{label}, {group}" : "{replicate}, %d") + ")");
  return side == FieldSide::kTarget && !target_.empty() ? target_ : source_;
}

std::string SideFiles::of(const FieldSide& side) const { return fill_pattern(pattern_of(side), side.input, what()); }

std::string SideFiles::own_of(const FieldSide& side) const {
  const std::string& pattern = pattern_of(side);
  const bool is_frame = side.input.frame >= 0;
  if (is_frame && count_frame_places(pattern) == 0)
    throw InputError(what() + ": each frame needs a map of its own, in its place; name them by the frame's number, " +
                     "as in " + kind_ + (side == FieldSide::kTarget ? ":SOURCE.dx,frame.%d.dx" : ":frame.%d.dx"));
  if (side == FieldSide::kVariant && !is_pattern(pattern))
    throw InputError(what() + ": each variant needs a map of its own, in its place; name them by the label, as in " +
                     kind_ + ":{label}.dx");
  return of(side);
}

std::vector<std::string> SideFiles::all() const {
  return target_.empty() ? std::vector<std::string>{source_} : std::vector<std::string>{source_, target_};
}

std::vector<FieldFile> SideFiles::with_sums() const {
  std::vector<FieldFile> files;
  for (const std::string& path : all()) {
    if (!is_pattern(path)) files.push_back({path, sha256_of_file(path)});
  }
  return files;
}

std::vector<FieldFile> SideFiles::own_with_sum(const FieldSide& side) const {
  if (!is_pattern(pattern_of(side))) return {};
  const std::string path = of(side);
  return {{path, sha256_of_file(path)}};
}

namespace {

/// One text for one place.
std::string key_of(const std::string& chain, const std::string& number, const std::string& insertion,
                   const std::string& atom) {
  return chain + '\t' + number + insertion + '\t' + atom;
}

std::string key_of(const Residue& residue, const std::string& atom) {
  return key_of(residue.chain, std::to_string(residue.number),
                residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code), atom);
}

/// The column of the values.
std::size_t value_column(const CsvTable& table) {
  const int named = table.find("value");
  if (named >= 0) return static_cast<std::size_t>(named);
  const std::set<std::string> places = {"chain", "residue_number", "insertion_code", "residue_name", "atom_name"};
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (places.count(table.columns[c]) == 0) others.push_back(c);
  }
  if (others.size() == 1) return others.front();
  throw FormatError(table.path, 0,
                    "which column has the values? There " + std::string(others.empty() ? "is none" : "are several") +
                        " besides those that name residues; call one 'value'");
}

/// NaN where the table says so, in any spelling of R's and Python's, or has an empty field.
double value_at(const CsvTable& table, std::size_t row, std::size_t column) {
  std::string text = table.rows[row][column];
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text == "nan" || text == "na" ? static_cast<double>(kNoValue) : table.number(row, column);
}

}  // namespace

ValueTable::ValueTable(const std::string& path, bool of_atoms) : path_(path), of_atoms_(of_atoms) {
  const CsvTable table = read_csv(path);
  const std::size_t chain = table.require("chain"), number = table.require("residue_number"),
                    value = value_column(table), atom = of_atoms ? table.require("atom_name") : 0;
  const int insertion = table.find("insertion_code");
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<std::string>& row = table.rows[r];
    const double residue_number = table.number(r, number);
    if (!(std::floor(residue_number) == residue_number))
      throw FormatError(path, table.lines[r], "the residue number '" + row[number] + "' is no whole number");
    const std::string digits = std::to_string(static_cast<long long>(residue_number)),
                      code = insertion >= 0 ? row[static_cast<std::size_t>(insertion)] : "",
                      name = of_atoms ? row[atom] : "", key = key_of(row[chain], digits, code, name);
    std::string label = (row[chain].empty() ? "" : row[chain] + " ") + digits + code;
    if (of_atoms) label += " " + name;
    if (!entries_.emplace(key, Entry{value_at(table, r, value), label}).second)
      throw FormatError(path, table.lines[r], label + " stands in the table twice; leave one of its rows out");
    order_.push_back(key);
  }
}

StateField ValueTable::values_of(const Molecule& molecule, const FieldSide& side) const {
  StateField field;
  std::set<std::string> found;
  std::set<std::size_t> without;
  for (const Atom& atom : molecule.atoms) {
    const auto r = static_cast<std::size_t>(atom.residue);
    const std::string key = key_of(molecule.residues[r], of_atoms_ ? atom.name : "");
    const auto entry = entries_.find(key);
    const bool has_value = entry != entries_.end() && std::isfinite(entry->second.value);
    field.atoms.push_back(has_value ? static_cast<float>(entry->second.value) : kNoValue);
    if (entry != entries_.end()) found.insert(key);
    if (!has_value && !of_atoms_) without.insert(r);
  }
  if (of_atoms_) give_to_hydrogens(molecule, field.atoms);
  const std::string state = std::string("the ") + to_string(side) + " (" + molecule.name + ")",
                    places = of_atoms_ ? "atoms" : "residues";
  if (found.empty())
    throw InputError(path_ + ": it has none of the " + places + " of " + state +
                     (order_.empty() ? "" : "; it begins with " + entries_.at(order_.front()).label) +
                     "; check chains and numbers, or give a table for each state (" +
                     (side == FieldSide::kVariant ? "{label} in its name"
                      : side == FieldSide::kFrame ? "{replicate} in its name"
                                                  : "SOURCE_FILE,TARGET_FILE") +
                     ")");
  const std::size_t n_unknown = entries_.size() - found.size();
  for (const std::string& key : order_) {
    if (found.count(key) > 0) continue;
    field.notes.push_back(path_ + ": " + std::to_string(n_unknown) + " of its " + std::to_string(entries_.size()) +
                          " " + places + (n_unknown == 1 ? " is" : " are") + " not in " + state + ", the first is " +
                          entries_.at(key).label);
    break;
  }
  if (!without.empty())
    field.notes.push_back(path_ + ": " + std::to_string(without.size()) + " of " +
                          std::to_string(molecule.residues.size()) + " residues of " + state +
                          " have no value there, the first is " + residue_label(molecule.residues[*without.begin()]));
  return field;
}

Field field_of_tables(const FieldKind& kind, const std::string& argument, bool of_atoms) {
  const SideFiles files(kind.quantity.name, argument);
  const auto tables = std::make_shared<std::map<std::string, ValueTable>>();  // those that were read
  const auto table_of = [tables, of_atoms](const std::string& path) -> const ValueTable& {
    const auto found = tables->find(path);
    return found != tables->end() ? found->second : tables->emplace(path, ValueTable(path, of_atoms)).first->second;
  };
  for (const std::string& path : files.all()) {
    if (!is_pattern(path)) table_of(path);  // a wrong table is found at once
  }
  Field field{kind.quantity, "", "", nullptr};
  field.make = [files, tables, of_atoms, table_of](const Molecule& molecule, const FieldSide& side) {
    const std::vector<FieldFile> own = files.own_with_sum(side);
    StateField of_state = own.empty() ? table_of(files.of(side)).values_of(molecule, side)
                                      : ValueTable(own.front().path, of_atoms).values_of(molecule, side);
    of_state.files = own;
    return of_state;
  };
  field.files = files.with_sums();
  return field;
}

}  // namespace espdiff
