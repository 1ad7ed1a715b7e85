// place_hydrogens.cpp: lengths, angles and rotations of added hydrogens, and those that no valence allows.
#include "prepare/charges/place_hydrogens.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/vector.h"

using namespace espdiff;  // NOLINT: a test

namespace {

constexpr double kDegree = kPi / 180;

/// Heavy atoms, then hydrogens, whose places are nonsense.
struct Ligand {
  Mol2File file;
  std::vector<Mol2Bond> bonds;
  std::size_t n_given = 0;

  std::size_t heavy(const std::string& type, const Vec3d& place) {
    file.atoms.push_back({type, type.substr(0, type.find('.')), place, 0, type});
    return n_given++;
  }
  void bond(std::size_t a, std::size_t b) { bonds.push_back({a, b}); }
  void hydrogens(std::size_t x, int n) {
    for (int i = 0; i < n; ++i) {
      bonds.push_back({file.atoms.size(), x});
      file.atoms.push_back({"H", "H", {7, 7, 7}, 0.25, "H"});
    }
  }
  std::vector<Vec3d> places(const Molecule& surroundings = {}) const {
    return place_hydrogens(file, bonds, n_given, surroundings);
  }
  const Vec3d& at(std::size_t i) const { return file.atoms[i].position; }
};

double angle(const Vec3d& a, const Vec3d& middle, const Vec3d& b) {
  const Vec3d u = a - middle, v = b - middle;
  return std::acos(dot(u, v) / (norm(u) * norm(v))) / kDegree;
}

double torsion(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d n1 = cross(b - a, c - b), n2 = cross(c - b, d - c);
  return std::acos(std::clamp(dot(n1, n2) / (norm(n1) * norm(n2)), -1.0, 1.0)) / kDegree;
}

/// 2-propanol: a methine, two methyl groups, and a hydroxyl group.
Ligand propanol() {
  Ligand ligand;
  const std::size_t middle = ligand.heavy("C.3", {0, 0, 0}), left = ligand.heavy("C.3", {-0.88, -0.88, 0.88}),
                    right = ligand.heavy("C.3", {-0.88, 0.88, -0.88}), oxygen = ligand.heavy("O.3", {0.82, 0.82, 0.82});
  for (const std::size_t i : {left, right, oxygen}) ligand.bond(middle, i);
  ligand.hydrogens(oxygen, 1);
  ligand.hydrogens(middle, 1);
  ligand.hydrogens(left, 3);
  ligand.hydrogens(right, 3);
  return ligand;
}

Molecule one_atom(const std::string& element, const Vec3d& place) {
  Molecule molecule;
  molecule.residues.push_back({"XXX", "B", 1, ' '});
  molecule.atoms.push_back({element, element, 0, false});
  molecule.positions.push_back(place);
  return molecule;
}

}  // namespace

TEST_CASE("place_hydrogens: standard lengths, tetrahedral angles, staggered methyl groups") {
  const Ligand ligand = propanol();
  const std::vector<Vec3d> h = ligand.places();
  REQUIRE(h.size() == 8);
  CHECK(norm(h[0] - ligand.at(3)) == doctest::Approx(0.97));
  CHECK(norm(h[1] - ligand.at(0)) == doctest::Approx(1.09));
  for (const std::size_t i : {1U, 2U, 3U})
    CHECK(angle(h[1], ligand.at(0), ligand.at(i)) == doctest::Approx(109.47).epsilon(1e-4));
  CHECK(angle(ligand.at(0), ligand.at(3), h[0]) == doctest::Approx(109.47).epsilon(1e-4));
  for (std::size_t i = 2; i < 8; ++i) {
    const std::size_t carbon = i < 5 ? 1 : 2;
    CHECK(norm(h[i] - ligand.at(carbon)) == doctest::Approx(1.09));
    CHECK(angle(ligand.at(0), ligand.at(carbon), h[i]) == doctest::Approx(109.47).epsilon(1e-4));
    const double turn = torsion(ligand.at(3 - carbon), ligand.at(0), ligand.at(carbon), h[i]);
    CHECK(std::min(std::fabs(turn - 60), std::fabs(turn - 180)) < 1e-4);
  }
  CHECK(angle(h[2], ligand.at(1), h[3]) == doctest::Approx(109.47).epsilon(1e-4));
  for (std::size_t a = 0; a < h.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) CHECK(norm(h[a] - h[b]) > 1.6);
  }
}

TEST_CASE("place_hydrogens: given places of hydrogens do not matter, and a turned ligand has turned ones") {
  Ligand ligand = propanol();
  const std::vector<Vec3d> places = ligand.places();
  Ligand other = ligand;
  for (std::size_t i = other.n_given; i < other.file.atoms.size(); ++i)
    other.file.atoms[i].position = {1.0 * static_cast<double>(i), -2, 3};
  const std::vector<Vec3d> again = other.places();
  for (std::size_t i = 0; i < places.size(); ++i) CHECK(again[i] == places[i]);
  const auto turned = [](const Vec3d& p) { return Vec3d{p.y + 5, p.z - 2, p.x}; };
  for (Mol2Atom& atom : other.file.atoms) atom.position = turned(atom.position);
  const std::vector<Vec3d> of_turned = other.places();
  for (std::size_t i = 0; i < places.size(); ++i) CHECK(norm(of_turned[i] - turned(places[i])) < 1e-9);
}

