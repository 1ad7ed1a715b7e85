// read_topology.cpp: the !NATOM section of a PSF, and the flags ATOM_NAME, CHARGE and RADII of a prmtop.
#include "io/structures/read_topology.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/molecules/molecule_builder.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

void check_count(const std::string& path, long line, long long n) {
  if (n >= 1 && n <= static_cast<long long>(kMostAtoms)) return;
  throw FormatError(
      path, line,
      "the number of atoms is " + std::to_string(n) + "; 1 to " + std::to_string(kMostAtoms) + " were expected");
}

/// @param what "charge of atom 3"
void check_range(const std::string& path, long line, const std::string& what, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw FormatError(path, line, what + formatted(" is %g; %g to %g were expected", value, least, most));
}

/// Of the words of an atom. A residue's number may have an insertion code behind it.
AtomEntry psf_entry(const std::vector<std::string_view>& words, long line) {
  AtomEntry entry;
  std::string_view number = words[2];
  if (!number.empty() && (number.back() < '0' || number.back() > '9')) {
    entry.insertion_code = number.back();
    number.remove_suffix(1);
  }
  long long residue = 0;
  if (parse_integer(number, residue)) entry.residue_number = static_cast<int>(residue);
  entry.chain = words[1];
  entry.residue_name = words[3];
  entry.name = words[4];
  entry.line = line;
  return entry;
}

/// Words of an atom: number, segment, residue number, residue, atom, type, charge, mass.
/// @param builder receives the atoms with their residues; null to leave them out
void read_psf(const std::string& text, Topology& topology, MoleculeBuilder* builder) {
  TextCursor cursor(text, topology.path);
  while (!cursor.at_end()) {
    const auto words = split_words(cursor.rest_of_line());
    long long n = 0;
    if (words.size() < 2 || words[1].substr(0, 6) != "!NATOM" || !parse_integer(words[0], n)) continue;
    check_count(topology.path, cursor.line(), n);
    for (long long i = 0; i < n; ++i) {
      if (cursor.at_end())
        cursor.fail("the PSF ends after " + std::to_string(i) + " of " + std::to_string(n) + " atoms");
      const std::string_view line = cursor.rest_of_line();
      const auto atom = split_words(line);
      double charge = 0;
      if (atom.size() < 8 || !parse_number(atom[6], charge))
        cursor.fail("a PSF atom is " + in_quotes(line) +
                    "; number, segment, residue number, residue, atom, type, charge and mass were expected");
      check_range(topology.path, cursor.line(), "the charge", charge, -kLargestCharge, kLargestCharge);
      topology.names.emplace_back(atom[4]);
      topology.charges.push_back(static_cast<float>(charge));
      if (builder != nullptr) builder->add(psf_entry(atom, cursor.line()));
    }
    return;
  }
  throw FormatError(topology.path, 0, "the PSF has no !NATOM section; write it again");
}

/// The section of a prmtop's bonds without hydrogen: of each thrice the index of either atom, and a type.
constexpr const char* kHeavyBonds = "BONDS_WITHOUT_HYDROGEN";

/// A section of a prmtop: the fields of its lines, which have a fixed width.
struct Section {
  long line = 0;
  std::vector<std::string_view> fields;
};

/// The width in %FORMAT(20a4), %FORMAT(5E16.8) or %FORMAT(10I8); 0 where it cannot be read.
std::size_t field_width(std::string_view format) {
  const std::size_t open = format.find('(');
  if (open == std::string_view::npos) return 0;
  std::size_t at = open + 1;
  while (at < format.size() && format[at] >= '0' && format[at] <= '9') ++at;
  long long width = 0;
  const std::size_t end = format.find_first_of(".)", ++at);
  const bool known = end != std::string_view::npos && parse_integer(format.substr(at, end - at), width);
  return known && width > 0 ? static_cast<std::size_t>(width) : 0;
}

