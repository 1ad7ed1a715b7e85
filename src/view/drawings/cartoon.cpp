// cartoon.cpp: guide points along the backbone, and a closed profile swept along them.
#include "view/drawings/cartoon.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>

#include "base/molecule/secondary_structure.h"
#include "base/vector.h"

namespace espdiff {
namespace {

constexpr int kSteps = 8;     ///< spline steps per residue
constexpr int kCorners = 16;  ///< corners of the profile

/// Half axes of the profile, Angstrom.
struct Profile {
  double width = 0.3, thickness = 0.3;
};

constexpr Profile kHelix{1.25, 0.28}, kStrand{1.05, 0.28}, kCoil{0.3, 0.3};
constexpr double kArrowWidth = 1.8;

struct Guide {
  Vec3d centre, across;  ///< `across`: unit, in the plane of the peptide
  Fold fold = Fold::kCoil;
  Rgb colour{};
};

Rgb fold_colour(Fold fold) {
  return fold == Fold::kHelix ? kHelixColour : fold == Fold::kStrand ? kStrandColour : kCoilColour;
}

Vec3d unit(Vec3d v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec3d{1, 0, 0};
}

/// A stretch of bonded residues.
class Strip {
 public:
  explicit Strip(std::vector<Guide> guides) : guides_(std::move(guides)) { smooth_strands(); }

  void sweep(vtkPoints* points, vtkFloatArray* normals, vtkUnsignedCharArray* colours, vtkCellArray* cells) const {
    if (guides_.size() < 2) return;
    const int n_sections = (size() - 1) * kSteps + 1;
    const vtkIdType first = points->GetNumberOfPoints();
    for (int s = 0; s < n_sections; ++s) add_section(s, points, normals, colours);
    for (int s = 0; s + 1 < n_sections; ++s) {
      for (int k = 0; k < kCorners; ++k) {
        const vtkIdType section = first + vtkIdType{s} * kCorners;
        const vtkIdType a = section + k, b = section + (k + 1) % kCorners;
        cells->InsertNextCell({a, b, a + kCorners});
        cells->InsertNextCell({b, b + kCorners, a + kCorners});
      }
    }
    add_lid(first, true, cells);
    add_lid(first + static_cast<vtkIdType>(n_sections - 1) * kCorners, false, cells);
  }

 private:
  int size() const { return static_cast<int>(guides_.size()); }
  const Guide& at(int i) const { return guides_[static_cast<std::size_t>(std::min(std::max(i, 0), size() - 1))]; }

  /// A strand's C-alphas lie on alternating sides of the sheet; its ribbon runs through the middle.
  void smooth_strands() {
    std::vector<Guide> smooth = guides_;
    for (int i = 1; i + 1 < size(); ++i) {
      if (at(i).fold != Fold::kStrand) continue;
      Guide& guide = smooth[static_cast<std::size_t>(i)];
      guide.centre = 0.25 * (at(i - 1).centre + 2.0 * at(i).centre + at(i + 1).centre);
      guide.across = unit(at(i - 1).across + 2.0 * at(i).across + at(i + 1).across);
    }
    guides_ = std::move(smooth);
  }

  Profile profile_at(int i) const {
    const Fold fold = at(i).fold;
    return fold == Fold::kHelix ? kHelix : fold == Fold::kStrand ? kStrand : kCoil;
  }

  /// Between residues i and i + 1 at 0 <= t < 1.
  Profile profile(int i, double t) const {
    const bool is_last_of_strand = at(i).fold == Fold::kStrand && at(i + 1).fold != Fold::kStrand;
    Profile a = profile_at(i), b = profile_at(i + 1);
    if (is_last_of_strand) a.width = kArrowWidth;
    const double share = is_last_of_strand ? t : t * t * (3 - 2 * t);
    return {a.width + share * (b.width - a.width), a.thickness + share * (b.thickness - a.thickness)};
  }

  template <typename Get>
  Vec3d spline(int i, double t, const Get& get) const {
    const Vec3d p0 = get(at(i - 1)), p1 = get(at(i)), p2 = get(at(i + 1)), p3 = get(at(i + 2));
    return 0.5 * (2.0 * p1 + t * (p2 - p0) + (t * t) * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                  (t * t * t) * (3.0 * p1 - p0 - 3.0 * p2 + p3));
  }

