// trusted_area.cpp: reasons by triangle, their sums, verdicts and names, on strips of triangles made by hand.
#include "certificate/trusted_area.h"

#include "certificate/slip.h"

#include <doctest/doctest.h>

#include <cmath>

#include "certificate/certificate.h"
#include "certificate/residue_rows.h"
#include "certificate/result.h"
#include "certificate/untrusted_parts.h"
#include "support/nan.h"

using espdiff::CompareResult;
using espdiff::MappedSurface;
using espdiff::TrustedArea;
using espdiff::Why;
using espdiff_test::kNan;

namespace {

/// Separate triangles of 0.5 A^2 on the source and twice that on the target, one for each residue.
MappedSurface separate_triangles(std::size_t n) {
  MappedSurface s;
  for (std::size_t t = 0; t < n; ++t) {
    const double z = 10 * static_cast<double>(t);
    for (const espdiff::Vec3d& p : {espdiff::Vec3d{0, 0, z}, espdiff::Vec3d{1, 0, z}, espdiff::Vec3d{0, 1, z}}) {
      s.source_positions.push_back(p);
      s.positions.push_back({2 * p.x, p.y, p.z});
      s.residue.push_back(static_cast<std::int32_t>(t));
      s.target_residue.push_back(static_cast<std::int32_t>(t));
      s.slip.push_back(0.5F);
      s.displacement.push_back(1);
      s.path_length.push_back(1);
    }
    const auto first = static_cast<std::uint32_t>(3 * t);
    s.triangles.push_back({first, first + 1, first + 2});
  }
  s.corrupt.assign(n, 0);
  s.unmatched.assign(n, 0);
  return s;
}

std::vector<std::uint8_t> codes(const std::vector<Why>& reasons) {
  std::vector<std::uint8_t> all;
  for (const Why why : reasons) all.push_back(static_cast<std::uint8_t>(why));
  return all;
}

espdiff::Molecule chain_of(std::size_t n) {
  espdiff::Molecule molecule;
  for (std::size_t r = 0; r < n; ++r) {
    molecule.residues.push_back({"ALA", "A", static_cast<std::int32_t>(r + 1), ' '});
    espdiff::Atom atom;
    atom.name = "CA";
    atom.element = "C";
    atom.residue = static_cast<std::int32_t>(r);
    molecule.atoms.push_back(atom);
    molecule.positions.push_back({0, 0, 10 * static_cast<double>(r)});
  }
  return molecule;
}

/// The same chain with backbones: residues 1 to 12 are an alpha helix (cylinder coordinates fitted to its bond lengths
/// and to a hydrogen bond of 2.9 A), the others lie far from each other.
espdiff::Molecule helix_and_loop(std::size_t n) {
  struct Place {
    const char* name;
    double radius, degrees, height;
  };
  constexpr Place kBackbone[] = {
      {"N", 1.56, -27.14, -0.89}, {"CA", 2.28, -0.17, 0.02}, {"C", 1.66, 27.31, 1.06}, {"O", 1.95, 22.5, 2.25}};
  espdiff::Molecule molecule = chain_of(n);
  molecule.atoms.clear();
  molecule.positions.clear();
  for (std::size_t r = 0; r < n; ++r) {
    const auto turn = static_cast<double>(r);
    const double rise = r < 12 ? 1.5 : 10;
    for (const Place& place : kBackbone) {
      espdiff::Atom atom;
      atom.name = place.name;
      atom.element = std::string(place.name, 1);
      atom.residue = static_cast<std::int32_t>(r);
      molecule.atoms.push_back(atom);
      const double angle = (place.degrees + 100 * turn) * 3.14159265358979 / 180;
      molecule.positions.push_back(
          {place.radius * std::cos(angle), place.radius * std::sin(angle), place.height + rise * turn});
    }
  }
  return molecule;
}

}  // namespace

TEST_SUITE_BEGIN("trusted area");

TEST_CASE("each triangle has the first reason that holds") {
  MappedSurface s = separate_triangles(8);
  s.unmatched[1] = 1;
  s.slip[3] = s.slip[4] = s.slip[5] = 9;  // of the unmatched one
  s.corrupt[2] = 1;
  for (std::size_t v = 12; v < 15; ++v) s.slip[v] = 3.1F;
  s.target_residue[15] = s.target_residue[16] = 0;  // two corners of three, on a residue that does not touch it
  s.target_residue[18] = 0;                         // one corner
  for (std::size_t v = 21; v < 24; ++v) s.slip[v] = kNan;
  const std::vector<std::int32_t> target_of = {0, 1, 2, -1, 4, 5, 6, 7};
  CHECK(espdiff::why_of_mapping(s, target_of) ==
        codes({Why::kTrusted, Why::kUnmatched, Why::kCorrupt, Why::kUnpaired, Why::kSlipped, Why::kOtherResidue,
               Why::kTrusted, Why::kTrusted}));
  // Without any pair, residues say nothing.
  CHECK(espdiff::why_of_mapping(s, std::vector<std::int32_t>(8, -1)) ==
        codes({Why::kTrusted, Why::kUnmatched, Why::kCorrupt, Why::kTrusted, Why::kSlipped, Why::kTrusted,
               Why::kTrusted, Why::kTrusted}));
}

