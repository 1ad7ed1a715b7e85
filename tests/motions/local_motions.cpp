// local_motions.cpp: chains that bend, wind up and break; the reverse; and a real pair whose parts turn by themselves.
#include "motions/local_motions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/molecule/pairing.h"
#include "certificate/result.h"
#include "compare/built_molecule.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "mapping/input.h"
#include "motions/common_frame.h"
#include "options/options.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::AtomPairing;
using espdiff::CompareOptions;
using espdiff::CompareResult;
using espdiff::DomainMotions;
using espdiff::Molecule;
using espdiff::RigidTransform;
using espdiff::Screw;
using espdiff::Vec3d;

namespace {

/// A chain of residues of four atoms along a line, 3.8 A apart.
Molecule straight_chain(int n_residues) {
  Builder b;
  const Vec3d atoms[4] = {{0, 0, 0}, {1.2, 4, 0}, {2.4, 0, 4}, {1.2, -3, -3}};
  for (int r = 0; r < n_residues; ++r) {
    for (int k = 0; k < 4; ++k)
      b.add("GLY", r + 1, "C" + std::to_string(k), atoms[k] + Vec3d{3.8 * r, 0, 0}, 1.7F, "A");
  }
  b.molecule.charges.assign(b.molecule.size(), 0.0F);
  return b.molecule;
}

AtomPairing one_to_one(const Molecule& molecule) {
  AtomPairing pairing;
  for (std::size_t i = 0; i < molecule.size(); ++i) pairing.pairs.emplace_back(i, i);
  return pairing;
}

/// Each residue turned about the x axis by its own angle.
template <typename Angle>
Molecule twisted(const Molecule& m, Angle angle) {
  Molecule result = m;
  for (std::size_t i = 0; i < m.size(); ++i) {
    Screw screw;
    screw.axis = {1, 0, 0};
    screw.angle = angle(static_cast<std::size_t>(m.atoms[i].residue));
    result.positions[i] = screw.apply(m.positions[i], 1);
  }
  return result;
}

Vec3d rotation_of(const DomainMotions& motions, std::size_t residue) {
  const Screw screw = motions.of(static_cast<std::int32_t>(residue));
  return screw.angle * screw.axis;
}

}  // namespace

TEST_SUITE_BEGIN("local_motions");

TEST_CASE("residues of a molecule that moves as a whole have its motion") {
  const Molecule source = straight_chain(40);
  Random random(1);
  const RigidTransform rigid = random_rigid(random, 10.0);
  Molecule target = source;
  for (Vec3d& p : target.positions) p = rigid.apply(p);
  const DomainMotions motions = local_motions(source, target, one_to_one(source), {}, {});
  REQUIRE(motions.of_residue.size() == source.residues.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Screw screw = motions.of(source.atoms[i].residue);
    // The damping turns them by a little less.
    CHECK(norm(screw.apply(source.positions[i], 1) - target.positions[i]) < 0.8);
  }
}

TEST_CASE("a chain wound up along its length turns on beyond 180 degrees, and back the same way") {
  const Molecule source = straight_chain(60);
  const Molecule target = twisted(source, [](std::size_t r) { return 0.08 * static_cast<double>(r); });
  const DomainMotions motions = local_motions(source, target, one_to_one(source), {}, {});
  double largest = 0;
  for (std::size_t r = 1; r < source.residues.size(); ++r) {
    CHECK(norm(rotation_of(motions, r) - rotation_of(motions, r - 1)) < 0.3);
    largest = std::max(largest, rotation_of(motions, r).x);
  }
  CHECK(largest > 3.8);  // 4.7 at the end, which its neighbours lag behind
  std::vector<std::int32_t> same(source.residues.size());
  for (std::size_t r = 0; r < same.size(); ++r) same[r] = static_cast<std::int32_t>(r);
  const DomainMotions back = inverse(motions, same);
  for (std::size_t i = 0; i < source.size(); ++i) {
    const std::int32_t r = source.atoms[i].residue;
    const Vec3d there = motions.of(r).apply(source.positions[i], 1),
                half = motions.of(r).apply(source.positions[i], 0.5);
    CHECK(norm(back.of(r).apply(there, 0.5) - half) < 1e-6);
    CHECK(norm(back.of(r).apply(there, 1) - source.positions[i]) < 1e-6);
  }
}

