// caps.cpp: caps of chains have no charge, and leave their neighbours none.
#include "prepare/charges/caps.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "base/molecule/input_options.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/pdb2pqr.h"
#include "support/test_data.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

struct GivenAtom {
  const char *name, *residue;
  int number;
  double x, y, z;
};

std::string pdb_of(const std::vector<GivenAtom>& atoms) {
  std::string text;
  for (const GivenAtom& atom : atoms) {
    char line[96];
    std::snprintf(line, sizeof line, "ATOM      1  %-3s %3s A%4d    %8.3f%8.3f%8.3f  1.00  0.00           %c\n",
                  atom.name, atom.residue, atom.number, atom.x, atom.y, atom.z, atom.name[0]);
    text += line;
  }
  return text;
}

/// Extended alanine between what is given, in the plane z = 0 but for CB.
const std::vector<GivenAtom> kAlanine = {{"N", "ALA", 2, 0, 0, 0},
                                         {"CA", "ALA", 2, 1.46, 0, 0},
                                         {"CB", "ALA", 2, 1.97, -0.72, 1.23},
                                         {"C", "ALA", 2, 1.98, 1.43, 0},
                                         {"O", "ALA", 2, 1.20, 2.38, 0}};
const std::vector<GivenAtom> kAcetyl = {
    {"CH3", "ACE", 1, -2.17, 0.98, 0}, {"C", "ACE", 1, -0.69, 1.14, 0}, {"O", "ACE", 1, -0.17, 2.25, 0}};

std::vector<GivenAtom> chain(std::vector<GivenAtom> atoms, const std::vector<GivenAtom>& middle,
                             const std::vector<GivenAtom>& end) {
  atoms.insert(atoms.end(), middle.begin(), middle.end());
  atoms.insert(atoms.end(), end.begin(), end.end());
  return atoms;
}

struct Sums {
  double of_residue[3] = {0, 0, 0};
  std::size_t n_atoms[3] = {0, 0, 0};
};

Sums sums_of(const Molecule& molecule) {
  REQUIRE(molecule.residues.size() == 3);
  Sums sums;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const auto r = static_cast<std::size_t>(molecule.atoms[i].residue);
    sums.of_residue[r] += static_cast<double>(molecule.charges[i]);
    ++sums.n_atoms[r];
  }
  return sums;
}

Prepared prepare_text(const std::string& text, const std::string& force_field) {
  const ScratchFolder folder;
  ChargeOptions options;
  options.force_field = force_field;
  options.use_cache = false;
  return prepare_molecule(read_structure(folder.write("in.pdb", text), {}), options, {}, {});
}

bool lacks_pdb2pqr() {
  if (!find_pdb2pqr().empty()) return false;
  MESSAGE("SKIPPED: no PDB2PQR; ", kPdb2pqrRemedy);
  return true;
}

}  // namespace

TEST_CASE(
    "prepare_molecule: acetyl, N-methylamide and amide by the PDB's names have net charge 0, and so has the chain") {
  if (lacks_pdb2pqr()) return;
  for (const char* const force_field : {"parse", "amber", "charmm"}) {
    CAPTURE(force_field);
    const std::string methyl =
        pdb_of(chain(kAcetyl, kAlanine, {{"N", "NME", 3, 3.30, 1.55, 0}, {"C", "NME", 3, 3.98, 2.84, 0}}));
    const Prepared with_methyl = prepare_text(methyl, force_field);
    const Sums sums = sums_of(with_methyl.molecule);
    for (const double sum : sums.of_residue) CHECK(sum == doctest::Approx(0).epsilon(1e-5));
    CHECK(sums.n_atoms[0] == 3);
    CHECK(sums.n_atoms[1] == 10);  // no second oxygen, one hydrogen at N
    CHECK(sums.n_atoms[2] == 3);
    const Prepared with_amide =
        prepare_text(pdb_of(chain(kAcetyl, kAlanine, {{"N", "NH2", 3, 3.30, 1.55, 0}})), force_field);
    const Sums amide = sums_of(with_amide.molecule);
    CHECK(amide.n_atoms[1] == 10);
    REQUIRE(amide.n_atoms[2] == 3);
    CHECK(amide.of_residue[2] == doctest::Approx(0).epsilon(1e-5));
    const Molecule& molecule = with_amide.molecule;
    const std::size_t n = molecule.size() - 3;
    const double bond = norm(molecule.positions[n + 1] - molecule.positions[n]);
    CHECK(bond == doctest::Approx(1.01));
    CHECK(norm(molecule.positions[n + 2] - molecule.positions[n + 1]) == doctest::Approx(std::sqrt(3.0) * bond));
  }
}

TEST_CASE("prepare_molecule: a group that takes the place of a charged end is neutral where it is an amide") {
  if (lacks_pdb2pqr() || find_open_babel().empty()) return;
  // Ethanolamine, as in gramicidin: alone it would be ammonium, and alanine a carboxylate.
  const std::string text = pdb_of(chain(kAcetyl, kAlanine,
                                        {{"N", "ETA", 3, 3.30, 1.55, 0},
                                         {"C1", "ETA", 3, 3.98, 2.84, 0},
                                         {"C2", "ETA", 3, 5.49, 2.68, 0},
                                         {"O", "ETA", 3, 6.15, 3.94, 0}}));
  const Prepared prepared = prepare_text(text, "parse");
  const Sums sums = sums_of(prepared.molecule);
  CHECK(sums.of_residue[1] == doctest::Approx(0).epsilon(1e-5));
  CHECK(sums.of_residue[2] == doctest::Approx(0).epsilon(1e-5));
  CHECK(sums.n_atoms[1] == 10);
}