TEST_CASE("what turned off is not trusted: residues always, side chains far off, or all where they are left out") {
  MappedSurface s = separate_triangles(5);
  const std::vector<std::int32_t> target_of = {0, 1, 2, 3, 4};
  s.turned.assign(15, 0);
  s.turned[0] = s.turned[1] = 2;  // two corners of three on a residue
  s.turned[3] = 2;                // one
  s.turned[6] = s.turned[7] = 1;  // two on a side chain
  s.turned[9] = s.turned[10] = 2;
  s.turned[12] = s.turned[13] = 3;  // two far off on a side chain
  s.slip[9] = s.slip[10] = s.slip[11] = 9;
  CHECK(espdiff::why_of_mapping(s, target_of) ==
        codes({Why::kTurned, Why::kTrusted, Why::kTrusted, Why::kSlipped, Why::kTurned}));
  CHECK(espdiff::why_of_mapping(s, target_of, espdiff::KeptTurns::kNone) ==
        codes({Why::kTurned, Why::kTrusted, Why::kTurned, Why::kSlipped, Why::kTurned}));
  CHECK(espdiff::why_of_mapping(s, target_of, espdiff::KeptTurns::kAll) ==
        codes({Why::kTurned, Why::kTrusted, Why::kTrusted, Why::kSlipped, Why::kTrusted}));
}

TEST_CASE("a point on a residue that touches its own counts within 0.2 A") {
  MappedSurface s = separate_triangles(2);
  s.target_residue = {0, 1, 1, 1, 1, 1};  // both residues share the first triangle
  s.slip.assign(6, 0.1F);
  const std::vector<std::int32_t> target_of = {0, 1};
  CHECK(espdiff::why_of_mapping(s, target_of) == codes({Why::kTrusted, Why::kTrusted}));
  s.slip[1] = s.slip[2] = 0.3F;
  CHECK(espdiff::why_of_mapping(s, target_of) == codes({Why::kOtherResidue, Why::kTrusted}));
}

TEST_CASE("what has no potential and what disagrees is marked where nothing else is wrong") {
  MappedSurface s = separate_triangles(3);
  s.why = codes({Why::kTrusted, Why::kSlipped, Why::kTrusted});
  s.potential_source.assign(9, 1);
  s.potential_target.assign(9, 2);
  s.potential_target[0] = s.potential_target[3] = kNan;
  espdiff::mark_without_potential(s);
  CHECK(s.why == codes({Why::kNoPotential, Why::kSlipped, Why::kTrusted}));
  espdiff::mark_disagreeing(s, {1, 1, 1});
  CHECK(s.why == codes({Why::kNoPotential, Why::kSlipped, Why::kDisagrees}));
}

TEST_CASE("shares are those of both whole surfaces, and of a part") {
  MappedSurface s = separate_triangles(4);
  s.unmatched[3] = 1;
  s.why = codes({Why::kTrusted, Why::kTrusted, Why::kSlipped, Why::kUnmatched});
  const TrustedArea whole = espdiff::sum_trusted(s, espdiff::surface_areas(s), {}, 0.1);
  CHECK(whole.source == doctest::Approx(0.5));
  CHECK(whole.target == doctest::Approx(0.9 * 2 / 3));
  CHECK(whole.by_why[static_cast<std::size_t>(Why::kSlipped)] == doctest::Approx(0.25));
  CHECK(whole.share() == doctest::Approx(0.5));
  const TrustedArea part = espdiff::sum_trusted(s, espdiff::surface_areas(s), {0, 1, 0, 1}, 0);
  CHECK(part.source == doctest::Approx(0.5));
  CHECK(part.target == doctest::Approx(0.5));
  CHECK(std::isnan(espdiff::sum_trusted(s, espdiff::surface_areas(s), {1, 1, 1, 1}, 0).source));
}

TEST_CASE("three verdicts by the smaller share, and one by the share that is required") {
  CompareResult result;
  const espdiff::Molecule none;
  const auto verdict = [&](double source, double target, double required) {
    result.certificate = {};
    result.certificate.converged = true;
    result.certificate.trusted.source = source;
    result.certificate.trusted.target = target;
    espdiff::judge(result, result.inputs.warnings, none, required);
    return espdiff::verdict_of(result.certificate);
  };
  CHECK(verdict(0.97, 0.95, 0.5) == "TRUSTWORTHY");
  CHECK(verdict(0.99, 0.9499, 0.5) == "TRUSTWORTHY ON 94 %");
  CHECK(verdict(0.5, 0.9, 0.5) == "TRUSTWORTHY ON 50 %");
  CHECK(verdict(0.49, 0.9, 0.5) == "NOT TRUSTWORTHY");
  CHECK(verdict(0.94, 0.9, 0.95) == "NOT TRUSTWORTHY");
  CHECK(result.certificate.reasons[0].plain() ==
        "94 % of the source's surface and 90 % of the target's are trusted (limit 95 %)");
  CHECK(verdict(kNan, 0.9, 0.5) == "NOT TRUSTWORTHY");
  result.inputs.warnings = {{"a mirror image", true}};
  CHECK(verdict(1, 1, 0.5) == "NOT TRUSTWORTHY");
}

