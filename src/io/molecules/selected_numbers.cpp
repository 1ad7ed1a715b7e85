// selected_numbers.cpp: finds the residues' field of a selection, and reads the numbers at its beginning.
#include "io/molecules/selected_numbers.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

using Limits = std::numeric_limits<int>;

/// Where the residues' field begins, npos where the selection has none: behind the third slash of
/// /model/chains/residues, behind the first of chains/residues, or at the beginning, where no name of a chain can
/// stand.
std::size_t residue_field(const std::string& selection) {
  const std::size_t end = std::min(selection.find(';'), selection.size());
  if (end == 0) return std::string::npos;
  const char first = selection.front();
  if (std::string_view("0123456789-(").find(first) != std::string_view::npos) return 0;
  std::size_t at = selection.find_first_of("/([:");
  if (at >= end || selection[at] != '/') return std::string::npos;
  for (int n_more = first == '/' ? 2 : 0; n_more > 0; --n_more) {
    at = selection.find('/', at + 1);
    if (at >= end) return std::string::npos;
  }
  return at + 1;
}

/// Reads "10", "-3", "10.A", "10A", "10." or "10.*" at the beginning of `text`, and removes it.
bool take_number(std::string_view& text, int& number, char& code) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  const bool has_dot = !text.empty() && text.front() == '.';
  if (has_dot) text.remove_prefix(1);
  if (text.empty() || !(is_letter(text.front()) || (has_dot && text.front() == '*'))) return true;
  code = text.front();
  text.remove_prefix(1);
  return true;
}

bool read_item(std::string_view text, SelectedNumbers& item) {
  item = {Limits::min(), Limits::max(), '*', '*'};
  if (text.empty()) return false;
  if (text.front() == '*') {
    text.remove_prefix(1);
  } else {
    item.first_code = ' ';
    if (!take_number(text, item.first, item.first_code)) return false;
    if (text.empty()) item = {item.first, item.first, item.first_code, item.first_code};
  }
  if (text.empty()) return true;
  if (text.front() != '-') return false;
  text.remove_prefix(1);
  if (text.empty() || text == "*") return true;
  item.last_code = ' ';
  return take_number(text, item.last, item.last_code) && text.empty() && item.first <= item.last;
}

}  // namespace

bool SelectedNumbers::has(const Residue& residue) const {
  const auto not_below = [&](int number, char code) {
    return residue.number != number ? residue.number > number : code == '*' || residue.insertion_code >= code;
  };
  const auto not_above = [&](int number, char code) {
    return residue.number != number ? residue.number < number : code == '*' || residue.insertion_code <= code;
  };
  return not_below(first, first_code) && not_above(last, last_code);
}

SplitSelection split_numbers(const std::string& selection, const std::string& option_name) {
  const std::size_t begin = residue_field(selection);
  if (begin == std::string::npos) return {selection, {}};
  const std::size_t end = std::min(selection.find_first_of("/;(", begin), selection.size());
  std::string_view numbers(selection);
  numbers = numbers.substr(begin, end - begin);
  // "*" and what MMDB writes behind it, "*(ALA).", name all numbers.
  if (numbers.empty() || numbers == "*") return {selection, {}};

  // "(*)", any name, keeps the field where nothing else stands in it.
  const bool has_names = end < selection.size() && selection[end] == '(';
  SplitSelection split{selection.substr(0, begin) + (has_names ? "" : "(*)") + selection.substr(end), {}};
  while (true) {
    const std::size_t comma = std::min(numbers.find(','), numbers.size());
    const std::string_view text = numbers.substr(0, comma);
    SelectedNumbers item{};
    if (!read_item(text, item))
      throw InputError(
          option(option_name) + ": " + in_quotes(text) + " in " + in_quotes(selection) +
          " is not a residue's number or a range; give such as 26, 10-20, -3--1 or 10.A, or several separated by "
          "commas without blanks: 26,27,30-40");
    split.numbers.push_back(item);
    if (comma == numbers.size()) return split;
    numbers.remove_prefix(comma + 1);
  }
}

}  // namespace espdiff
