// write_pqr.cpp: the words of each line.
#include "io/write_pqr.h"

#include <charconv>

#include "base/error.h"
#include "io/write_csv.h"

namespace espdiff {
namespace {

std::string word(const std::string& name) {
  std::string result = name.empty() ? "X" : name;
  for (char& c : result) {
    if (c == ' ' || c == '\t') c = '_';
  }
  return result;
}

std::string number(double value) { return csv_number(value, 9); }

/// The shortest text that reads back as the same value: a charge of 0.33 is written as such.
std::string number(float value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

void write_pqr(std::ostream& out, const Molecule& molecule) {
  const std::size_t n = molecule.size();
  if (molecule.radii.size() != n || (!molecule.charges.empty() && molecule.charges.size() != n))
    throw InputError(molecule.name + ": " + std::to_string(molecule.radii.size()) + " radii and " +
                     std::to_string(molecule.charges.size()) + " charges for " + std::to_string(n) + " atoms");
  for (std::size_t i = 0; i < n; ++i) {
    const Atom& atom = molecule.atoms[i];
    const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
    const Vec3d& p = molecule.positions[i];
    out << (atom.hetero ? "HETATM " : "ATOM ") << i + 1 << ' ' << word(atom.name) << ' ' << word(residue.name);
    if (!residue.chain.empty()) out << ' ' << word(residue.chain);
    out << ' ' << residue.number;
    if (residue.insertion_code != ' ') out << residue.insertion_code;
    out << ' ' << number(p.x) << ' ' << number(p.y) << ' ' << number(p.z) << ' '
        << number(molecule.charges.empty() ? 0.0F : molecule.charges[i]) << ' ' << number(molecule.radii[i]) << '\n';
  }
  out << "END\n";
}

}  // namespace espdiff
