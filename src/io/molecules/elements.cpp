// elements.cpp: van der Waals radii by element, and elements guessed from atom names.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "io/molecules/elements.h"
#include "io/molecules/molecule_builder.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

struct ElementRadius {
  const char* element;
  float radius;
};

// Bondi, J. Phys. Chem. 68, 441 (1964), doi:10.1021/j100785a001; D as H.
constexpr std::array<ElementRadius, 39> kBondi = {{
    {"H", 1.20F},  {"D", 1.20F},  {"He", 1.40F}, {"C", 1.70F},  {"N", 1.55F},  {"O", 1.52F},  {"F", 1.47F},
    {"Ne", 1.54F}, {"Si", 2.10F}, {"P", 1.80F},  {"S", 1.80F},  {"Cl", 1.75F}, {"Ar", 1.88F}, {"As", 1.85F},
    {"Se", 1.90F}, {"Br", 1.85F}, {"Kr", 2.02F}, {"Te", 2.06F}, {"I", 1.98F},  {"Xe", 2.16F}, {"Li", 1.82F},
    {"Na", 2.27F}, {"Mg", 1.73F}, {"K", 2.75F},  {"Ni", 1.63F}, {"Cu", 1.40F}, {"Zn", 1.39F}, {"Ga", 1.87F},
    {"Pd", 1.63F}, {"Ag", 1.72F}, {"Cd", 1.58F}, {"In", 1.93F}, {"Sn", 2.17F}, {"Pt", 1.75F}, {"Au", 1.66F},
    {"Hg", 1.55F}, {"Tl", 1.96F}, {"Pb", 2.02F}, {"U", 1.86F},
}};

// Alvarez, Dalton Trans. 42, 8617 (2013), doi:10.1039/c3dt50599e: those that Bondi does not give.
constexpr std::array<ElementRadius, 54> kAlvarez = {{
    {"Be", 1.98F}, {"B", 1.91F},  {"Al", 2.25F}, {"Ca", 2.62F}, {"Sc", 2.58F}, {"Ti", 2.46F}, {"V", 2.42F},
    {"Cr", 2.45F}, {"Mn", 2.45F}, {"Fe", 2.44F}, {"Co", 2.40F}, {"Ge", 2.29F}, {"Rb", 3.21F}, {"Sr", 2.84F},
    {"Y", 2.75F},  {"Zr", 2.52F}, {"Nb", 2.56F}, {"Mo", 2.45F}, {"Tc", 2.44F}, {"Ru", 2.46F}, {"Rh", 2.44F},
    {"Sb", 2.47F}, {"Cs", 3.48F}, {"Ba", 3.03F}, {"La", 2.98F}, {"Ce", 2.88F}, {"Pr", 2.92F}, {"Nd", 2.95F},
    {"Sm", 2.90F}, {"Eu", 2.87F}, {"Gd", 2.83F}, {"Tb", 2.79F}, {"Dy", 2.87F}, {"Ho", 2.81F}, {"Er", 2.83F},
    {"Tm", 2.79F}, {"Yb", 2.80F}, {"Lu", 2.74F}, {"Hf", 2.63F}, {"Ta", 2.53F}, {"W", 2.57F},  {"Re", 2.49F},
    {"Os", 2.48F}, {"Ir", 2.41F}, {"Bi", 2.54F}, {"Ac", 2.80F}, {"Th", 2.93F}, {"Pa", 2.88F}, {"Np", 2.82F},
    {"Pu", 2.81F}, {"Am", 2.83F}, {"Cm", 3.05F}, {"Bk", 3.40F}, {"Cf", 3.05F},
}};

constexpr float kUnknownRadius = 1.7F;

template <std::size_t N>
const ElementRadius* find_in(const std::array<ElementRadius, N>& table, std::string_view element) {
  const auto* const found =
      std::find_if(table.begin(), table.end(), [&](const ElementRadius& entry) { return element == entry.element; });
  return found == table.end() ? nullptr : found;
}

const ElementRadius* find_element(std::string_view element) {
  const ElementRadius* const found = find_in(kBondi, element);
  return found != nullptr ? found : find_in(kAlvarez, element);
}

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// "FE" -> "Fe".
std::string as_symbol(std::string_view letters) {
  std::string symbol;
  for (char c : letters) symbol += symbol.empty() ? upper(c) : lower(c);
  return symbol;
}

/// The first run of letters, in upper case: "1HB2" -> "HB", "NA+" -> "NA".
std::string leading_letters(std::string_view name) {
  const auto* const begin = std::find_if(name.begin(), name.end(), is_letter);
  const auto* const end = std::find_if_not(begin, name.end(), is_letter);
  std::string letters(begin, end);
  std::transform(letters.begin(), letters.end(), letters.begin(), upper);
  return letters;
}

/// Ions whose atom carries the residue's name: "CA" in "CA", "NA+" in "Na+", and CHARMM's own names.
std::string ion_element(const std::string& letters, const std::string& residue_letters) {
  if (letters.empty() || letters != residue_letters) return {};
  static constexpr std::array<std::array<const char*, 2>, 9> kCharmm = {{{"SOD", "Na"},
                                                                         {"POT", "K"},
                                                                         {"CLA", "Cl"},
                                                                         {"CAL", "Ca"},
                                                                         {"CES", "Cs"},
                                                                         {"LIT", "Li"},
                                                                         {"RUB", "Rb"},
                                                                         {"BAR", "Ba"},
                                                                         {"CAD", "Cd"}}};
  for (const auto& [name, element] : kCharmm) {
    if (letters == name) return element;
  }
  const std::string symbol = as_symbol(letters);
  return letters.size() <= 2 && find_element(symbol) != nullptr ? symbol : std::string();
}

/// Two-letter elements of ligands and cofactors whose names do not also mean carbon alpha, nitrogen epsilon and so on.
std::string two_letter_element(const std::string& letters) {
  static constexpr std::array kUnmistakable = {"FE", "ZN", "MG", "MN", "BR", "CL", "CU", "SE", "SI", "LI",
                                               "AL", "AS", "AU", "AG", "PT", "RU", "RH", "IR", "MO", "XE",
                                               "KR", "GA", "GD", "TB", "YB", "EU", "BE", "RB", "TI", "ZR"};
  const std::string start = letters.substr(0, 2);
  const bool known = std::any_of(kUnmistakable.begin(), kUnmistakable.end(), [&](const char* e) { return start == e; });
  // "CLA" and "SEG" are more likely carbon and sulfur with a label: only the bare symbol counts where letters follow.
  return known && letters.size() == 2 ? as_symbol(start) : std::string();
}

}  // namespace

float element_radius(const std::string& element) {
  const ElementRadius* const found = find_element(as_symbol(element));
  return found != nullptr ? found->radius : kUnknownRadius;
}

std::string element_from_atom_name(const std::string& atom_name, const std::string& residue_name) {
  const std::string letters = leading_letters(atom_name);
  if (letters.empty()) return {};
  const bool standard = is_standard_residue(residue_name);
  if (!standard) {
    const std::string ion = ion_element(letters, leading_letters(residue_name));
    if (!ion.empty()) return ion;
  }
  if (!standard || residue_name == "MSE") {
    const std::string element = two_letter_element(letters);
    if (!element.empty()) return element;
  }
  constexpr std::string_view kSingle = "HDBCNOFPSKIVWUY";
  return kSingle.find(letters[0]) != std::string_view::npos ? std::string(1, letters[0]) : std::string();
}

}  // namespace espdiff
