// write_pqr.cpp: the words of each line.
#include "io/molecules/write_pqr.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "io/files/write_csv.h"

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

/// The value at three decimals is the value, and needs no more than 8 columns with a blank before it.
bool fits_coordinate(double x) {
  constexpr double kLow = -99.9995, kHigh = 999.9995;
  return x > kLow && x < kHigh && static_cast<float>(std::round(1000 * x) / 1000) == static_cast<float>(x);
}

/// Eight columns with three decimals, or a blank and as many digits as the number needs: VMD and APBS read both.
std::string coordinate(double x) { return fits_coordinate(x) ? formatted("%8.3f", x) : ' ' + number(x); }

/// Names and numbers in the columns of a PDB file. Serial numbers begin anew behind the largest that fits.
std::string pdb_columns(const Molecule& molecule, std::size_t i) {
  constexpr std::size_t kSerials = 100000;
  const Atom& atom = molecule.atoms[i];
  const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
  const std::string name = word(atom.name), chain = residue.chain.empty() ? " " : word(residue.chain);
  const Vec3d& p = molecule.positions[i];
  return formatted("%-6s%5d %-4s %3s %s%4d%c   ", atom.hetero ? "HETATM" : "ATOM", static_cast<int>((i + 1) % kSerials),
                   (name.size() < 4 ? " " + name : name).c_str(), word(residue.name).c_str(), chain.c_str(),
                   static_cast<int>(residue.number), residue.insertion_code) +
         coordinate(p.x) + coordinate(p.y) + coordinate(p.z);
}

/// The same separated by single blanks, for names and numbers of any length.
std::string free_fields(const Molecule& molecule, std::size_t i) {
  const Atom& atom = molecule.atoms[i];
  const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
  const Vec3d& p = molecule.positions[i];
  std::string line =
      (atom.hetero ? "HETATM " : "ATOM ") + std::to_string(i + 1) + ' ' + word(atom.name) + ' ' + word(residue.name);
  if (!residue.chain.empty()) line += ' ' + word(residue.chain);
  line += ' ' + std::to_string(residue.number);
  if (residue.insertion_code != ' ') line += residue.insertion_code;
  return line + ' ' + number(p.x) + ' ' + number(p.y) + ' ' + number(p.z);
}

}  // namespace

bool fits_pdb_columns(const Molecule& molecule) {
  constexpr std::size_t kMostName = 4, kMostResidueName = 3;
  constexpr std::int32_t kLow = -999, kHigh = 9999;
  return std::all_of(molecule.residues.begin(), molecule.residues.end(),
                     [](const Residue& residue) {
                       return residue.name.size() <= kMostResidueName && residue.chain.size() <= 1 &&
                              residue.number >= kLow && residue.number <= kHigh;
                     }) &&
         std::all_of(molecule.atoms.begin(), molecule.atoms.end(),
                     [](const Atom& atom) { return atom.name.size() <= kMostName; });
}

void write_pqr(std::ostream& out, const Molecule& molecule) {
  const std::size_t n = molecule.size();
  if (molecule.radii.size() != n || (!molecule.charges.empty() && molecule.charges.size() != n))
    throw InputError(molecule.name + ": " + std::to_string(molecule.radii.size()) + " radii and " +
                     std::to_string(molecule.charges.size()) + " charges for " + std::to_string(n) + " atoms");
  const bool in_columns = fits_pdb_columns(molecule);
  for (std::size_t i = 0; i < n; ++i) {
    out << (in_columns ? pdb_columns(molecule, i) : free_fields(molecule, i)) << ' '
        << number(molecule.charges.empty() ? 0.0F : molecule.charges[i]) << ' ' << number(molecule.radii[i]) << '\n';
  }
  out << "END\n";
}

}  // namespace espdiff
