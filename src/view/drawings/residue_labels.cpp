// residue_labels.cpp: selects residues and places their labels.
#include "view/drawings/residue_labels.h"

#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCamera.h>
#include <vtkFreeTypeTools.h>
#include <vtkLineSource.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace espdiff {
namespace {

constexpr int kFewestVertices = 20;
constexpr double kLabelsApart_A = 9, kOffSurface_A = 4;
constexpr double kPin_A = 2.8;  // ends before the text

struct Sum {
  double difference = 0;
  Vec3d place{}, normal{};
  int n = 0;
};

std::size_t nearest_vertex(const SurfaceFile& surface, float residue, Vec3d place) {
  std::size_t nearest = 0;
  double least = 1e30;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const double distance = norm(surface.positions[i] - place);
    if (surface.residue_index[i] == residue && distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return nearest;
}

}  // namespace

std::vector<ResidueMark> most_different_residues(const SurfaceFile& surface, int n) {
  std::map<int, Sum> sums;
  const std::vector<float>& residues = surface.values(RenderArray::kResidue);
  const std::vector<float>& differences = surface.values(RenderArray::kDifference);
  for (std::size_t i = 0; i < residues.size(); ++i) {
    if (residues[i] < 0 || !std::isfinite(differences[i])) continue;
    Sum& sum = sums[static_cast<int>(residues[i])];
    sum.difference += std::abs(differences[i]);
    sum.place += surface.positions[i];
    sum.normal += static_cast<Vec3d>(surface.normals[i]);
    ++sum.n;
  }
  std::vector<std::pair<double, int>> order;
  for (const auto& [residue, sum] : sums) {
    if (sum.n >= kFewestVertices) order.emplace_back(-sum.difference / sum.n, residue);
  }
  std::sort(order.begin(), order.end());
  std::vector<ResidueMark> marks;
  for (const auto& [negative, residue] : order) {
    if (static_cast<int>(marks.size()) == n) break;
    const Sum& sum = sums[residue];
    const std::size_t at = nearest_vertex(surface, static_cast<float>(residue), (1.0 / sum.n) * sum.place);
    const Vec3d place = surface.positions[at];
    const bool crowds = std::any_of(marks.begin(), marks.end(),
                                    [&](const ResidueMark& m) { return norm(m.place - place) < kLabelsApart_A; });
    if (!crowds) marks.push_back({residue, -negative, place, static_cast<Vec3d>(surface.normals[at])});
  }
  return marks;
}

std::string residue_name(const Molecule& molecule, int residue) {
  const Residue& r = molecule.residues.at(static_cast<std::size_t>(residue));
  const bool several = std::any_of(molecule.residues.begin(), molecule.residues.end(),
                                   [&](const Residue& other) { return other.chain != r.chain; });
  const std::string insertion = r.insertion_code == ' ' ? "" : std::string(1, r.insertion_code);
  return r.name + " " + (several ? r.chain : "") + std::to_string(r.number) + insertion;
}

bool is_hidden(const std::vector<Triangle>& triangles, const std::vector<Vec3d>& positions, const ResidueMark& mark,
               Vec3d toward_viewer) {
  constexpr double kLeastFacing = 0.15;
  if (dot(mark.outward, toward_viewer) < kLeastFacing) return true;
  const Vec3d from = mark.place + kPin_A * mark.outward;
  // Moller and Trumbore's test of a ray with each triangle.
  for (const Triangle& t : triangles) {
    const Vec3d a = positions[t[1]] - positions[t[0]], b = positions[t[2]] - positions[t[0]];
    const Vec3d normal = cross(toward_viewer, b);
    const double determinant = dot(a, normal);
    if (std::abs(determinant) < 1e-12) continue;
    const Vec3d away = from - positions[t[0]];
    const double u = dot(away, normal) / determinant;
    if (u < 0 || u > 1) continue;
    const Vec3d q = cross(away, a);
    const double v = dot(toward_viewer, q) / determinant;
    if (v >= 0 && u + v <= 1 && dot(b, q) / determinant > 0) return true;
  }
  return false;
}

void lift_label(const std::vector<vtkSmartPointer<vtkProp>>& label, const ResidueMark& mark, vtkRenderer* renderer) {
  vtkCamera* camera = renderer->GetActiveCamera();
  double eye[3], direction[3], range[2];
  camera->GetPosition(eye);
  camera->GetDirectionOfProjection(direction);
  camera->GetClippingRange(range);
  const Vec3d toward{-direction[0], -direction[1], -direction[2]};
  const Vec3d end = mark.place + kOffSurface_A * mark.outward;
  constexpr double kBehindNearPlane = 0.02;
  const double depth = range[0] + kBehindNearPlane * (range[1] - range[0]);
  const Vec3d at = end + (dot(Vec3d{eye[0], eye[1], eye[2]} - end, toward) - depth) * toward;
  for (const auto& prop : label) {
    if (auto* const text = vtkBillboardTextActor3D::SafeDownCast(prop)) text->SetPosition(at.x, at.y, at.z);
  }
}

std::vector<vtkSmartPointer<vtkProp>> make_label(const ResidueMark& mark, const std::string& text, double text_pixels) {
  vtkFreeTypeTools::GetInstance()->ForceCompiledFontsOn();
  const Vec3d end = mark.place + kOffSurface_A * mark.outward;
  const Vec3d tip = mark.place + kPin_A * mark.outward;
  vtkNew<vtkLineSource> line;
  line->SetPoint1(mark.place.x, mark.place.y, mark.place.z);
  line->SetPoint2(tip.x, tip.y, tip.z);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(line->GetOutputPort());
  auto pin = vtkSmartPointer<vtkActor>::New();
  pin->SetMapper(mapper);
  pin->GetProperty()->SetColor(0.1, 0.1, 0.1);
  pin->GetProperty()->SetLineWidth(static_cast<float>(text_pixels / 9));
  pin->GetProperty()->LightingOff();
  auto label = vtkSmartPointer<vtkBillboardTextActor3D>::New();
  label->SetInput(text.c_str());
  label->SetPosition(end.x, end.y, end.z);
  vtkTextProperty* style = label->GetTextProperty();
  style->SetFontFamilyToArial();
  style->SetBold(1);
  style->SetFontSize(static_cast<int>(std::lround(text_pixels)));
  style->SetColor(0.1, 0.1, 0.1);
  style->SetBackgroundColor(1, 1, 1);
  style->SetBackgroundOpacity(0.75);
  style->SetJustificationToCentered();
  style->SetVerticalJustificationToCentered();
  return {pin, label};
}

}  // namespace espdiff
