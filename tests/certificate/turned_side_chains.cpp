// turned_side_chains.cpp: which atoms count as turned, on a lysine and a tyrosine made by hand, and the area they have.
#include "certificate/turned_side_chains.h"
#include "certificate/slip.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/molecule/screw.h"
#include "certificate/result.h"

using espdiff::Molecule;
using espdiff::Turn;
using espdiff::TurnedAtom;
using espdiff::Vec3d;

namespace {

struct NamedPlace {
  const char* name;
  const char* element;
  Vec3d at;
};

Molecule residue_of(const std::string& name, const std::vector<NamedPlace>& places) {
  Molecule molecule;
  molecule.residues.push_back({name, "A", 118, ' '});
  for (const NamedPlace& place : places) {
    espdiff::Atom atom;
    atom.name = place.name;
    atom.element = place.element;
    molecule.atoms.push_back(atom);
    molecule.positions.push_back(place.at);
  }
  return molecule;
}

Molecule lysine() {
  return residue_of("LYS", {{"N", "N", {-1.4, 0.3, 0}},
                            {"CA", "C", {0, 0, 0}},
                            {"C", "C", {0.6, 1.2, -0.7}},
                            {"O", "O", {1.0, 2.2, -0.1}},
                            {"CB", "C", {0.4, 0, 1.5}},
                            {"HB2", "H", {0.1, -0.9, 1.9}},
                            {"CG", "C", {-0.2, 1.2, 2.2}},
                            {"CD", "C", {0.3, 1.3, 3.6}},
                            {"CE", "C", {-0.3, 2.5, 4.3}},
                            {"NZ", "N", {0.2, 2.6, 5.7}}});
}

/// Turned by `degrees` about the bond of two atoms, from the atom `first` on.
Molecule turned(Molecule molecule, std::size_t a, std::size_t b, std::size_t first, double degrees) {
  espdiff::Screw screw;
  const Vec3d bond = molecule.positions[b] - molecule.positions[a];
  screw.axis = (1 / norm(bond)) * bond;
  screw.through = molecule.positions[b];
  screw.angle = degrees * espdiff::kPi / 180;
  for (std::size_t i = first; i < molecule.size(); ++i) molecule.positions[i] = screw.apply(molecule.positions[i], 1);
  return molecule;
}

espdiff::AtomPairing all_paired(const Molecule& molecule) {
  espdiff::AtomPairing pairing;
  for (std::size_t i = 0; i < molecule.size(); ++i) pairing.pairs.emplace_back(i, i);
  return pairing;
}

std::string names_of_turned(const Molecule& source, const Molecule& target) {
  const std::vector<TurnedAtom> atoms = espdiff::turned_atoms(source, target, all_paired(source));
  std::string names;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (atoms[i].turn == Turn::kSideChain) names += (names.empty() ? "" : " ") + source.atoms[i].name;
  }
  return names;
}

}  // namespace