/// The sections that are read.
std::map<std::string, Section> prmtop_sections(const std::string& text) {
  constexpr const char* kRead[] = {"POINTERS",      "ATOM_NAME",       "CHARGE",   "RADII",
                                   "RESIDUE_LABEL", "RESIDUE_POINTER", kHeavyBonds};
  std::map<std::string, Section> sections;
  Section* section = nullptr;
  std::size_t width = 0;
  long number = 0;
  // Blanks at a line's beginning belong to its first field.
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.substr(0, 5) == "%FLAG") {
      const std::string_view flag = trimmed(line.substr(5));
      const bool is_read = std::find(std::begin(kRead), std::end(kRead), flag) != std::end(kRead);
      section = is_read ? &sections[std::string(flag)] : nullptr;
      if (is_read) section->line = number;
      width = 0;
    } else if (line.substr(0, 7) == "%FORMAT") {
      width = field_width(line);
    } else if (line.substr(0, 1) != "%" && section != nullptr && width > 0) {
      std::string_view rest = line;
      while (!rest.empty() && (rest.back() == '\r' || rest.back() == '\n')) rest.remove_suffix(1);
      // More atoms than kMostAtoms are refused later; until then they take no memory. Bonds are about as many, of
      // three.
      for (std::size_t at = 0; at < rest.size() && section->fields.size() <= 3 * kMostAtoms; at += width)
        section->fields.push_back(trimmed(rest.substr(at, width)));
    }
  }
  return sections;
}

/// @param least, most of the scaled numbers
std::vector<float> numbers_of(const std::string& path, const std::string& flag, const Section& section,
                              std::size_t n_atoms, double scale, double least, double most) {
  if (section.fields.size() < n_atoms)
    throw FormatError(path, section.line,
                      "%FLAG " + flag + " has " + std::to_string(section.fields.size()) + " values for " +
                          std::to_string(n_atoms) + " atoms; the file seems to be cut");
  std::vector<float> numbers;
  for (std::size_t i = 0; i < n_atoms; ++i) {
    double value = 0;
    if (!parse_number(section.fields[i], value))
      throw FormatError(path, section.line,
                        "%FLAG " + flag + ": value " + std::to_string(i + 1) + " is " + in_quotes(section.fields[i]) +
                            "; a number was expected");
    check_range(path, section.line, "%FLAG " + flag + ": value " + std::to_string(i + 1), value, least / scale,
                most / scale);
    numbers.push_back(static_cast<float>(value * scale));
  }
  return numbers;
}

/// The atoms of a prmtop's residue: begin .. end-1.
struct PrmtopResidue {
  std::string_view name;
  std::size_t begin = 0, end = 0;
};

/// By labels, and the number of the first atom of each, from 1.
std::vector<PrmtopResidue> prmtop_residues(const Topology& topology, std::map<std::string, Section>& sections) {
  const Section &labels = sections["RESIDUE_LABEL"], &firsts = sections["RESIDUE_POINTER"];
  std::vector<PrmtopResidue> residues;
  for (const std::string_view field : firsts.fields) {
    long long first = 0;
    const std::size_t least = residues.empty() ? 1 : residues.back().begin + 2;
    if (field.empty()) break;
    if (!parse_integer(field, first) || first < static_cast<long long>(least) || (residues.empty() && first != 1) ||
        first > static_cast<long long>(topology.names.size()))
      throw FormatError(topology.path, firsts.line,
                        "%FLAG RESIDUE_POINTER: value " + std::to_string(residues.size() + 1) + " is " +
                            in_quotes(field) + "; the number of the residue's first atom was expected");
    if (residues.size() == labels.fields.size())
      throw FormatError(topology.path, labels.line, "%FLAG RESIDUE_LABEL has fewer residues than RESIDUE_POINTER");
    if (!residues.empty()) residues.back().end = static_cast<std::size_t>(first - 1);
    residues.push_back({labels.fields[residues.size()], static_cast<std::size_t>(first - 1), topology.names.size()});
  }
  if (residues.empty())
    throw FormatError(topology.path, firsts.line, "the prmtop has no residues (%FLAG RESIDUE_POINTER)");
  return residues;
}

