// residue_names.cpp: the tables of residue and atom names.
#include "align/residue_names.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/molecule/water.h"

namespace espdiff {
namespace {

using LetterTable = std::unordered_map<std::string_view, char>;

/// The PDB name, then protonation states of Amber, CHARMM, Gromacs, OPLS and PARSE, then modified residues.
const LetterTable& letters() {
  static const LetterTable table = {
      {"ARGN", 'R'}, {"AS0", 'D'},  {"ASPH", 'D'}, {"CSS", 'C'},  {"CY-", 'C'},  {"CYSH", 'C'}, {"GL0", 'E'},
      {"GLUH", 'E'}, {"HI+", 'H'},  {"HISA", 'H'}, {"HISB", 'H'}, {"LY0", 'K'},  {"LYSH", 'K'}, {"TY-", 'Y'},
      {"PR+", 'P'},  {"PR-", 'P'},  {"AR+", 'R'},  {"AS-", 'D'},  {"GL-", 'E'},  {"LY+", 'K'},  {"ALA", 'A'},
      {"ARG", 'R'},  {"ARN", 'R'},  {"AR0", 'R'},  {"ASN", 'N'},  {"ASP", 'D'},  {"ASH", 'D'},  {"ASPP", 'D'},
      {"CYS", 'C'},  {"CYX", 'C'},  {"CYM", 'C'},  {"CYS2", 'C'}, {"CSO", 'C'},  {"CME", 'C'},  {"OCS", 'C'},
      {"CSD", 'C'},  {"GLN", 'Q'},  {"GLU", 'E'},  {"GLH", 'E'},  {"GLUP", 'E'}, {"PCA", 'E'},  {"GLY", 'G'},
      {"HIS", 'H'},  {"HSD", 'H'},  {"HSE", 'H'},  {"HSP", 'H'},  {"HID", 'H'},  {"HIE", 'H'},  {"HIP", 'H'},
      {"HISD", 'H'}, {"HISE", 'H'}, {"HISH", 'H'}, {"ILE", 'I'},  {"LEU", 'L'},  {"LYS", 'K'},  {"LYN", 'K'},
      {"LSN", 'K'},  {"MLY", 'K'},  {"M3L", 'K'},  {"KCX", 'K'},  {"LLP", 'K'},  {"MET", 'M'},  {"MSE", 'M'},
      {"PHE", 'F'},  {"PRO", 'P'},  {"HYP", 'P'},  {"SER", 'S'},  {"SEP", 'S'},  {"THR", 'T'},  {"TPO", 'T'},
      {"TRP", 'W'},  {"TYR", 'Y'},  {"TYM", 'Y'},  {"PTR", 'Y'},  {"TYS", 'Y'},  {"VAL", 'V'},  {"A", 'a'},
      {"DA", 'a'},   {"RA", 'a'},   {"ADE", 'a'},  {"C", 'c'},    {"DC", 'c'},   {"RC", 'c'},   {"CYT", 'c'},
      {"G", 'g'},    {"DG", 'g'},   {"RG", 'g'},   {"GUA", 'g'},  {"T", 't'},    {"DT", 't'},   {"THY", 't'},
      {"U", 'u'},    {"RU", 'u'},   {"URA", 'u'},  {"URI", 'u'},
  };
  return table;
}

char find_letter(const std::string& name) {
  const auto found = letters().find(name);
  return found == letters().end() ? '?' : found->second;
}

std::string upper_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

ResidueKind kind_of(const std::string& residue_name, const std::vector<std::string>& atom_names) {
  const char letter = residue_letter(residue_name);
  if (letter >= 'A' && letter <= 'Z') return ResidueKind::kAminoAcid;
  if (letter >= 'a' && letter <= 'z') return ResidueKind::kNucleotide;
  if (is_water_name(upper_case(residue_name))) return ResidueKind::kWater;
  const auto has = [&](const char* name) {
    return std::find(atom_names.begin(), atom_names.end(), name) != atom_names.end();
  };
  if (has("N") && has("CA") && has("C")) return ResidueKind::kAminoAcid;
  if (has("P") && has("C1'") && has("C3'") && has("C4'") && has("O3'")) return ResidueKind::kNucleotide;
  return ResidueKind::kOther;
}

/// Whether a name has neither blanks nor digits in front nor what older files write otherwise.
bool is_plain(const std::string& name) {
  return !name.empty() && !is_digit(name.front()) && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || is_digit(c) || c == '\'';
  });
}