TEST_CASE("parts are named by runs of residues, largest first") {
  MappedSurface s = separate_triangles(9);
  for (espdiff::Vec3d& p : s.source_positions) p = 8.0 * p;  // 32 A^2 each
  using W = Why;
  s.why = codes({W::kTrusted, W::kUnmatched, W::kTrusted, W::kTrusted, W::kSlipped, W::kTrusted, W::kSlipped,
                 W::kOtherResidue, W::kTrusted});
  const std::vector<espdiff::ResidueRow> rows = espdiff::residue_rows(s, espdiff::surface_areas(s), 9, false);
  CHECK(rows[0].trusted_area_fraction == 1);
  CHECK(rows[1].trusted_area_fraction == 0);
  CHECK(rows[1].area_A2 == 0);
  CHECK(rows[4].matched_area_A2 == doctest::Approx(1));
  CHECK(espdiff::untrusted_parts(s, espdiff::surface_areas(s), rows, chain_of(9)) ==
        std::vector<std::string>{"ALA 5 to ALA 8 of chain A (96 A^2): slipped off its atoms",
                                 "ALA 2 of chain A (32 A^2): unmatched"});
  espdiff::Molecule with_ligand = chain_of(9);
  with_ligand.residues[7].name = "NAD";
  with_ligand.atoms[7].name = "PA";
  CHECK(espdiff::untrusted_parts(s, espdiff::surface_areas(s), rows, with_ligand) ==
        std::vector<std::string>{"ALA 5 to ALA 7 of chain A (64 A^2): slipped off its atoms",
                                 "ALA 2 of chain A (32 A^2): unmatched",
                                 "NAD 8 of chain A (32 A^2): on another residue"});
}

TEST_CASE("parts are named by helix, strand and loop where the backbone is known") {
  MappedSurface s = separate_triangles(20);
  for (espdiff::Vec3d& p : s.source_positions) p = 8.0 * p;
  const auto parts = [&](const std::vector<std::size_t>& untrusted) {
    s.why.assign(20, static_cast<std::uint8_t>(Why::kTrusted));
    for (const std::size_t r : untrusted) s.why[r] = static_cast<std::uint8_t>(Why::kSlipped);
    return espdiff::untrusted_parts(s, espdiff::surface_areas(s),
                                    espdiff::residue_rows(s, espdiff::surface_areas(s), 20, false), helix_and_loop(20));
  };
  const std::string slipped = "slipped off its atoms";
  CHECK(parts({3, 4, 5, 14, 17, 18}) ==
        std::vector<std::string>{"helix ALA 4 to ALA 6 of chain A (96 A^2): " + slipped,
                                 "loop ALA 18 to ALA 19 of chain A (64 A^2): " + slipped,
                                 "ALA 15 of chain A, in a loop (32 A^2): " + slipped});
  CHECK(parts({7, 8, 9, 10, 11, 12}) ==
        std::vector<std::string>{"helix and loop ALA 8 to ALA 13 of chain A (192 A^2): " + slipped});
}

TEST_CASE("the whole surface is estimated from the residues' own surfaces, and bounded by the largest difference") {
  CompareResult result;
  result.potential.compared = true;
  MappedSurface& s = result.surface = separate_triangles(4);
  s.why = codes({Why::kTrusted, Why::kTrusted, Why::kSlipped, Why::kUnmatched});
  s.potential_source.assign(12, 0);
  s.potential_target.assign(12, 1);
  s.potential_target[7] = -5;
  result.potential.metrics.area_A2 = 2;
  result.potential.metrics.mean_abs_difference = 1;
  result.residues = espdiff::residue_rows(s, espdiff::surface_areas(s), 4, true);
  for (espdiff::ResidueRow& row : result.residues) row.own_difference = 0.5;
  result.residues[2].own_difference = 2;  // twice what its own surfaces say, as in the trusted part: 4
  result.residues[3].own_difference = kNan;
  const espdiff::WholeSurface whole = espdiff::whole_surface(result.surface, result.residues, result.potential);
  CHECK(whole.estimate == doctest::Approx((1 + 1 + 4 + 1) / 4.0));
  CHECK(whole.at_most == doctest::Approx((1 + 1 + 5 + 5) / 4.0));
  result.potential.compared = false;
  CHECK(std::isnan(espdiff::whole_surface(result.surface, result.residues, result.potential).estimate));
}

TEST_SUITE_END();