/// [residue] whether a bond leads to it from the residue before.
std::vector<bool> bonded_to_previous(const Topology& topology, const Section& bonds,
                                     const std::vector<PrmtopResidue>& residues) {
  std::vector<std::size_t> residue_of(topology.names.size());
  for (std::size_t r = 0; r < residues.size(); ++r)
    std::fill(residue_of.begin() + static_cast<std::ptrdiff_t>(residues[r].begin),
              residue_of.begin() + static_cast<std::ptrdiff_t>(residues[r].end), r);
  const auto residue_at = [&](std::size_t i) {
    long long value = 0;
    if (!parse_integer(bonds.fields[i], value) || value < 0 || value / 3 >= static_cast<long long>(residue_of.size()))
      throw FormatError(topology.path, bonds.line,
                        std::string("%FLAG ") + kHeavyBonds + ": value " + std::to_string(i + 1) + " is " +
                            in_quotes(bonds.fields[i]) + "; thrice the index of an atom was expected");
    return residue_of[static_cast<std::size_t>(value / 3)];
  };
  std::vector<bool> bonded(residues.size());
  for (std::size_t i = 0; i + 2 < bonds.fields.size() && !bonds.fields[i].empty(); i += 3) {
    const std::size_t first = residue_at(i), second = residue_at(i + 1);
    if (std::max(first, second) - std::min(first, second) == 1) bonded[std::max(first, second)] = true;
  }
  return bonded;
}

/// [residue] the chain, which a prmtop does not name: one begins where a peptide or nucleic acid does that no bond
/// joins to the residue before. What is neither, such as ions and water, belongs to the chain before it.
std::vector<std::size_t> prmtop_chains(const Topology& topology, const Section& bonds,
                                       const std::vector<PrmtopResidue>& residues) {
  std::vector<std::size_t> chain_of(residues.size());
  if (bonds.fields.empty()) return chain_of;
  const auto has = [&](const PrmtopResidue& residue, const char* name) {
    const auto begin = topology.names.begin() + static_cast<std::ptrdiff_t>(residue.begin),
               end = topology.names.begin() + static_cast<std::ptrdiff_t>(residue.end);
    return std::find(begin, end, name) != end;
  };
  const std::vector<bool> bonded = bonded_to_previous(topology, bonds, residues);
  std::size_t n_polymers = 0;
  for (std::size_t begin = 0, end = 0; begin < residues.size(); begin = end) {
    bool is_polymer = false;
    do {
      const PrmtopResidue& residue = residues[end];
      is_polymer = is_polymer || (has(residue, "CA") && has(residue, "C")) || has(residue, "C4'");
    } while (++end < residues.size() && bonded[end]);
    if (is_polymer) ++n_polymers;
    std::fill(chain_of.begin() + static_cast<std::ptrdiff_t>(begin),
              chain_of.begin() + static_cast<std::ptrdiff_t>(end), n_polymers == 0 ? 0 : n_polymers - 1);
  }
  return chain_of;
}

/// Adds the atoms by their residues. Where there are several chains, they are A, B, ...
void add_residues(const Topology& topology, std::map<std::string, Section>& sections, MoleculeBuilder& builder) {
  const std::vector<PrmtopResidue> residues = prmtop_residues(topology, sections);
  const std::vector<std::size_t> chain_of = prmtop_chains(topology, sections[kHeavyBonds], residues);
  AtomEntry entry;
  for (std::size_t r = 0; r < residues.size(); ++r) {
    entry.residue_name = residues[r].name;
    entry.residue_number = static_cast<int>(r + 1);
    entry.chain = chain_of.back() == 0 ? std::string() : chain_letter(chain_of[r]);
    for (std::size_t i = residues[r].begin; i < residues[r].end; ++i) {
      entry.name = topology.names[i];
      builder.add(entry);
    }
  }
}

