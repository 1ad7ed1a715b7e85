// own_potentials.cpp: each residue's potential on its own surface, and the correlation that checks the mapped
// differences.
#include "certificate/own_potentials.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::Random;

namespace {

/// Squares of 10 A^2 in a row, each of one residue, two triangles each; neighbours touch by the triangles between them.
struct Row {
  Mesh surface;
  std::vector<std::int32_t> residue;

  explicit Row(int n) {
    const float side = std::sqrt(10.0F);
    for (int r = 0; r < n; ++r) {
      const float x = 2 * side * static_cast<float>(r);
      const auto first = static_cast<std::uint32_t>(surface.positions.size());
      surface.positions.insert(surface.positions.end(),
                               {{x, 0, 0}, {x + side, 0, 0}, {x + side, side, 0}, {x, side, 0}});
      residue.insert(residue.end(), 4, r);
      surface.triangles.push_back({first, first + 1, first + 2});
      surface.triangles.push_back({first, first + 2, first + 3});
      if (r > 0) surface.triangles.push_back({first - 3, first - 2, first});
    }
  }
};

ResidueRow row_of(std::size_t residue, double area, double own, double mapped) {
  ResidueRow row;
  row.residue = residue;
  row.area_A2 = row.own_area_A2 = area;
  row.own_difference = own;
  row.mean_signed_difference = mapped;
  row.trusted_area_fraction = 1;
  return row;
}

}  // namespace

TEST_SUITE_BEGIN("compare");

TEST_CASE("a residue's own potential is the mean over its surface by area") {
  const Row row(3);
  std::vector<float> potential;
  for (const std::int32_t r : row.residue) potential.push_back(static_cast<float>(r + 1));
  const std::vector<OwnPotential> own = own_potentials(row.surface, row.residue, potential, {0, 1, 2});
  CHECK(own[0].mean == doctest::Approx(1));
  CHECK(own[1].mean == doctest::Approx(2));
  CHECK(own[2].mean == doctest::Approx(3));
}

TEST_CASE("beside a residue without a partner no own potential is taken") {
  const Row row(5);
  const std::vector<float> potential(row.residue.size(), 1.0F);
  const std::vector<OwnPotential> own = own_potentials(row.surface, row.residue, potential, {0, 1, 2, -1, 3});
  CHECK(std::isfinite(own[0].mean));
  CHECK(std::isfinite(own[1].mean));
  for (const std::size_t r : {2, 3, 4}) CHECK(std::isnan(own[r].mean));
}

TEST_CASE("a residue's own difference weighs the harmonic mean of its two areas") {
  std::vector<ResidueRow> rows = {row_of(0, 10, 0, 0), row_of(1, 10, 0, 0), row_of(2, 10, 0, 0)};
  set_own_differences(rows, {{1, 20}, {2, 20}, {3, 20}}, {{std::nan(""), 3}, {5, 60}}, {1, 0, -1});
  CHECK(rows[0].own_difference == 4);
  CHECK(rows[0].own_area_A2 == doctest::Approx(30));
  CHECK(std::isnan(rows[1].own_difference));
  CHECK(std::isnan(rows[1].own_area_A2));
  CHECK(std::isnan(rows[2].own_difference));
}

TEST_CASE("the correlation weighs residues by their area, and leaves out what has no own difference") {
  Random random(5);
  std::vector<ResidueRow> rows;
  for (std::size_t r = 0; r < 30; ++r) {
    const double own = random.uniform(-1, 1);
    rows.push_back(row_of(r, 40, own, 0.8 * own));
  }
  const std::vector<OwnPotential> source(40, {2, 50});
  CHECK(check_residues(rows, source).correlation == doctest::Approx(1));
  CHECK(check_residues(rows, source).rms_potential == doctest::Approx(2));

  // One residue twice is the same as once with twice the area.
  std::vector<ResidueRow> twice = rows, heavy = rows;
  twice.push_back(row_of(30, 20, 0.9, -0.9));
  twice.push_back(row_of(31, 20, 0.9, -0.9));
  heavy.push_back(row_of(30, 40, 0.9, -0.9));
  const double expected = check_residues(heavy, source).correlation;
  CHECK(expected < 0.95);
  CHECK(check_residues(twice, source).correlation == doctest::Approx(expected));
  CHECK(check_residues(twice, source).rms_error == doctest::Approx(check_residues(heavy, source).rms_error));

  // Too little surface, or no own difference: not counted.
  std::vector<ResidueRow> more = rows;
  more.push_back(row_of(30, 4.9, 0.9, -0.9));
  more.push_back(row_of(31, 100, std::nan(""), -0.9));
  // Nor a residue of which a strip is trusted: its mean is not that of the residue.
  more.push_back(row_of(32, 100, 0.9, -0.9));
  more.back().trusted_area_fraction = 0.24;
  CHECK(check_residues(more, source).correlation == doctest::Approx(1));
  CHECK(check_residues(more, source).n_residues == 30);
  CHECK(most_disagreeing(more)[0]->residue != 32);
  more.back().trusted_area_fraction = 0.25;
  CHECK(check_residues(more, source).correlation < 0.95);
}

TEST_CASE("a residue that disagrees by far is named, and one by the noise of all others is not") {
  std::vector<ResidueRow> rows;
  for (std::size_t r = 0; r < 20; ++r)
    rows.push_back(row_of(r, 40, static_cast<double>(r), static_cast<double>(r) + (r % 2 == 0 ? 0.1 : -0.1)));
  const std::vector<OwnPotential> source(20, {2, 50});
  // The median error is 0.1, so that five deviations are 0.74; 25 % of the potentials are 0.5.
  rows[5].mean_signed_difference = rows[5].own_difference + 0.8;
  rows[7].mean_signed_difference = rows[7].own_difference - 0.7;
  std::vector<std::uint8_t> expected(20, 0);
  expected[5] = 1;
  CHECK(disagreeing_residues(rows, source) == expected);
  CHECK(most_disagreeing(rows)[0]->residue == 5);
  rows[5].area_A2 = 4;  // too small to say so
  CHECK(disagreeing_residues(rows, source) == std::vector<std::uint8_t>(20, 0));
  // Where all agree to the last digit, it takes 25 % of the potentials.
  for (std::size_t r = 0; r < 20; ++r) rows[r].mean_signed_difference = rows[r].own_difference;
  rows[3].mean_signed_difference += 0.49;
  CHECK(disagreeing_residues(rows, source) == std::vector<std::uint8_t>(20, 0));
  rows[3].mean_signed_difference += 0.02;
  expected.assign(20, 0);
  expected[3] = 1;
  CHECK(disagreeing_residues(rows, source) == expected);
}

TEST_CASE("fewer than five residues have no correlation") {
  std::vector<ResidueRow> rows;
  for (std::size_t r = 0; r < kLeastComparedResidues - 1; ++r)
    rows.push_back(row_of(r, 40, static_cast<double>(r), static_cast<double>(r)));
  const ResidueCheck check = check_residues(rows, std::vector<OwnPotential>(4));
  CHECK(std::isnan(check.correlation));
  CHECK(check.n_residues == 4);
}

TEST_SUITE_END();
