// causes.cpp: what changed about residues that were made so, and what their charges add.
#include "causes/causes.h"

#include <doctest/doctest.h>

#include <cmath>

#include "align/made_molecule.h"
#include "causes/chi_angles.h"
#include "causes/reading.h"
#include "causes/residue_changes.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using namespace espdiff;  // NOLINT: a test

namespace {

/// A lysine whose side chain is a zigzag, with one of its angles turned by so many degrees.
Molecule zigzag_lysine(int turned_chi, double degrees) {
  MadeMolecule made;
  const std::vector<std::string> names{"N", "CA", "CB", "CG", "CD", "CE", "NZ"};
  made.residue("A", 118, "LYS", names);
  Molecule& m = made.molecule;
  for (std::size_t i = 0; i < names.size(); ++i) m.positions[i] = {1.2 * static_cast<double>(i), i % 2 ? 0.9 : 0, 0};
  if (turned_chi == 0) return m;
  const auto k = static_cast<std::size_t>(turned_chi);
  const Vec3d bond = m.positions[k + 1] - m.positions[k];
  const RigidTransform turn = rigid((1 / norm(bond)) * bond, degrees * espdiff_test::kPi / 180, {});
  for (std::size_t i = k + 1; i < names.size(); ++i)
    m.positions[i] = m.positions[k] + turn.rotate(m.positions[i] - m.positions[k]);
  return m;
}

std::vector<std::size_t> all_atoms(const Molecule& m) {
  std::vector<std::size_t> atoms;
  for (std::size_t i = 0; i < m.size(); ++i) atoms.push_back(i);
  return atoms;
}

/// Six residues: ALA, LYS, ASP, SER, LIG, GLU, all with charges and B factors.
Molecule six_residues() {
  MadeMolecule made;
  const std::vector<std::string> backbone{"N", "CA", "C", "O", "CB"};
  made.residue("A", 1, "ALA", backbone);
  made.residue("A", 2, "LYS", {"N", "CA", "C", "O", "CB", "CG", "CD", "CE", "NZ"});
  made.residue("A", 3, "ASP", backbone);
  made.residue("A", 4, "SER", backbone);
  made.residue("A", 5, "LIG", {"C1", "O1"});
  made.residue("A", 6, "GLU", backbone);
  Molecule& m = made.molecule;
  for (std::size_t i = 0; i < m.size(); ++i) {
    m.charges.push_back(i % 2 == 0 ? 0.25F : -0.25F);
    m.atoms[i].element = m.atoms[i].name.substr(0, 1);
    m.atoms[i].b_factor = 10 + static_cast<float>(i % 3);
  }
  return m;
}

AtomPairing same_atoms(const Molecule& m) {
  AtomPairing pairing;
  for (std::size_t i = 0; i < m.size(); ++i) pairing.pairs.emplace_back(i, i);
  return pairing;
}

}  // namespace

TEST_CASE("readings are whole, region, a patch or a residue") {
  CHECK(parse_reading("whole").of == ReadingOf::kWhole);
  CHECK(parse_reading("region").of == ReadingOf::kRegion);
  CHECK(parse_reading("patch site").patch == "site");
  const ReadingRequest residue = parse_reading("residue A:103B");
  CHECK(residue.chain == "A");
  CHECK(residue.number == 103);
  CHECK(residue.insertion_code == 'B');
  CHECK(parse_reading("residue -3").number == -3);
  for (const char* wrong :
       {"", "regions", "patch", "patch ", "residue", "residue A", "residue A:1x", "residue A:1BC"}) {
    CHECK(message_of([&] { parse_reading(wrong); }) ==
          std::string("causes: '") + wrong +
              "' is not whole, region, patch NAME, or residue CHAIN:NUMBER such as residue A:103");
  }
}

TEST_CASE("a side chain's turn is found with its angle; half a turn of a symmetric end is none") {
  const Molecule straight = zigzag_lysine(0, 0);
  for (int chi = 1; chi <= 4; ++chi) {
    for (const double degrees : {-170.0, 20.0, 113.0}) {
      const Molecule turned = zigzag_lysine(chi, degrees);
      const ChiTurn turn = chi_turn(straight, all_atoms(straight), turned, all_atoms(turned), kTurnedAngle);
      CHECK(turn.chi == chi);
      CHECK(turn.angle == doctest::Approx(std::fabs(degrees)).epsilon(1e-6));
    }
  }
  Molecule asp = zigzag_lysine(0, 0), flipped = zigzag_lysine(2, 180);
  for (Molecule* m : {&asp, &flipped}) {
    m->residues[0].name = "ASP";
    m->atoms[4].name = "OD1";
  }
  CHECK(chi_turn(asp, all_atoms(asp), flipped, all_atoms(flipped), kTurnedAngle).angle < 1e-6);
}

