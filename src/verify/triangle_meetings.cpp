// triangle_meetings.cpp: candidates by bounding boxes, then segments against triangles.
#include "verify/triangle_meetings.h"

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>
#include <array>

#include "base/progress.h"
#include "verify/target_surface.h"

namespace espdiff {
namespace {

/// Triangles in the box of one; a surface has some tens.
constexpr vtkIdType kMostCandidates = 5000;

/// Six times the volume of a tetrahedron.
double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(cross(b - a, c - a), d - a);
}

bool crosses(const Vec3d& s, const Vec3d& t, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double side_s = volume(a, b, c, s), side_t = volume(a, b, c, t);
  if (side_s * side_t > 0 || (side_s == 0 && side_t == 0)) return false;
  const double first = volume(s, t, a, b), second = volume(s, t, b, c), third = volume(s, t, c, a);
  return (first >= 0 && second >= 0 && third >= 0) || (first <= 0 && second <= 0 && third <= 0);
}

struct Surface {
  const std::vector<Vec3d>& positions;
  const std::vector<Triangle>& triangles;

  Vec3d corner(std::size_t t, std::size_t k) const { return positions[triangles[t][k % 3]]; }
  bool edge_crosses(std::size_t t, std::size_t from, std::size_t other) const {
    return crosses(corner(t, from), corner(t, from + 1), corner(other, 0), corner(other, 1), corner(other, 2));
  }
  bool has_no_area(std::size_t t) const {
    const Vec3d n = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    return dot(n, n) == 0;
  }

  bool meet(std::size_t p, std::size_t q) const {
    std::size_t n_shared = 0, at_p = 0, at_q = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (triangles[p][i] != triangles[q][j]) continue;
        ++n_shared;
        at_p = i;
        at_q = j;
      }
    }
    if (n_shared >= 2) return false;  // folded flat onto each other: no sign in floating point tells
    if (n_shared == 1) return edge_crosses(p, at_p + 1, q) || edge_crosses(q, at_q + 1, p);
    for (std::size_t k = 0; k < 3; ++k) {
      if (edge_crosses(p, k, q) || edge_crosses(q, k, p)) return true;
    }
    return false;
  }
};

}  // namespace

std::size_t count_meetings(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return 0;
  const Surface surface{positions, triangles};
  const auto mesh = polydata(positions, triangles);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(mesh);
  locator->BuildLocator();
  vtkNew<vtkIdList> candidates;
  std::size_t n = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    CancelRequest().check();
    n += surface.has_no_area(t) ? 1 : 0;
    std::array<double, 6> box{};
    mesh->GetCellBounds(static_cast<vtkIdType>(t), box.data());
    candidates->Reset();
    locator->FindCellsWithinBounds(box.data(), candidates);
    if (candidates->GetNumberOfIds() > kMostCandidates) return n + static_cast<std::size_t>(kMostCandidates);
    for (vtkIdType k = 0; k < candidates->GetNumberOfIds(); ++k) {
      const auto other = static_cast<std::size_t>(candidates->GetId(k));
      n += other > t && surface.meet(t, other) ? 1 : 0;
    }
  }
  return n;
}

}  // namespace espdiff