/// @param builder receives the atoms with their residues; null to leave them out
void read_prmtop(const std::string& text, Topology& topology, MoleculeBuilder* builder) {
  constexpr double kAmberCharge = 18.2223;
  const std::string& path = topology.path;
  auto sections = prmtop_sections(text);
  for (const char* flag : {"POINTERS", "ATOM_NAME", "CHARGE"}) {
    if (sections.count(flag) == 0) throw FormatError(path, 0, std::string("the prmtop has no %FLAG ") + flag);
  }
  const Section &pointers = sections["POINTERS"], &names = sections["ATOM_NAME"];
  long long n = 0;
  if (pointers.fields.empty() || !parse_integer(pointers.fields[0], n))
    throw FormatError(path, pointers.line, "%FLAG POINTERS does not begin with the number of atoms");
  check_count(path, pointers.line, n);
  const auto n_atoms = static_cast<std::size_t>(n);
  topology.charges =
      numbers_of(path, "CHARGE", sections["CHARGE"], n_atoms, 1 / kAmberCharge, -kLargestCharge, kLargestCharge);
  if (sections.count("RADII") > 0)
    topology.radii = numbers_of(path, "RADII", sections["RADII"], n_atoms, 1, 0, kLargestRadius_A);
  // Made without a set of radii, a prmtop has zeros.
  if (std::all_of(topology.radii.begin(), topology.radii.end(), [](float r) { return r == 0; })) topology.radii.clear();
  if (names.fields.size() < n_atoms)
    throw FormatError(path, names.line,
                      "%FLAG ATOM_NAME has " + std::to_string(names.fields.size()) + " names for " +
                          std::to_string(n_atoms) + " atoms; the file seems to be cut");
  for (std::size_t i = 0; i < n_atoms; ++i) topology.names.emplace_back(names.fields[i]);
  if (builder != nullptr) add_residues(topology, sections, *builder);
}

/// @param builder see read_psf()
Topology read_atoms(const std::string& path, MoleculeBuilder* builder) {
  Topology topology;
  topology.path = path;
  FileKind kind = FileKind::kUnknownText;
  FileContent file = read_input(path, [&](std::string_view head) {
    kind = recognise(head);
    if (kind != FileKind::kPsf && kind != FileKind::kPrmtop)
      throw InputError(path + ": this looks like " + describe(kind) + ", which is not read as a topology; " +
                       (kind == FileKind::kTpr || kind == FileKind::kGromacsTopology
                            ? kGromacsRemedy
                            : "give a PSF or an Amber prmtop"));
  });
  unify_line_ends(file.content);
  topology.sha256 = file.sha256;
  if (kind == FileKind::kPsf) {
    read_psf(file.content, topology, builder);
  } else {
    read_prmtop(file.content, topology, builder);
  }
  return topology;
}

}  // namespace

Topology read_topology(const std::string& path) { return read_atoms(path, nullptr); }

Molecule read_topology_atoms(const std::string& path) {
  MoleculeBuilder builder(path, {1, true, true, {}});
  const Topology topology = read_atoms(path, &builder);
  Molecule molecule = builder.finish();
  take_topology(molecule, topology);
  return molecule;
}

void take_topology(Molecule& molecule, const Topology& topology) {
  if (topology.charges.size() != molecule.size())
    throw InputError(topology.path + ": has " + std::to_string(topology.charges.size()) + " atoms, and " +
                     molecule.name + " has " + std::to_string(molecule.size()) +
                     "; give the topology that the coordinates were made with");
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (topology.names[i] == molecule.atoms[i].name) continue;
    throw InputError(topology.path + ": atom " + std::to_string(i + 1) + " is " + in_quotes(topology.names[i]) +
                     ", and in " + molecule.name + " it is " + in_quotes(molecule.atoms[i].name) +
                     "; give the topology that the coordinates were made with");
  }
  molecule.charges = topology.charges;
  if (topology.radii.empty()) return;
  molecule.radii = topology.radii;
  molecule.radii_origin = ValueOrigin::kFile;
}

}  // namespace espdiff