TEST_CASE("what changed about a residue is the first that holds") {
  const Molecule source = six_residues();
  Molecule target = source;
  target.residues[0].name = "VAL";                                              // substituted
  target.positions[13] += Vec3d{0, 0, -40};                                     // NZ of the lysine: turned
  target.atoms[16].b_factor = std::nanf("");                                    // an atom of ASP 3 was rebuilt
  for (std::size_t i = 19; i < 24; ++i) target.positions[i] += Vec3d{0, 2, 0};  // SER 4 moves as a whole
  target.atoms[20].b_factor = 90;                                               // poorly known, but of the backbone
  target.atoms[23].b_factor = 90;
  target.charges[26] = 0.5F;  // GLU 6 is charged otherwise
  const std::vector<std::int32_t> target_of{0, 1, 2, 3, -1, 5};
  AtomPairing pairing = same_atoms(source);
  pairing.pairs.erase(pairing.pairs.begin() + 24, pairing.pairs.begin() + 26);
  const auto changes = residue_changes({source, target, target_of, pairing, {}, {}});
  REQUIRE(changes.size() == 7);
  CHECK(changes[0].kind == CauseKind::kSubstituted);
  CHECK(changes[0].detail == "ALA to VAL");
  CHECK(changes[1].kind == CauseKind::kSideChain);
  CHECK(changes[1].detail.rfind("chi 4 by ", 0) == 0);
  CHECK(changes[2].kind == CauseKind::kRebuilt);
  CHECK(changes[2].detail == "in the target");
  CHECK(changes[3].kind == CauseKind::kBackbone);
  CHECK(changes[3].detail == "backbone by 2.0 A");
  CHECK(changes[3].moved_A == doctest::Approx(2));
  CHECK(changes[3].is_poorly_known());
  CHECK(changes[3].in_target.relative_b == doctest::Approx(90.0 / 11));
  CHECK_FALSE(changes[1].is_poorly_known());
  CHECK(changes[4].kind == CauseKind::kLigand);
  CHECK(changes[4].detail == "only in the source");
  CHECK(changes[5].kind == CauseKind::kCharges);
  CHECK(changes[6].detail == "only in the target");
  CHECK(changes[6].name(false) == "LIG 5");
  const auto protonated = residue_changes({source,
                                           source,
                                           {0, 1, 2, 3, 4, 5},
                                           same_atoms(source),
                                           {{2, 2, "ASP", "ASH"}, {0, 0, "N-terminus", "within the chain"}},
                                           {}});
  CHECK(protonated[2].kind == CauseKind::kProtonation);
  CHECK(protonated[2].detail == "ASP to ASH");
  CHECK(protonated[0].kind == CauseKind::kTerminus);
  CHECK(protonated[1].kind == CauseKind::kSurroundings);
}

TEST_CASE("a molecule whose B factors are all the same says nothing of its places") {
  Molecule m = six_residues();
  CHECK(knows_places(m));
  for (Atom& atom : m.atoms) atom.b_factor = 0;
  CHECK_FALSE(knows_places(m));
  const auto changes = residue_changes({m, m, {0, 1, 2, 3, 4, 5}, same_atoms(m), {}, {}});
  for (const ResidueChange& change : changes) CHECK_FALSE(change.is_poorly_known());
}

TEST_CASE("contributions add up by residue and by kind, those that are not compared by name") {
  const Molecule source = six_residues(), target = source;
  Molecule charges = source;  // with water, as in a periodic cell
  for (int w = 0; w < 3; ++w) {
    charges.residues.push_back({"HOH", "W", w, ' '});
    charges.atoms.push_back({"O", "O", static_cast<std::int32_t>(charges.residues.size() - 1), true});
    charges.positions.push_back({50, 0, 0});
    charges.charges.push_back(-0.8F);
  }
  Causes causes;
  causes.changes = residue_changes({source, target, {0, 1, 2, 3, 4, 5}, same_atoms(source), {}, {}});
  std::vector<double> of_source(charges.size(), 0.01), of_target = of_source;
  of_target[6] = -0.5;  // in LYS 2
  of_target.back() = 0.2;
  const std::vector<Vec3d> surface{source.positions[5] - Vec3d{0, 3, 0}};
  for (const char* name : {"region", "patch site"})
    add_reading(causes, name, {source, charges, of_source, surface, 0.31}, {target, charges, of_target, surface, 0.0});
  CHECK(causes.changes.size() == 7);
  REQUIRE(causes.readings.size() == 2);
  const CausesOfReading& reading = causes.readings[1];
  CHECK(reading.sum_of_source == doctest::Approx(0.34));
  CHECK(reading.sum_of_target == doctest::Approx(0.34 - 0.51 + 0.19));
  REQUIRE(reading.contributions.size() == 7);
  CHECK(causes.changes[reading.contributions[0].change].name(false) == "LYS 2");
  CHECK(reading.contributions[0].difference() == doctest::Approx(-0.51));
  CHECK(reading.contributions[0].source == doctest::Approx(0.09));
  CHECK(reading.contributions[0].distance_A == doctest::Approx(3));
  CHECK(causes.changes[reading.contributions[1].change].name(true) == "HOH");
  CHECK(causes.changes[reading.contributions[1].change].n_residues == 3);
  CHECK(reading.contributions[1].difference() == doctest::Approx(0.19));
  double sum = 0;
  for (const KindSum& kind : sums_by_kind(causes, reading)) sum += kind.difference;
  CHECK(sum == doctest::Approx(reading.sum_of_target - reading.sum_of_source));
}
