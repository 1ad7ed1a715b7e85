// map_drawings.cpp: drawings of maps lie at the right positions.
#include "view/drawings/map_drawings.h"

#include <doctest/doctest.h>
#include <vtkActor.h>
#include <vtkMapper.h>
#include <vtkPolyData.h>

#include <cmath>

#include "scene/map_sampling.h"
#include "view/drawings/field_lines.h"
#include "view/made_comparison.h"

using namespace espdiff;  // NOLINT: a test of these headers

namespace {

constexpr double kSine = 0.6, kCosine = 0.8;

/// A rotation by 18 degrees about z, and a translation.
PlacedMap placed(const Grid& map) {
  PlacedMap result{&map, {}};
  const double turned[9] = {kCosine, -kSine, 0, kSine, kCosine, 0, 0, 0, 1};
  std::copy(turned, turned + 9, result.to_frame.rotation);
  result.to_frame.translation = {4, -2, 1};
  return result;
}

ColourScale scale() { return ColourScale(RenderArray::kTarget, {-5, 5}, 5); }

/// A ball of vertices.
void make_ball(Vec3d centre, double radius, std::vector<Vec3d>& positions, std::vector<Vec3f>& normals) {
  for (int i = 0; i < 2000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 2000, turn = 2.399963 * i, r = std::sqrt(1 - z * z);
    const Vec3d n{r * std::cos(turn), r * std::sin(turn), z};
    positions.push_back(centre + radius * n);
    normals.push_back(static_cast<Vec3f>(n));
  }
}

}  // namespace

TEST_CASE("a position is transformed to the map's frame and back") {
  const Grid map = espdiff_test::map_of({});
  const PlacedMap there = placed(map);
  const Vec3d p{3, 4, 5}, back = there.in_map(there.to_frame.apply(p));
  CHECK(norm(back - p) < 1e-12);
}

TEST_CASE("an isopotential surface lies where the map has the value, also on skewed axes") {
  const Grid map = espdiff_test::map_of({{{2, 1, 0}, 1}});
  const PlacedMap there = placed(map);
  const auto prop = make_isopotential(there, 6, scale());
  auto* actor = vtkActor::SafeDownCast(prop);
  REQUIRE(actor != nullptr);
  actor->GetMapper()->Update();
  auto* shape = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInputDataObject(0, 0));
  REQUIRE(shape->GetNumberOfPoints() > 200);
  const Vec3d charge = there.to_frame.apply({2, 1, 0});
  const LatticeIndex index(map.lattice, map.name);
  for (vtkIdType i = 0; i < shape->GetNumberOfPoints(); i += 5) {
    double p[3];
    shape->GetPoint(i, p);
    // 30 / (1 + r) = 6 at r = 4; the grid's spacing is about 1.2 A.
    CHECK(norm(Vec3d{p[0], p[1], p[2]} - charge) == doctest::Approx(4).epsilon(0.03));
    CHECK(sample_at(map, index(there.in_map({p[0], p[1], p[2]}))) == doctest::Approx(6).epsilon(0.001));
  }
  CHECK(make_isopotential(there, 1000, scale()) == nullptr);
}

TEST_CASE("field lines of a charge run straight away from it, down the potential, to the map's border") {
  const Grid map = espdiff_test::map_of({{{2, 1, 0}, 1}});
  const PlacedMap there = placed(map);
  const Vec3d charge = there.to_frame.apply({2, 1, 0});
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;
  make_ball(charge, 4, positions, normals);
  const auto lines = trace_field_lines(there, positions, normals, 12);
  REQUIRE(lines.size() > 6);
  CHECK(lines.size() <= 12);
  const LatticeIndex index(map.lattice, map.name);
  const auto potential = [&](Vec3d p) { return sample_at(map, index(there.in_map(p))); };
  for (const auto& line : lines) {
    const Vec3d from = line.front() - charge, to = line.back() - charge;
    CHECK(norm(from) == doctest::Approx(4).epsilon(0.08));
    CHECK(norm(to) > 8);
    CHECK(dot(from, to) / (norm(from) * norm(to)) > 0.97);
    CHECK(potential(line.front()) > potential(line.back()));
    // One step farther there is no field.
    const Vec3d last = line.back() - line[line.size() - 2];
    CHECK(std::isnan(potential(line.back() + (0.8 / norm(last)) * last)));
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) CHECK(norm(lines[i].front() - lines[j].front()) > 2);
  }
}

TEST_CASE("a slice covers the part of the plane inside the map only") {
  const Grid map = espdiff_test::map_of({{{2, 1, 0}, 1}});
  const CameraView view{{5, 0, 0}, {0, 0, 1}, {0, 1, 0}, 12};
  CHECK(make_slice({&map, {}}, view, 10, 0.5, scale()) != nullptr);
  const CameraView away{{500, 0, 0}, {0, 0, 1}, {0, 1, 0}, 12};
  CHECK(make_slice({&map, {}}, away, 10, 0.5, scale()) == nullptr);
}
