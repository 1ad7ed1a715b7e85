// write_pdb.cpp: columns of the PDB format.
#include "io/molecules/write_pdb.h"

#include <cmath>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

/// "CA" of carbon begins in the second of the four columns, "CA" of calcium and names of four letters in the first.
std::string atom_name(const Atom& atom) {
  const bool indent = atom.name.size() < 4 && atom.element.size() < 2;
  return (indent ? " " : "") + atom.name.substr(0, 4);
}

std::string upper(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

std::string described(const Molecule& molecule, std::size_t i) {
  const Residue& residue = molecule.residues[static_cast<std::size_t>(molecule.atoms[i].residue)];
  return molecule.name + ", atom " + molecule.atoms[i].name + " of " + residue.name + std::to_string(residue.number);
}

void check(const Molecule& molecule, std::size_t i, double value) {
  constexpr double kLow = -99.995, kHigh = 999.995;  // F6.2
  if (!std::isnan(value) && !(value > kLow && value < kHigh)) {
    throw InputError(described(molecule, i) + ": the value " + formatted(value) +
                     " does not fit into a B factor (-99.99 to 999.99); give the maps in a larger unit, such as kT/e");
  }
  for (const double x : {molecule.positions[i].x, molecule.positions[i].y, molecule.positions[i].z}) {
    if (!(x > -999.9995 && x < 9999.9995))
      throw InputError(described(molecule, i) + ": a coordinate does not fit into a PDB file (-999.999 to 9999.999)");
  }
}

}  // namespace

void write_pdb(std::ostream& out, const Molecule& molecule, const std::vector<double>& values,
               const std::vector<std::string>& remarks) {
  if (values.size() != molecule.size())
    throw InputError(molecule.name + ": " + std::to_string(values.size()) + " values for " +
                     std::to_string(molecule.size()) + " atoms");
  for (const std::string& remark : remarks) out << "REMARK  99 " << remark << '\n';
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    check(molecule, i, values[i]);
    const Atom& atom = molecule.atoms[i];
    const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
    const Vec3d& p = molecule.positions[i];
    const bool known = !std::isnan(values[i]);
    out << formatted("%-6s%5d %-4s %-4.4s%c%4d%c   %8.3f%8.3f%8.3f%6.2f%6.2f      %-4.4s%2.2s\n",
                     atom.hetero ? "HETATM" : "ATOM", static_cast<int>((i + 1) % 100000), atom_name(atom).c_str(),
                     residue.name.size() < 4 ? (std::string(3 - residue.name.size(), ' ') + residue.name).c_str()
                                             : residue.name.c_str(),
                     residue.chain.empty() ? ' ' : residue.chain[0], static_cast<int>(residue.number % 10000),
                     residue.insertion_code, p.x, p.y, p.z, known ? 1.0 : 0.0, known ? values[i] : 0.0,
                     residue.chain.size() > 1 ? residue.chain.c_str() : "", upper(atom.element).c_str());
  }
  out << "END\n";
}

}  // namespace espdiff