/// In capitals, with the digits at the end.
std::string in_todays_order(const std::string& atom_name) {
  std::string name;
  for (const char c : atom_name) {
    if (c == '*') {
      name += '\'';
    } else if (c == '"') {
      name += "''";
    } else if (c != ' ') {
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  const auto first_letter = std::find_if_not(name.begin(), name.end(), is_digit);
  if (first_letter == name.begin() || first_letter == name.end()) return name;
  const std::string digits(name.begin(), first_letter);
  name.erase(name.begin(), first_letter);
  // 1H5* and 2H5* are now H5' and H5''.
  if (name.back() == '\'' && (digits == "1" || digits == "2")) return digits == "1" ? name : name + '\'';
  return name + digits;
}

/// The name that an older one has now; null without one.
const char* synonym_of(std::string_view name) {
  static constexpr std::pair<std::string_view, const char*> kSynonyms[] = {
      {"HN", "H"},  {"HT1", "H1"},  {"HT2", "H2"}, {"HT3", "H3"},  {"HN1", "H1"},  {"HN2", "H2"},  {"HN3", "H3"},
      {"OT1", "O"}, {"OT2", "OXT"}, {"OT", "OXT"}, {"O1P", "OP1"}, {"O2P", "OP2"}, {"O5T", "O5'"}, {"O3T", "O3'"}};
  if (name.size() < 2 || name.size() > 3 || (name[0] != 'H' && name[0] != 'O')) return nullptr;
  for (const auto& [old, today] : kSynonyms) {
    if (old == name) return today;
  }
  return nullptr;
}

/// Heavy atoms of an amino acid's side chain between blanks; null for other letters.
const std::string_view* side_chain_of(char letter) {
  static constexpr std::pair<char, std::string_view> kSideChains[] = {{'A', " CB "},
                                                                      {'R', " CB CG CD NE CZ NH1 NH2 "},
                                                                      {'N', " CB CG OD1 ND2 "},
                                                                      {'D', " CB CG OD1 OD2 "},
                                                                      {'C', " CB SG "},
                                                                      {'Q', " CB CG CD OE1 NE2 "},
                                                                      {'E', " CB CG CD OE1 OE2 "},
                                                                      {'G', " "},
                                                                      {'H', " CB CG ND1 CD2 CE1 NE2 "},
                                                                      {'I', " CB CG1 CG2 CD1 "},
                                                                      {'L', " CB CG CD1 CD2 "},
                                                                      {'K', " CB CG CD CE NZ "},
                                                                      {'M', " CB CG SD CE "},
                                                                      {'F', " CB CG CD1 CD2 CE1 CE2 CZ "},
                                                                      {'P', " CB CG CD "},
                                                                      {'S', " CB OG "},
                                                                      {'T', " CB OG1 CG2 "},
                                                                      {'W', " CB CG CD1 CD2 NE1 CE2 CE3 CZ2 CZ3 CH2 "},
                                                                      {'Y', " CB CG CD1 CD2 CE1 CE2 CZ OH "},
                                                                      {'V', " CB CG1 CG2 "}};
  const auto* const row = std::find_if(std::begin(kSideChains), std::end(kSideChains),
                                       [&](const auto& side_chain) { return side_chain.first == letter; });
  return row == std::end(kSideChains) ? nullptr : &row->second;
}

}  // namespace

char residue_letter(const std::string& residue_name) {
  std::string name = upper_case(residue_name);
  const char letter = find_letter(name);
  if (letter != '?' || name.size() < 2) return letter;
  // Amber marks termini: NALA, CALA, and DA5, RU3 for nucleotides.
  if (name.size() == 4 && (name[0] == 'N' || name[0] == 'C')) {
    const char inner = find_letter(name.substr(1));
    return inner >= 'A' && inner <= 'Z' ? inner : '?';
  }
  if (name.back() == '5' || name.back() == '3') {
    name.pop_back();
    const char inner = find_letter(name);
    return inner >= 'a' && inner <= 'z' ? inner : '?';
  }
  return '?';
}

bool same_residue_name(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const char letter = residue_letter(a);
  return letter != '?' && letter == residue_letter(b);
}

std::string normalized_atom_name(const std::string& atom_name, char letter) {
  std::string name = is_plain(atom_name) ? atom_name : in_todays_order(atom_name);
  if (letter == 'I' && name == "CD") return "CD1";
  if (letter == 'I' && name.size() == 3 && name.compare(0, 2, "HD") == 0) return "HD1" + name.substr(2);
  if (letter == 't' && name == "C5M") return "C7";  // thymine's methyl group before 2007
  const char* const synonym = synonym_of(name);
  return synonym == nullptr ? name : synonym;
}

bool is_heavy_atom_of(char letter, const std::string& atom_name) {
  static constexpr std::string_view kBackbone = " N CA C O OXT ";
  const std::string_view* const side_chain = side_chain_of(letter);
  const std::string word = " " + atom_name + " ";
  return side_chain == nullptr || kBackbone.find(word) != std::string_view::npos ||
         side_chain->find(word) != std::string_view::npos;
}

std::size_t n_heavy_atoms_of(char letter) {
  constexpr std::size_t kBackbone = 4;
  const std::string_view* const side_chain = side_chain_of(letter);
  if (side_chain == nullptr) return 0;
  return kBackbone + static_cast<std::size_t>(std::count(side_chain->begin(), side_chain->end(), ' ')) - 1;
}

std::vector<std::vector<std::size_t>> atoms_of_residues(const Molecule& molecule) {
  std::vector<std::vector<std::size_t>> atoms(molecule.residues.size());
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    atoms[static_cast<std::size_t>(molecule.atoms[i].residue)].push_back(i);
  }
  return atoms;
}

std::vector<ResidueKind> residue_kinds(const Molecule& molecule,
                                       const std::vector<std::vector<std::size_t>>& residue_atoms) {
  std::vector<ResidueKind> kinds;
  kinds.reserve(residue_atoms.size());
  std::vector<std::string> names;
  for (std::size_t r = 0; r < residue_atoms.size(); ++r) {
    names.clear();
    for (const std::size_t i : residue_atoms[r]) names.push_back(normalized_atom_name(molecule.atoms[i].name));
    kinds.push_back(kind_of(molecule.residues[r].name, names));
  }
  return kinds;
}

}  // namespace espdiff