TEST_CASE("place_hydrogens: in the plane at trigonal atoms, in line at linear ones") {
  Ligand ligand;  // formamide, and hydrogen cyanide beside it
  const std::size_t carbon = ligand.heavy("C.2", {0, 0, 0}), oxygen = ligand.heavy("O.2", {1.23, 0, 0}),
                    nitrogen = ligand.heavy("N.am", {-0.67, 1.15, 0}), cyanide = ligand.heavy("C.1", {0, 0, 9}),
                    triple = ligand.heavy("N.1", {0, 0, 10.16});
  ligand.bond(carbon, oxygen);
  ligand.bond(carbon, nitrogen);
  ligand.bond(cyanide, triple);
  ligand.hydrogens(carbon, 1);
  ligand.hydrogens(nitrogen, 2);
  ligand.hydrogens(cyanide, 1);
  const std::vector<Vec3d> h = ligand.places();
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::fabs(h[i].z) < 1e-9);
  CHECK(norm(h[0]) == doctest::Approx(1.08));
  CHECK(angle(h[0], ligand.at(carbon), ligand.at(oxygen)) == doctest::Approx(120).epsilon(5e-3));
  CHECK(norm(h[1] - ligand.at(nitrogen)) == doctest::Approx(1.01));
  CHECK(angle(h[1], ligand.at(nitrogen), h[2]) == doctest::Approx(120));
  CHECK(norm(h[3] - Vec3d{0, 0, 9 - 1.06}) < 1e-9);
}

TEST_CASE("place_hydrogens: a hydroxyl group turns towards an oxygen and away from carbon") {
  const Ligand ligand = propanol();
  const Vec3d trans = ligand.places()[0] - ligand.at(3);
  // 2.0 Angstrom behind each of the three staggered places.
  const Vec3d axis = 1 / norm(ligand.at(3)) * ligand.at(3);
  for (const double degrees : {0.0, 120.0, 240.0}) {
    const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
    const Vec3d turned = c * trans + s * cross(axis, trans) + (1 - c) * dot(axis, trans) * axis;
    const Vec3d behind = ligand.at(3) + ((0.97 + 2.0) / 0.97) * turned;
    CHECK(norm(ligand.places(one_atom("O", behind))[0] - ligand.at(3) - turned) < 1e-6);
    const Vec3d on = ligand.at(3) + (2.0 / 0.97) * turned;
    CHECK(norm(ligand.places(one_atom("C", on))[0] - ligand.at(3) - turned) > 1);
  }
}

TEST_CASE("place_hydrogens: a methyl group turns where it would meet another atom") {
  const Ligand ligand = propanol();
  const Vec3d meets = ligand.places()[2];
  const Vec3d beyond = ligand.at(1) + (2.1 / 1.09) * (meets - ligand.at(1));
  const std::vector<Vec3d> h = ligand.places(one_atom("C", beyond));
  for (std::size_t i = 2; i < 5; ++i) CHECK(norm(h[i] - beyond) > 1.5);
}

TEST_CASE("place_hydrogens: where another residue is bound, one hydrogen points to it and the others make room") {
  const Ligand ligand = propanol();
  const Vec3d bound = ligand.at(1) + Vec3d{0.6, -0.8, 1.1};
  const std::vector<Vec3d> h = ligand.places(one_atom("N", bound));
  CHECK(angle(h[2], ligand.at(1), bound) < 1e-3);
  for (const std::size_t i : {3U, 4U}) {
    CHECK(angle(h[i], ligand.at(1), bound) > 95);
    CHECK(angle(h[i], ligand.at(1), ligand.at(0)) > 95);
  }
  // A metal is not bound.
  CHECK(angle(ligand.places(one_atom("ZN", bound))[2], ligand.at(1), bound) > 1);
}

TEST_CASE("place_hydrogens: single atoms and flat ones have places too") {
  Ligand ammonia;
  ammonia.hydrogens(ammonia.heavy("N.3", {1, 2, 3}), 3);
  const std::vector<Vec3d> h = ammonia.places();
  CHECK(angle(h[0], {1, 2, 3}, h[1]) == doctest::Approx(109.47).epsilon(1e-4));
  Ligand flat;
  const std::size_t middle = flat.heavy("C.3", {0, 0, 0});
  for (const double degrees : {0.0, 120.0, 240.0})
    flat.bond(middle, flat.heavy("C.3", {1.5 * std::cos(degrees * kDegree), 1.5 * std::sin(degrees * kDegree), 0}));
  flat.hydrogens(middle, 1);
  CHECK(std::fabs(flat.places()[0].z) == doctest::Approx(1.09));
}

TEST_CASE("drop_impossible_hydrogens: a quaternary ammonium keeps none, and its charge") {
  Ligand ligand;
  const std::size_t nitrogen = ligand.heavy("N.3", {0, 0, 0});
  for (const Vec3d& place : {Vec3d{1, 1, 1}, Vec3d{-1, -1, 1}, Vec3d{-1, 1, -1}, Vec3d{1, -1, -1}})
    ligand.bond(nitrogen, ligand.heavy("C.3", 0.87 * place));
  ligand.hydrogens(nitrogen, 1);
  for (std::size_t i = 1; i < 5; ++i) ligand.hydrogens(i, 3);
  drop_impossible_hydrogens(ligand.file, ligand.bonds, ligand.n_given);
  CHECK(ligand.file.atoms.size() == 17);
  CHECK(ligand.bonds.size() == 16);
  CHECK(ligand.file.atoms[nitrogen].charge == 0.25);
  const std::vector<Vec3d> h = ligand.places();
  for (std::size_t a = 0; a < h.size(); ++a) {
    CHECK(norm(h[a] - ligand.at(1 + a / 3)) == doctest::Approx(1.09));
    for (std::size_t b = 0; b < a; ++b) CHECK(norm(h[a] - h[b]) > 1.6);
  }
  const std::size_t n_before = ligand.file.atoms.size();
  drop_impossible_hydrogens(ligand.file, ligand.bonds, ligand.n_given);
  CHECK(ligand.file.atoms.size() == n_before);
}