  void add_section(int section, vtkPoints* points, vtkFloatArray* normals, vtkUnsignedCharArray* colours) const {
    const int i = std::min(section / kSteps, size() - 2);
    const double t = static_cast<double>(section - i * kSteps) / kSteps;
    const auto centre_of = [](const Guide& g) { return g.centre; };
    const Vec3d centre = spline(i, t, centre_of);
    constexpr double kNear = 1e-3;
    const Vec3d along = unit(spline(i, t + kNear, centre_of) - spline(i, t - kNear, centre_of));
    Vec3d across = (1 - t) * at(i).across + t * at(i + 1).across;
    across = unit(across - dot(across, along) * along);
    const Vec3d upward = cross(along, across);
    const Profile p = profile(i, t);
    const Rgb colour = at(t < 0.5 ? i : i + 1).colour;
    for (int k = 0; k < kCorners; ++k) {
      const double c = std::cos(2 * kPi * k / kCorners), s = std::sin(2 * kPi * k / kCorners);
      const Vec3d point = centre + (p.width * c) * across + (p.thickness * s) * upward;
      const Vec3d normal = unit((c / p.width) * across + (s / p.thickness) * upward);
      points->InsertNextPoint(point.x, point.y, point.z);
      normals->InsertNextTuple3(normal.x, normal.y, normal.z);
      colours->InsertNextTuple3(colour.red, colour.green, colour.blue);
    }
  }

  static void add_lid(vtkIdType first, bool at_start, vtkCellArray* cells) {
    for (vtkIdType k = 1; k + 1 < kCorners; ++k) {
      if (at_start)
        cells->InsertNextCell({first, first + k + 1, first + k});
      else
        cells->InsertNextCell({first, first + k, first + k + 1});
    }
  }

  std::vector<Guide> guides_;
};

/// Direction across the ribbon at a residue: in the plane of the following peptide, perpendicular to the chain.
Vec3d across_of(const Molecule& molecule, const Backbone& residue, Vec3d along, Vec3d before) {
  if (residue.c < 0 || residue.o < 0) return before;
  const Vec3d carbonyl =
      molecule.positions[static_cast<std::size_t>(residue.o)] - molecule.positions[static_cast<std::size_t>(residue.c)];
  const Vec3d across = unit(carbonyl - (dot(carbonyl, along) / dot(along, along)) * along);
  // Peptides of a strand point to alternating sides; the ribbon must not twist with them.
  return dot(across, before) < 0 ? -1.0 * across : across;
}

std::vector<Strip> strips_of(const Molecule& molecule, const std::vector<Rgb>& colours) {
  const std::vector<Backbone> backbone = backbone_of(molecule);
  const std::vector<Fold> folds = assign_folds(molecule, backbone);
  std::vector<Strip> strips;
  std::vector<Guide> guides;
  const auto place = [&](std::size_t r) { return molecule.positions[static_cast<std::size_t>(backbone[r].ca)]; };
  const auto is_bound = [&](std::size_t r) {
    return r + 1 < backbone.size() && backbone[r].ca >= 0 && backbone[r + 1].ca >= 0 &&
           molecule.residues[r].chain == molecule.residues[r + 1].chain &&
           are_bound(molecule, backbone[r], backbone[r + 1]);
  };
  for (std::size_t r = 0; r < backbone.size(); ++r) {
    const bool goes_on = is_bound(r);
    if (backbone[r].ca >= 0 && (goes_on || !guides.empty())) {
      const Vec3d along = goes_on ? place(r + 1) - place(r) : place(r) - place(r - 1);
      const Vec3d before = guides.empty() ? Vec3d{1, 0, 0} : guides.back().across;
      guides.push_back({place(r), across_of(molecule, backbone[r], along, before), folds[r],
                        colours.empty() ? fold_colour(folds[r]) : colours[r]});
    }
    if (goes_on || guides.empty()) continue;
    strips.emplace_back(std::move(guides));
    guides.clear();
  }
  return strips;
}

}  // namespace

vtkSmartPointer<vtkPolyData> make_cartoon(const Molecule& molecule, const std::vector<Rgb>& residue_colours) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  vtkNew<vtkCellArray> cells;
  for (const Strip& strip : strips_of(molecule, residue_colours)) strip.sweep(points, normals, colours, cells);
  auto ribbons = vtkSmartPointer<vtkPolyData>::New();
  ribbons->SetPoints(points);
  ribbons->SetPolys(cells);
  ribbons->GetPointData()->SetNormals(normals);
  ribbons->GetPointData()->SetScalars(colours);
  return ribbons;
}

}  // namespace espdiff