TEST_CASE("a break of the chain starts anew, an ion does not turn, an unpaired residue has no motion") {
  Molecule source = straight_chain(30);
  for (std::size_t i = 15 * 4; i < source.size(); ++i) source.positions[i] += Vec3d{0, 80, 0};
  Builder b;
  b.molecule = source;
  b.add("NA", 99, "NA", {0, 0, 60}, 1.8F, "A");
  b.add("CL", 100, "CL", {0, 0, 90}, 1.8F, "A");
  source = b.molecule;
  Molecule target = source;
  for (std::size_t i = 0; i < 15 * 4; ++i)
    target.positions[i] = {source.positions[i].x, -source.positions[i].y, -source.positions[i].z};
  target.positions[source.size() - 2] += Vec3d{5, 0, 0};
  AtomPairing pairing = one_to_one(source);
  pairing.pairs.pop_back();
  const DomainMotions motions = local_motions(source, target, pairing, {}, {});
  CHECK(norm(rotation_of(motions, 5)) > 2.5);
  CHECK(norm(rotation_of(motions, 20)) < 1e-6);
  CHECK(norm(rotation_of(motions, 30)) < 1e-6);
  const Vec3d ion = source.positions[source.size() - 2];
  CHECK(norm(motions.of(30).apply(ion, 1) - target.positions[source.size() - 2]) < 1e-9);
  CHECK(motions.of_residue[31] == -1);
}

TEST_CASE("residues in another order of the file have the same motions") {
  const Molecule source = straight_chain(40);
  const Molecule target = twisted(source, [](std::size_t r) { return 0.08 * static_cast<double>(r); });
  const auto shuffled = [](const Molecule& m) {
    Builder b;
    for (int k = 0; k < 40; ++k) {
      const std::size_t r = static_cast<std::size_t>(k * 7 % 40);
      for (std::size_t i = 4 * r; i < 4 * r + 4; ++i)
        b.add("GLY", static_cast<int>(r) + 1, m.atoms[i].name, m.positions[i], 1.7F, "A");
    }
    return b.molecule;
  };
  const DomainMotions motions = local_motions(source, target, one_to_one(source), {}, {}),
                      again = local_motions(shuffled(source), shuffled(target), one_to_one(source), {}, {});
  for (std::size_t k = 0; k < 40; ++k) CHECK(norm(rotation_of(again, k) - rotation_of(motions, k * 7 % 40)) < 1e-9);
}

TEST_CASE("local motions keep twice as much of a nucleocapsid's surface on its residue") {
  const auto path = real_input("pairs/1aaf.pdb");
  if (!path) return;
  espdiff::StructureOptions first, tenth;
  tenth.model = 10;
  const Molecule source = espdiff::read_structure(*path, first), target = espdiff::read_structure(*path, tenth);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const auto with = [&](const std::string& domains) {
    CompareOptions options;
    options.domains = domains;
    return compare(*engine, {&source, nullptr}, {&target, nullptr}, options, {});
  };
  const CompareResult straight = with("none"), local = with("local");
  CHECK(straight.certificate.same_residue_area_fraction < 0.35);
  CHECK(local.certificate.same_residue_area_fraction > 0.6);
  CHECK(local.certificate.slip->large_area_fraction < straight.certificate.slip->large_area_fraction);
  CHECK(local.certificate.self_intersecting_pairs == 0);
  CHECK(local.alignment.domains.empty());
  // Half of one mapping is wrong, a third of the other.
  CHECK_FALSE(straight.certificate.trustworthy);
  CHECK(local.certificate.trusted.share() > straight.certificate.trusted.share());
  CHECK(local.certificate.trusted.share() < 0.8);
}

TEST_CASE("deform refuses local motions") {
  const Molecule molecule = straight_chain(12);
  CompareOptions options;
  options.domains = "local";
  options.method = espdiff::Method::kDeform;
  CHECK(message_of([&] { align(molecule, molecule, options); }) ==
        "domains local: only the morph follows the motions of residues; use method morph, or domains auto");
}

TEST_SUITE_END();
