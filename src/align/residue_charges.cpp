// residue_charges.cpp: the tables of net charges.
//
// Residues: the sums of the charges in the force fields ff14SB and OL (Amber), CHARMM36, OPLS-AA, GROMOS 54A7 and PARSE
// agree on them, as their protonation states do. Ions: the common oxidation states (IUPAC). Groups: at pH 7, each acid
// with the charge that its pKa values give (CRC Handbook); haem is iron(II), whose two propionates are ionized.
#include "align/residue_charges.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "align/residue_names.h"

namespace espdiff {
namespace {

using ChargesTable = std::unordered_map<std::string_view, std::vector<int>>;

/// Names that say a state, or modified residues with one charge.
const ChargesTable& charges_of_names() {
  static const ChargesTable table = {
      {"ASH", {0}},      {"ASPP", {0}},   {"ASPH", {0}},    {"AS0", {0}},  {"GLH", {0}},      {"GLUP", {0}},
      {"GLUH", {0}},     {"GL0", {0}},    {"HID", {0}},     {"HIE", {0}},  {"HSD", {0}},      {"HSE", {0}},
      {"HISD", {0}},     {"HISE", {0}},   {"HISA", {0}},    {"HISB", {0}}, {"HIP", {1}},      {"HSP", {1}},
      {"HISH", {1}},     {"HI+", {1}},    {"AR+", {1}},     {"LY+", {1}},  {"AS-", {-1}},     {"GL-", {-1}},
      {"LYN", {0}},      {"LSN", {0}},    {"LY0", {0}},     {"LYSH", {1}}, {"ARN", {0}},      {"AR0", {0}},
      {"ARGN", {0}},     {"CYX", {0}},    {"CYS2", {0}},    {"CYSH", {0}}, {"CSS", {0}},      {"CYM", {-1}},
      {"CY-", {-1}},     {"TYM", {-1}},   {"TY-", {-1}},    {"MSE", {0}},  {"HYP", {0}},      {"PCA", {0}},
      {"M3L", {1}},      {"MLY", {0, 1}}, {"KCX", {-1}},    {"TYS", {-1}}, {"SEP", {-2, -1}}, {"TPO", {-2, -1}},
      {"PTR", {-2, -1}}, {"OCS", {-1}},   {"CSD", {-1, 0}}, {"CSO", {0}},  {"CME", {0}},      {"LLP", {}},
  };
  return table;
}

const std::vector<int>& charges_of_letter(char letter) {
  static const std::vector<int> acid{-1, 0}, base{0, 1}, neutral{0}, phosphate{-1}, none;
  switch (letter) {
    case 'D':
    case 'E':
    case 'C':
    case 'Y': return acid;
    case 'H':
    case 'K':
    case 'R': return base;
    case '?': return none;
    default: return letter >= 'a' ? phosphate : neutral;
  }
}

const std::unordered_map<std::string_view, int>& ions() {
  static const std::unordered_map<std::string_view, int> table = {
      {"LI", 1},  {"NA", 1},  {"NA+", 1}, {"SOD", 1}, {"K", 1},    {"K+", 1},   {"POT", 1}, {"RB", 1},
      {"CS", 1},  {"CES", 1}, {"AG", 1},  {"TL", 1},  {"CU1", 1},  {"MG", 2},   {"MG2", 2}, {"CA", 2},
      {"CAL", 2}, {"SR", 2},  {"BA", 2},  {"MN", 2},  {"FE2", 2},  {"CO", 2},   {"NI", 2},  {"CU", 2},
      {"ZN", 2},  {"ZN2", 2}, {"CD", 2},  {"CAD", 2}, {"HG", 2},   {"PB", 2},   {"FE", 3},  {"AL", 3},
      {"LA", 3},  {"EU", 3},  {"GD", 3},  {"TB", 3},  {"YB", 3},   {"YB2", 2},  {"MN3", 3}, {"3NI", 3},
      {"PT4", 4}, {"3CO", 3}, {"F", -1},  {"CL", -1}, {"CL-", -1}, {"CLA", -1}, {"BR", -1}, {"IOD", -1},
  };
  return table;
}

const std::unordered_map<std::string_view, int>& groups() {
  static const std::unordered_map<std::string_view, int> table = {
      {"HEM", -2}, {"HEC", -2}, {"OH", -1},  {"SO4", -2}, {"PO4", -2}, {"PI", -1},  {"NO3", -1}, {"NH4", 1},
      {"ACT", -1}, {"ACY", -1}, {"FMT", -1}, {"CIT", -3}, {"FLC", -3}, {"TLA", -2}, {"MLI", -2}, {"OXM", -1},
      {"SCN", -1}, {"AZI", -1}, {"CYN", -1}, {"CO3", -2}, {"BCT", -1}, {"GOL", 0},  {"EDO", 0},  {"MPD", 0},
      {"MRD", 0},  {"IPA", 0},  {"EOH", 0},  {"DMS", 0},  {"PEG", 0},  {"PGE", 0},  {"PG4", 0},  {"1PE", 0},
      {"BME", 0},  {"NAG", 0},  {"BMA", 0},  {"MAN", 0},  {"FUC", 0},  {"GLC", 0},  {"ATP", -4}, {"ADP", -3},
      {"AMP", -2}, {"GTP", -4}, {"GDP", -3}, {"NAD", -1}, {"NAI", -2}, {"NAP", -3}, {"NDP", -4}, {"FMN", -2},
      {"FAD", -2}, {"SF4", -2}, {"FES", -2}, {"ACE", 0},  {"NME", 0},  {"NH2", 0},
  };
  return table;
}

std::optional<int> find_in(const std::unordered_map<std::string_view, int>& table, const std::string& name) {
  const auto found = table.find(name);
  return found == table.end() ? std::nullopt : std::optional<int>(found->second);
}

}  // namespace

std::vector<int> possible_charges(const std::string& residue_name) {
  std::string name = residue_name;
  const char letter = residue_letter(name);
  // Amber marks ends of chains: NHIP, CASP.
  if (name.size() == 4 && charges_of_names().count(name) == 0 && letter != '?') name.erase(0, 1);
  const auto found = charges_of_names().find(name);
  return found == charges_of_names().end() ? charges_of_letter(letter) : found->second;
}

std::vector<int> charges_of_state(const std::string& state) {
  static const ChargesTable table = {
      {"ASP", {-1}}, {"GLU", {-1}},    {"ASH", {0}}, {"GLH", {0}}, {"HID", {0}},     {"HIE", {0, 1}},
      {"HIP", {1}},  {"LYS", {1}},     {"LYN", {0}}, {"TYR", {0}}, {"TYM", {-1, 0}}, {"CYS", {0}},
      {"CYX", {0}},  {"CYM", {-1, 0}}, {"ARG", {1}}, {"AR0", {0}},
  };
  const auto found = table.find(state);
  return found == table.end() ? std::vector<int>() : found->second;
}

std::optional<int> charge_of_group(const std::string& residue_name, std::size_t n_atoms) {
  return is_ion_name(residue_name) ? (n_atoms == 1 ? find_in(ions(), residue_name) : std::nullopt)
                                   : find_in(groups(), residue_name);
}

bool is_ion_name(const std::string& residue_name) { return ions().count(residue_name) > 0; }

}  // namespace espdiff