TEST_SUITE("compare.turned_side_chains") {
  TEST_CASE("a rotamer turns the atoms beyond its bond, whatever the molecules' frames") {
    const Molecule source = lysine();
    CHECK(names_of_turned(source, source).empty());
    CHECK(names_of_turned(source, turned(source, 1, 4, 5, 120)) == "CB HB2 CG CD CE NZ");
    CHECK(names_of_turned(source, turned(source, 4, 6, 7, -120)) == "CG CD CE NZ");
    CHECK(names_of_turned(source, turned(source, 1, 4, 5, 40)).empty());
    Molecule moved = turned(source, 1, 4, 5, 120);
    for (Vec3d& p : moved.positions) p = Vec3d{7, 0, 0} + Vec3d{-p.y, p.x, p.z};
    CHECK(names_of_turned(source, moved) == "CB HB2 CG CD CE NZ");
  }

  TEST_CASE("half a turn that exchanges equal atoms is none, a quarter is one") {
    const Molecule source = residue_of("TYR", {{"N", "N", {-1.4, 0.3, 0}},
                                               {"CA", "C", {0, 0, 0}},
                                               {"C", "C", {0.6, 1.2, -0.7}},
                                               {"CB", "C", {0, 0, 1.5}},
                                               {"CG", "C", {0, 1.2, 2.4}},
                                               {"CD1", "C", {1.2, 1.6, 3.0}},
                                               {"CD2", "C", {-1.2, 1.6, 3.0}}});
    CHECK(names_of_turned(source, turned(source, 3, 4, 5, 180)).empty());
    CHECK(names_of_turned(source, turned(source, 3, 4, 5, 90)) == "CG CD1 CD2");
    Molecule other = source;
    other.residues[0].name = "UNK";  // of which nobody knows that they are equal
    CHECK(names_of_turned(other, turned(other, 3, 4, 5, 180)) == "CG CD1 CD2");
  }

  TEST_CASE("without its backbone nothing is known of a side chain") {
    Molecule source = lysine();
    source.atoms[2].name = "CX";
    CHECK(names_of_turned(source, turned(source, 1, 4, 5, 120)).empty());
    for (const TurnedAtom& atom : espdiff::turned_atoms(lysine(), lysine(), {})) CHECK(atom.turn == Turn::kNone);
  }

  TEST_CASE("what turned carries its atoms and their neighbours to where they went") {
    const Molecule source = lysine(), target = turned(source, 4, 6, 7, -120);
    const std::vector<TurnedAtom> atoms = espdiff::turned_atoms(source, target, all_paired(source));
    for (const std::size_t i : {6U, 7U, 8U, 9U}) {
      for (const std::size_t beside : {6U, 7U, 8U, 9U}) {
        const Vec3d off = atoms[i].carried.apply(source.positions[beside]) - target.positions[beside];
        CHECK(norm(off) < 1e-9);
      }
    }
  }

  TEST_CASE("a residue turned against those around it turned as a whole") {
    Molecule source;
    for (std::int32_t r = 0; r < 8; ++r) {  // CA on the corners of a cube of 5 A
      source.residues.push_back({"ALA", "A", r + 1, ' '});
      const Vec3d ca{5.0 * (r % 2), 5.0 * (r / 2 % 2), 5.0 * (r / 4)};
      for (const NamedPlace& place : {NamedPlace{"N", "N", {-1.4, 0.3, 0}}, NamedPlace{"CA", "C", {0, 0, 0}},
                                      NamedPlace{"C", "C", {0.6, 1.2, -0.7}}, NamedPlace{"CB", "C", {0.4, 0, 1.5}}}) {
        espdiff::Atom atom;
        atom.name = place.name;
        atom.element = place.element;
        atom.residue = r;
        source.atoms.push_back(atom);
        source.positions.push_back(ca + place.at);
      }
    }
    const auto with_first_turned = [&](double degrees) {
      Molecule target = source;
      const double angle = degrees * espdiff::kPi / 180;
      for (std::size_t i = 0; i < 4; ++i) {  // about z
        const Vec3d p = target.positions[i];
        target.positions[i] = {std::cos(angle) * p.x - std::sin(angle) * p.y,
                               std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
      }
      for (Vec3d& p : target.positions) p = Vec3d{7, 0, 0} + Vec3d{-p.y, p.x, p.z};  // another frame
      return espdiff::turned_atoms(source, target, all_paired(source));
    };
    for (const TurnedAtom& atom : with_first_turned(45)) CHECK(atom.turn == Turn::kNone);
    const std::vector<TurnedAtom> atoms = with_first_turned(90);
    for (std::size_t i = 0; i < atoms.size(); ++i) CHECK(atoms[i].turn == (i < 4 ? Turn::kResidue : Turn::kNone));
    // A quarter about z here, and one of the frame: half a turn in all.
    CHECK(norm(atoms[0].carried.apply({1, 2, 3}) - Vec3d{6, -2, 3}) < 1e-9);
  }

  TEST_CASE("a ligand turned by half a turn turned as a whole, unless the turn puts it onto itself") {
    // Eight CA on the corners of a cube around a flat ring of six atoms and what is bound to it.
    const auto with_ligand = [](const char* at_first, bool has_tail) {
      Molecule molecule;
      for (std::int32_t r = 0; r < 8; ++r) {
        molecule.residues.push_back({"ALA", "A", r + 1, ' '});
        espdiff::Atom ca;
        ca.name = "CA";
        ca.element = "C";
        ca.residue = r;
        molecule.atoms.push_back(ca);
        molecule.positions.push_back({10.0 * (r % 2) - 5, 10.0 * (r / 2 % 2) - 5, 10.0 * (r / 4) - 5});
      }
      molecule.residues.push_back({"LIG", "A", 9, ' '});
      for (int k = 0; k < (has_tail ? 7 : 6); ++k) {
        espdiff::Atom atom;
        atom.name = "X" + std::to_string(k);
        atom.element = k == 0 ? at_first : "C";
        atom.residue = 8;
        molecule.atoms.push_back(atom);
        const double angle = k * espdiff::kPi / 3, radius = k == 6 ? 2.9 : 1.4;  // the tail is at the first atom
        molecule.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
      }
      return molecule;
    };
    const auto half_turn = [](Molecule molecule, std::size_t first) {  // about y, of the ligand
      for (std::size_t i = first; i < molecule.size(); ++i)
        molecule.positions[i] = {-molecule.positions[i].x, molecule.positions[i].y, -molecule.positions[i].z};
      for (Vec3d& p : molecule.positions) p = Vec3d{7, 0, 0} + Vec3d{-p.y, p.x, p.z};  // another frame
      return molecule;
    };
    const auto n_turned = [](const Molecule& source, const Molecule& target) {
      std::size_t n = 0;
      for (const TurnedAtom& atom : espdiff::turned_atoms(source, target, all_paired(source)))
        n += atom.turn == Turn::kResidue ? 1 : 0;
      return n;
    };
    const Molecule benzene = with_ligand("C", false), pyridine = with_ligand("N", false),
                   toluene = with_ligand("C", true);
    CHECK(n_turned(benzene, half_turn(benzene, 8)) == 0);  // other names, the same places
    CHECK(n_turned(pyridine, half_turn(pyridine, 8)) == 6);
    CHECK(n_turned(toluene, half_turn(toluene, 8)) == 7);
    for (const Molecule& ligand : {benzene, pyridine, toluene})
      CHECK(n_turned(ligand, half_turn(ligand, ligand.size())) == 0);
    const std::vector<TurnedAtom> atoms = espdiff::turned_atoms(toluene, half_turn(toluene, 8), all_paired(toluene));
    CHECK(atoms[0].turn == Turn::kNone);
    // Half a turn about y here, then the other frame.
    CHECK(norm(atoms[8].carried.apply({1, 2, 3}) - Vec3d{5, -1, -3}) < 1e-9);
    // Three heavy atoms have no rotation that is sure.
    Molecule small = toluene;
    for (std::size_t i = 0; i < 4; ++i) {
      small.atoms.pop_back();
      small.positions.pop_back();
    }
    CHECK(n_turned(small, half_turn(small, 8)) == 0);
  }

  TEST_CASE("the area of turned side chains is a share of the trusted, and the rest has its own mean difference") {
    espdiff::MappedSurface s;
    Molecule molecule;
    for (std::int32_t r = 0; r < 4; ++r) {
      molecule.residues.push_back({"ALA", "A", r + 1, ' '});
      const double z = 10.0 * r, width = r + 1;  // areas 0.5, 1, 1.5, 2
      for (const Vec3d& p : {Vec3d{0, 0, z}, Vec3d{width, 0, z}, Vec3d{0, 1, z}}) {
        s.source_positions.push_back(p);
        s.positions.push_back({2 * p.x, p.y, p.z});
        s.residue.push_back(r);
        s.potential_source.push_back(1);
        s.potential_target.push_back(static_cast<float>(r));  // differences -1, 0, 1, 2
        s.turned.push_back(r == 1 || r == 2 ? 1 : 0);
      }
      const auto first = static_cast<std::uint32_t>(3 * r);
      s.triangles.push_back({first, first + 1, first + 2});
    }
    s.turned[0] = 1;  // one corner of three does not count
    s.why = {0, 0, 0, 0};
    const espdiff::TurnedArea all = espdiff::turned_area(s, espdiff::surface_areas(s), {}, molecule);
    CHECK(all.of_trusted == doctest::Approx(0.5));
    CHECK(all.mean_abs_difference == doctest::Approx((1 * 1 + 4 * 2) / 5.0));
    CHECK(all.side_chains == std::vector<std::string>{"ALA 3 of chain A", "ALA 2 of chain A"});
    s.why[2] = static_cast<std::uint8_t>(espdiff::Why::kSlipped);
    CHECK(espdiff::turned_area(s, espdiff::surface_areas(s), {}, molecule).of_trusted == doctest::Approx(1 / 3.5));
    const espdiff::TurnedArea part = espdiff::turned_area(s, espdiff::surface_areas(s), {1, 0, 0, 1}, molecule);
    CHECK(part.of_trusted == doctest::Approx(1));
    CHECK(std::isnan(part.mean_abs_difference));
    s.potential_source.clear();
    CHECK(std::isnan(espdiff::turned_area(s, espdiff::surface_areas(s), {}, molecule).mean_abs_difference));
    CHECK(std::isnan(espdiff::turned_area(s, espdiff::surface_areas(s), {1, 1, 1, 1}, molecule).of_trusted));
  }
}
