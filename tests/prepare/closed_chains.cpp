// Chains without ends: found by their bonds, and charged alike all around.
#include "prepare/charges/closed_chains.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/molecule/input_options.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/pdb2pqr.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::ScratchFolder;

namespace {

/// The backbone of n glycines around a circle, as the text of a PDB file. @param n_left_out of the last ones
std::string glycines(int n, int n_left_out = 0) {
  constexpr double kTwoPi = 6.283185307179586, kBond_A = 1.43;
  const int n_atoms = 3 * n;
  const double radius = kBond_A / (2 * std::sin(kTwoPi / (2 * n_atoms)));
  std::string text;
  int serial = 0;
  const auto add = [&](const char* name, int residue, double angle, double r, double z) {
    char line[96];
    std::snprintf(line, sizeof line, "ATOM  %5d  %-3s GLY A%4d    %8.3f%8.3f%8.3f  1.00  0.00           %c\n", ++serial,
                  name, residue, r * std::cos(angle), r * std::sin(angle), z, name[0]);
    text += line;
  };
  for (int residue = 0; residue < n - n_left_out; ++residue) {
    const auto angle = [&](int atom) { return kTwoPi * (3 * residue + atom) / n_atoms; };
    const double up = residue % 2 == 0 ? 1 : -1;
    add("N", residue + 1, angle(0), radius, 0);
    add("CA", residue + 1, angle(1), radius, 0);
    add("C", residue + 1, angle(2), radius, 0);
    add("O", residue + 1, angle(2), radius + 0.6, up);
  }
  return text;
}

Molecule read(const std::string& text) {
  const ScratchFolder folder;
  return read_structure(folder.write("ring.pdb", text), {1, true, false, {}});
}

/// [residue] charges by the atoms' names.
std::vector<std::map<std::string, float>> charges_of(const Molecule& molecule) {
  std::vector<std::map<std::string, float>> charges(molecule.residues.size());
  for (std::size_t i = 0; i < molecule.size(); ++i)
    charges[static_cast<std::size_t>(molecule.atoms[i].residue)][molecule.atoms[i].name] = molecule.charges[i];
  return charges;
}

}  // namespace

TEST_CASE("closed_chains: rings of four residues or more, in the order of the file") {
  CHECK(closed_chains(read(glycines(8))) == std::vector<ClosedChain>{{0, 1, 2, 3, 4, 5, 6, 7}});
  CHECK(closed_chains(read(glycines(4))).size() == 1);
  CHECK(closed_chains(read(glycines(3))).empty());
  CHECK(closed_chains(read(glycines(9, 1))).empty());
  CHECK(closed_chains(Molecule{}).empty());
}

TEST_CASE("closed chains are opened at their middle, and only they") {
  CHECK(from_the_middle({{1, 2, 3, 4, 5}}, 7) == std::vector<std::size_t>{0, 3, 4, 5, 1, 2, 6});
  const Molecule ring = read(glycines(6));
  const std::vector<std::size_t> order = from_the_middle(closed_chains(ring), 6);
  const Molecule opened = in_order(ring, order);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    CHECK(opened.residues[static_cast<std::size_t>(opened.atoms[i].residue)].number ==
          ring.residues[static_cast<std::size_t>(ring.atoms[i].residue)].number);
  }
  CHECK(opened.residues.front().number == 4);
  CHECK(from_the_middle({}, 2) == std::vector<std::size_t>{0, 1});
}

TEST_CASE("prepare_molecule: a closed chain gets no charged ends, with any force field") {
  if (find_pdb2pqr().empty()) {
    MESSAGE("SKIPPED: no PDB2PQR; ", kPdb2pqrRemedy);
    return;
  }
  for (const char* force_field : {"parse", "amber"}) {
    ChargeOptions options;
    options.use_cache = false;
    options.force_field = force_field;
    for (const int n : {9, 12}) {
      const Prepared ring = prepare_molecule(read(glycines(n)), options, {}, Progress());
      const auto charges = charges_of(ring.molecule);
      REQUIRE(charges.size() == static_cast<std::size_t>(n));
      CHECK(charges[0].size() == 7);  // N, CA, C, O, H, HA2, HA3
      for (const auto& of_residue : charges) CHECK(of_residue == charges[0]);
      CHECK(ring.preparation.net_charge == doctest::Approx(0).epsilon(1e-4));
      const auto& notes = ring.preparation.notes;
      CHECK(std::count(notes.begin(), notes.end(), "chain A is closed, and gets no charged ends") == 1);
      const Prepared open = prepare_molecule(read(glycines(n + 1, 1)), options, {}, Progress());
      CHECK(charges_of(open.molecule)[0].count("H2") == 1);
      CHECK(charges_of(open.molecule).back().count("OXT") == 1);
      CHECK(charges_of(open.molecule)[static_cast<std::size_t>(n / 2)] == charges[0]);
    }
  }
}
