// read_mol2.cpp: the ATOM section: number, name, x, y, z, type.
#include "io/structures/read_mol2.h"

#include <algorithm>
#include <cmath>

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
void require_memory_for_atoms(const Mol2File& file) {
  const auto n_lines = std::count(file.content.begin(), file.content.end(), '\n');
  const double n_atoms = std::min(static_cast<double>(n_lines), static_cast<double>(kMostAtoms));
  require_memory(3.0 * sizeof(Mol2Atom) * n_atoms, file.path);
}

}  // namespace

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
  require_memory_for_atoms(file);
  bool in_atoms = false;
  long number = 0;
  TextCursor cursor(file.content, path);
  while (!cursor.at_end()) {
    const std::string_view line = cursor.rest_of_line();
    number = cursor.line();
    if (line.substr(0, 9) == "@<TRIPOS>") {
      if (in_atoms) break;
      in_atoms = trimmed(line) == "@<TRIPOS>ATOM";
      continue;
    }
    if (!in_atoms || trimmed(line).empty() || line[0] == '#') continue;
    const auto words = split_words(line);
    Mol2Atom atom;
    if (words.size() < 6 || !parse_number(words[2], atom.position.x) || !parse_number(words[3], atom.position.y) ||
        !parse_number(words[4], atom.position.z))
      throw FormatError(path, number,
                        "a MOL2 atom is " + in_quotes(line) + "; number, name, x, y, z and type were expected");
    if (!is_near(atom.position))
      throw FormatError(path, number,
                        "a MOL2 atom is " + in_quotes(line) + "; coordinates of at most 10^6 Angstrom were expected");
    if (file.atoms.size() == kMostAtoms)
      throw InputError(path + ": has more than " + std::to_string(kMostAtoms) +
                       " atoms, which is the most that are read");
    atom.name = words[1];
    atom.element = words[5].substr(0, words[5].find('.'));
    constexpr std::size_t kChargeColumn = 8;
    if (words.size() > kChargeColumn && !parse_number(words[kChargeColumn], atom.charge)) atom.charge = 0;
    file.atoms.push_back(std::move(atom));
  }
  if (file.atoms.empty()) throw InputError(path + ": has no @<TRIPOS>ATOM section; give a MOL2 file with atoms");
  return file;
}

}  // namespace espdiff
