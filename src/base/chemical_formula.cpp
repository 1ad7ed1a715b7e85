// chemical_formula.cpp: words of elements and numbers.
#include "base/chemical_formula.h"

#include <algorithm>
#include <cctype>

namespace espdiff {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// The digits at the beginning of a word, which become a number; 1 without any.
int take_number(std::string_view& word) {
  constexpr std::size_t kMostDigits = 6;
  std::size_t n = 0;
  int number = 0;
  for (; n < std::min(word.size(), kMostDigits) && is_digit(word[n]); ++n) number = 10 * number + (word[n] - '0');
  word.remove_prefix(n);
  return n == 0 ? 1 : number;
}

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

/// "C33", "ZN", or a charge: "2-", "1+", "-1". @returns whether it was one of them
bool add_word(std::string_view word, ChemicalFormula& formula) {
  if (is_letter(word.front())) {
    std::string element(1, static_cast<char>(std::toupper(static_cast<unsigned char>(word.front()))));
    word.remove_prefix(1);
    if (!word.empty() && is_letter(word.front())) {
      element += static_cast<char>(std::tolower(static_cast<unsigned char>(word.front())));
      word.remove_prefix(1);
    }
    formula.atoms[element] += take_number(word);
    return word.empty();
  }
  const bool sign_first = word.front() == '+' || word.front() == '-';
  const char first = word.front();
  if (sign_first) word.remove_prefix(1);
  const int size = take_number(word);
  const char sign = sign_first ? first : word.empty() ? ' ' : word.front();
  if (!sign_first && !word.empty()) word.remove_prefix(1);
  if (sign != '+' && sign != '-') return false;
  formula.charge = sign == '+' ? size : -size;
  return word.empty();
}

}  // namespace

std::optional<ChemicalFormula> parse_formula(std::string_view text) {
  text = without_blanks(text);
  if (const std::size_t open = text.find('('); open != std::string_view::npos) {
    const std::size_t close = text.rfind(')');
    if (close == std::string_view::npos || close < open) return std::nullopt;
    text = text.substr(open + 1, close - open - 1);
  }
  ChemicalFormula formula;
  while (!(text = without_blanks(text)).empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (!add_word(text.substr(0, end), formula)) return std::nullopt;
    text.remove_prefix(end);
  }
  return formula.atoms.empty() ? std::nullopt : std::optional<ChemicalFormula>(std::move(formula));
}

std::map<std::string, ChemicalFormula> formulas_in_pdb(std::string_view text) {
  constexpr std::size_t kName = 12, kNameWidth = 3, kFormula = 18, kEnd = 70;
  std::map<std::string, std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    // They stand before the atoms.
    if (line.substr(0, 6) == "ATOM  " || line.substr(0, 6) == "MODEL ") break;
    if (line.substr(0, 6) != "FORMUL" || line.size() <= kFormula) continue;
    words[std::string(without_blanks(line.substr(kName, kNameWidth)))] +=
        " " + std::string(line.substr(kFormula, kEnd - kFormula));
  }
  std::map<std::string, ChemicalFormula> formulas;
  for (const auto& [name, formula_text] : words) {
    if (auto formula = parse_formula(formula_text)) formulas.emplace(name, std::move(*formula));
  }
  return formulas;
}

}  // namespace espdiff
