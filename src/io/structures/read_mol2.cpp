// read_mol2.cpp: the sections MOLECULE, ATOM, BOND (number, two atoms, type) and SUBSTRUCTURE.
#include "io/structures/read_mol2.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/molecules/molecule_builder.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

constexpr double kMostCoordinate_A = 1e6;

bool is_near(const Vec3d& p) {
  return std::fabs(p.x) <= kMostCoordinate_A && std::fabs(p.y) <= kMostCoordinate_A &&
         std::fabs(p.z) <= kMostCoordinate_A;
}

/// An atom is a line, and the list of atoms doubles as it grows.
void require_memory_for_atoms(const std::string& path, const std::string& text) {
  const auto n_lines = std::count(text.begin(), text.end(), '\n');
  const double n_atoms = std::min(static_cast<double>(n_lines), static_cast<double>(kMostAtoms));
  require_memory(3.0 * sizeof(Mol2Atom) * n_atoms, path);
}

/// Number, name, x, y, z, type, and mostly number and name of the substructure and the charge.
Mol2Atom read_atom(const std::string& path, std::string_view line, long number) {
  const auto words = split_words(line);
  Mol2Atom atom;
  if (words.size() < 6 || !parse_number(words[2], atom.position.x) || !parse_number(words[3], atom.position.y) ||
      !parse_number(words[4], atom.position.z))
    throw FormatError(path, number,
                      "a MOL2 atom is " + in_quotes(line) + "; number, name, x, y, z and type were expected");
  if (!is_near(atom.position))
    throw FormatError(path, number,
                      "a MOL2 atom is " + in_quotes(line) + "; coordinates of at most 10^6 Angstrom were expected");
  atom.name = words[1];
  atom.type = words[5];
  atom.element = atom.type.substr(0, atom.type.find('.'));
  atom.line = number;
  constexpr std::size_t kSubstructureColumn = 6, kChargeColumn = 8;
  long long substructure = 0;
  if (words.size() > kSubstructureColumn && parse_integer(words[kSubstructureColumn], substructure) &&
      std::abs(substructure) <= std::numeric_limits<int>::max())
    atom.substructure = static_cast<int>(substructure);
  if (words.size() > kSubstructureColumn + 1) atom.substructure_name = words[kSubstructureColumn + 1];
  atom.has_charge = words.size() > kChargeColumn && parse_number(words[kChargeColumn], atom.charge);
  if (!atom.has_charge) atom.charge = 0;
  return atom;
}

/// Number, name, first atom, type, dictionary, chain, ...; "****" where there is nothing.
void read_substructure(std::string_view line, Mol2Molecule& molecule) {
  constexpr std::size_t kChainColumn = 5;
  const auto words = split_words(line);
  long long number = 0;
  if (words.size() <= kChainColumn || !parse_integer(words[0], number)) return;
  const std::string_view chain = words[kChainColumn];
  if (chain.find_first_not_of('*') != std::string_view::npos)
    molecule.chains[static_cast<int>(number)] = std::string(chain);
}

}  // namespace

std::vector<Mol2Molecule> mol2_molecules(const std::string& path, const std::string& text, std::size_t most) {
  require_memory_for_atoms(path, text);
  std::vector<Mol2Molecule> molecules;
  std::string section;
  std::size_t n_atoms = 0;
  bool starts = false;  // a molecule, whose atoms come
  bool has_charges = true;
  TextCursor cursor(text, path);
  while (!cursor.at_end()) {
    const std::string_view line = cursor.rest_of_line();
    if (line.substr(0, 9) == "@<TRIPOS>") {
      section = trimmed(line.substr(9));
      if (section == "MOLECULE") has_charges = true;
      starts = section == "ATOM";
      if (starts && molecules.size() == most) break;
      continue;
    }
    if (trimmed(line).empty() || line[0] == '#') continue;
    if (section == "MOLECULE" && trimmed(line) == "NO_CHARGES") has_charges = false;
    if (section == "SUBSTRUCTURE" && !molecules.empty()) read_substructure(line, molecules.back());
    if (section != "ATOM") continue;
    if (starts) molecules.push_back({{}, has_charges, {}});
    starts = false;
    if (++n_atoms > kMostAtoms)
      throw InputError(path + ": has more than " + std::to_string(kMostAtoms) +
                       " atoms, which is the most that are read");
    molecules.back().atoms.push_back(read_atom(path, line, cursor.line()));
  }
  if (molecules.empty()) throw InputError(path + ": has no @<TRIPOS>ATOM section; give a MOL2 file with atoms");
  return molecules;
}

Mol2File read_mol2(const std::string& path) {
  Mol2File file;
  file.path = path;
  file.content = read_input(path, [&](std::string_view head) {
                   const FileKind kind = recognise(head);
                   if (kind != FileKind::kMol2)
                     throw InputError(path + ": this looks like " + describe(kind) +
                                      ", and a ligand is read from a Tripos MOL2 file; convert it, with hydrogens");
                 }).content;
  unify_line_ends(file.content);
  file.atoms = std::move(mol2_molecules(path, file.content, 1).front().atoms);
  return file;
}

std::vector<Mol2Bond> read_mol2_bonds(const Mol2File& file) {
  std::vector<Mol2Bond> bonds;
  bool in_bonds = false;
  TextCursor cursor(file.content, file.path);
  while (!cursor.at_end()) {
    const std::string_view line = cursor.rest_of_line();
    if (line.substr(0, 9) == "@<TRIPOS>") {
      if (in_bonds) break;
      in_bonds = trimmed(line) == "@<TRIPOS>BOND";
      continue;
    }
    if (!in_bonds || trimmed(line).empty() || line[0] == '#') continue;
    const auto words = split_words(line);
    double a = 0, b = 0;
    const auto is_atom = [&](double number) {
      return number >= 1 && number <= static_cast<double>(file.atoms.size()) && number == std::floor(number);
    };
    if (words.size() < 4 || !parse_number(words[1], a) || !parse_number(words[2], b) || !is_atom(a) || !is_atom(b) ||
        a == b)
      throw FormatError(file.path, cursor.line(),
                        "a MOL2 bond is " + in_quotes(line) + "; number, two of the " +
                            std::to_string(file.atoms.size()) + " atoms, and type were expected");
    bonds.push_back({static_cast<std::size_t>(a) - 1, static_cast<std::size_t>(b) - 1});
  }
  return bonds;
}

}  // namespace espdiff
