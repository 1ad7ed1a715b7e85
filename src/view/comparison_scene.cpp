// comparison_scene.cpp: panels, their surfaces, and one camera for all of them.
#include "view/comparison_scene.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "view/camera_view.h"
#include "view/legend.h"
#include "view/map_drawings.h"
#include "view/molecule_actors.h"
#include "view/residue_labels.h"
#include "view/scene_legend.h"

namespace espdiff {
namespace {

constexpr double kTurn = 6.28318530717958647693;

std::string view_name(int i, int n_views) {
  if (n_views == 1) return "";
  if (n_views == 2) return i == 0 ? "front" : "back";
  return std::to_string(i * 360 / n_views) + "\xC2\xB0";
}

/// What the third of the linked views shows.
RenderArray compared(RenderArray array) {
  const bool is_one_side = array == RenderArray::kSource || array == RenderArray::kTarget;
  return is_one_side ? RenderArray::kDifference : array;
}

Panel turned_panel(const Scene& scene, int i, bool fades) {
  Panel panel;
  panel.name = view_name(i, scene.n_views);
  panel.angle = kTurn * i / scene.n_views;
  panel.sheets = {{scene.array, scene.morph, fades, 0, 0, 1}};
  return panel;
}

/// The surface, and those outside of it, side by side.
Panel offset_panel(const Scene& scene, std::size_t i, bool fades) {
  Panel panel;
  const double offset = i == 0 ? 0 : scene.offsets_A[i - 1];
  panel.name = i == 0 ? "surface" : readable_number(offset) + " \xC3\x85 outside";
  panel.sheets = {{scene.array, scene.morph, fades, offset, 0, 1}};
  return panel;
}

/// The surface moved outward along its normals, on both molecules: where the potentials are compared instead.
std::unique_ptr<SurfaceFile> moved_outward(const SurfaceFile& surface, const StartSurface& start,
                                           const RigidTransform& source_to_target, double offset_A) {
  auto moved = std::make_unique<SurfaceFile>(surface);
  const double* r = source_to_target.rotation;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    moved->positions[i] += offset_A * static_cast<Vec3d>(surface.normals[i]);
    const auto n = static_cast<Vec3d>(start.normals[i]);
    // Back into the source's own frame, by the transpose.
    moved->source_positions[i] += offset_A * Vec3d{r[0] * n.x + r[3] * n.y + r[6] * n.z,
                                                   r[1] * n.x + r[4] * n.y + r[7] * n.z,
                                                   r[2] * n.x + r[5] * n.y + r[8] * n.z};
  }
  return moved;
}

std::vector<Panel> panels_of(const Scene& scene, bool fades) {
  std::vector<Panel> panels;
  if (!scene.offsets_A.empty()) {
    for (std::size_t i = 0; i <= scene.offsets_A.size(); ++i) panels.push_back(offset_panel(scene, i, fades));
  } else if (scene.layout == Layout::kTurned) {
    for (int i = 0; i < scene.n_views; ++i) panels.push_back(turned_panel(scene, i, fades));
  } else if (scene.layout == Layout::kLinked) {
    panels.resize(3);
    panels[0].name = "source";
    panels[0].sheets = {{RenderArray::kSource, 0, false, 0, 0, 1}};
    panels[1].name = "target";
    panels[1].sheets = {{RenderArray::kTarget, 1, false, 0, 0, 1}};
    panels[2].name = "target \xE2\x88\x92 source";
    panels[2].sheets = {{compared(scene.array), scene.morph, fades, 0, 0, 1}};
  } else {
    panels.resize(1);
    panels[0].sheets = {{RenderArray::kSource, 0, false, 0, 0, scene.split},
                        {RenderArray::kTarget, 1, false, 0, scene.split, 1}};
  }
  return panels;
}

/// Colours of potentials are compared by eye: both sides have one scale.
std::vector<float> both_potentials(const SurfaceFile& surface) {
  std::vector<float> values = surface.potential_source;
  values.insert(values.end(), surface.potential_target.begin(), surface.potential_target.end());
  return values;
}

}  // namespace

ComparisonScene::ComparisonScene(const ComparisonFiles& files, Scene scene)
    : files_(files),
      scene_(std::move(scene)),
      geometry_(files.surface, files.record, files.maps),
      source_texture_(std::make_shared<MapTexture>(files.maps.source)),
      target_texture_(std::make_shared<MapTexture>(files.maps.target)) {
  check(scene_);
  unit_ = scene_.unit.empty() ? files_.surface.potential_unit : scene_.unit;
  const SurfaceFile& surface = files_.surface;
  std::vector<bool> is_shown(surface.positions.size(), false);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.has_counterpart(t)) continue;
    for (const std::uint32_t corner : surface.triangles[t]) is_shown[corner] = true;
  }
  const std::vector<float>& values = surface.values(scene_.array);
  for (std::size_t i = 0; i < is_shown.size(); ++i) {
    if (!is_shown[i]) continue;
    shown_positions_.push_back(surface.positions[i]);
    shown_values_.push_back(values.empty() ? 0 : values[i]);
    shown_normals_.push_back(surface.normals[i]);
  }
  choose_scales();
  make_offsets();
}

void ComparisonScene::make_offsets() {
  offsets_.clear();
  for (const double offset : scene_.offsets_A) {
    auto moved = moved_outward(files_.surface, geometry_.start(), files_.record.source_to_target, offset);
    auto geometry = std::make_unique<SurfaceGeometry>(*moved, files_.record, files_.maps);
    offsets_.emplace_back(std::move(moved), std::move(geometry));
  }
}

void ComparisonScene::choose_scales() {
  scales_.clear();
  map_scale_.reset();
  if (!scene_.isopotentials.empty() || scene_.n_field_lines > 0 || scene_.slice) {
    const ScaleRange automatic{0, scene_.range.percentile, false, 0, 0};
    map_scale_.emplace(RenderArray::kTarget, both_potentials(files_.surface), automatic, diverging_map(scene_.colours));
  }
  const bool fades = false;
  for (const Panel& panel : panels_of(scene_, fades)) {
    for (const Sheet& sheet : panel.sheets) {
      const bool has_scale =
          std::any_of(scales_.begin(), scales_.end(), [&](const ColourScale& s) { return s.array() == sheet.array; });
      if (has_scale) continue;
      const bool is_one_side = sheet.array == RenderArray::kSource || sheet.array == RenderArray::kTarget;
      const bool shares = scene_.layout != Layout::kTurned && is_one_side;
      // A range that was given is that of the array that it was given for.
      ScaleRange range = scene_.range;
      const bool is_asked_for = sheet.array == compared(scene_.array) || (shares && scene_.layout == Layout::kSplit);
      if (!is_asked_for && scene_.layout != Layout::kTurned) range = {0, scene_.range.percentile, false, 0, 0};
      scales_.emplace_back(sheet.array, shares ? both_potentials(files_.surface) : files_.surface.values(sheet.array),
                           range, diverging_map(scene_.colours));
    }
  }
}

const ColourScale& ComparisonScene::scale(RenderArray array) const {
  for (const ColourScale& scale : scales_) {
    if (scale.array() == array) return scale;
  }
  throw Error(ErrorClass::kInternal, std::string("no colour scale for ") + to_string(array));
}

void ComparisonScene::lay_out() {
  // A displacement is in the colour already; fading it too would hide the places it is to show.
  const bool fades = scene_.fade && scene_.array != RenderArray::kDisplacement && !files_.surface.displacement.empty();
  panels_ = panels_of(scene_, fades);
  const LegendShares shares = legend_shares(scene_);
  const auto n = static_cast<double>(panels_.size());
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    panels_[i].left = static_cast<double>(i) / n;
    panels_[i].right = static_cast<double>(i + 1) / n;
    panels_[i].bottom = shares.bottom;
    panels_[i].top = shares.top;
  }
}

void ComparisonScene::add_sheet(const Panel& panel, const Sheet& sheet) {
  const double width = scene_.width * scale_factor_;
  SurfaceLook look;
  look.scale = scale(sheet.array);
  look.opacity = scene_.opacity;
  // Linked views keep the two sides whole, whatever shows through the third.
  if (&panel != &panels_.back()) look.opacity.greatest = scene_.layout == Layout::kLinked ? 1 : look.opacity.greatest;
  look.fades = sheet.fades;
  look.morph = sheet.morph;
  look.hatch_pixels = 7 * scale_factor_;
  look.splits = sheet.from > 0 || sheet.to < 1;
  look.first_column = width * (panel.left + sheet.from * (panel.right - panel.left));
  look.last_column = width * (panel.left + sheet.to * (panel.right - panel.left));
  const SurfaceGeometry* geometry = &geometry_;
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    if (sheet.offset_A == scene_.offsets_A[i]) geometry = offsets_[i].second.get();
  }
  for (const SurfacePart part : {SurfacePart::kTrusted, SurfacePart::kCorrupt, SurfacePart::kWithoutCounterpart}) {
    // What has no counterpart has its place on the source only.
    if (part == SurfacePart::kWithoutCounterpart && sheet.morph > 0) continue;
    if (!geometry->has(part)) continue;
    vtkNew<SurfaceMapper> mapper;
    mapper->SetInputData(geometry->part(part));
    mapper->set_part(part);
    mapper->set_look(look);
    if (per_fragment()) mapper->set_maps(source_texture_, target_texture_);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    // Through a faint place the paper shows, not the inside of the far wall.
    actor->GetProperty()->BackfaceCullingOn();
    if (look.fades || look.opacity.greatest < 1 || part == SurfacePart::kCorrupt)
      actor->ForceTranslucentOn();
    else
      actor->ForceOpaqueOn();
    panel.renderer->AddActor(actor);
  }
}

void ComparisonScene::add_molecule(const Panel& panel) {
  const bool is_source = panel.sheets.front().morph == 0;
  const std::optional<Molecule>& molecule = is_source ? files_.source_molecule : files_.target_molecule;
  if (!molecule) return;
  const double line_pixels = 1.5 * scale_factor_;
  const auto add = [&](const std::vector<bool>& residues, MoleculeStyle style) {
    if (const auto drawn = make_molecule_actor(with_residues(*molecule, residues), style, line_pixels))
      panel.renderer->AddViewProp(drawn);
  };
  add(polymer_residues(*molecule), scene_.molecule);
  if (scene_.around_A > 0) add(residues_around(*molecule, scene_.around_A), MoleculeStyle::kSticks);
}

void ComparisonScene::add_labels(const Panel& panel) {
  if (!files_.source_molecule) return;
  for (const ResidueMark& mark : most_different_residues(files_.surface, scene_.n_labels)) {
    const std::string text = residue_name(*files_.source_molecule, mark.residue);
    for (const auto& prop : make_label(mark, text, scene_.height * scale_factor_ / 60)) panel.renderer->AddViewProp(prop);
  }
}

void ComparisonScene::add_map_drawings(const Panel& panel) {
  if (!map_scale_) return;
  const bool is_source = panel.sheets.front().morph == 0;
  PlacedMap map{files_.maps.target.get(), {}};
  if (is_source) map = {files_.maps.source.get(), files_.record.source_to_target};
  const auto add = [&](const vtkSmartPointer<vtkProp>& prop) {
    if (prop != nullptr) panel.renderer->AddViewProp(prop);
  };
  for (const double value : scene_.isopotentials) add(make_isopotential(map, value, *map_scale_));
  if (scene_.n_field_lines > 0) {
    const auto lines = trace_field_lines(map, shown_positions_, shown_normals_, scene_.n_field_lines);
    add(make_field_lines(map, lines, *map_scale_));
  }
  if (scene_.slice) {
    double radius = 0;
    for (const Vec3d& p : shown_positions_) radius = std::max(radius, norm(p - camera_.centre));
    add(make_slice(map, camera_, 1.15 * radius, *scene_.slice, *map_scale_));
  }
}

void ComparisonScene::fill(Panel& panel) {
  panel.renderer = vtkSmartPointer<vtkRenderer>::New();
  panel.renderer->SetViewport(panel.left, panel.bottom, panel.right, panel.top);
  panel.renderer->SetBackground(1, 1, 1);
  // Sorts every fragment by depth; without it, faint triangles would cover or miss each other by their order in the
  // file.
  panel.renderer->UseDepthPeelingOn();
  panel.renderer->SetMaximumNumberOfPeels(16);
  panel.renderer->SetOcclusionRatio(0);
  add_lights(panel.renderer);
  if (scene_.surface) {
    for (const Sheet& sheet : panel.sheets) add_sheet(panel, sheet);
  }
  add_molecule(panel);
  add_map_drawings(panel);
  // Names stand where the compared surface is.
  const bool is_compared = scene_.layout == Layout::kTurned || &panel == &panels_.back();
  if (scene_.n_labels > 0 && is_compared) add_labels(panel);
  window_->AddRenderer(panel.renderer);
}

void ComparisonScene::add_to(vtkRenderWindow* window, double scale_factor) {
  window_ = window;
  scale_factor_ = scale_factor;
  window->SetNumberOfLayers(2);
  window->SetAlphaBitPlanes(1);
  window->SetMultiSamples(0);
  paper_->SetBackground(1, 1, 1);
  paper_->InteractiveOff();
  window->AddRenderer(paper_);
  lay_out();
  const Panel& first = panels_.front();
  const double aspect = (first.top - first.bottom) * scene_.height / ((first.right - first.left) * scene_.width);
  camera_ = choose_camera(scene_, shown_positions_, shown_values_, aspect);
  for (Panel& panel : panels_) fill(panel);
  for (Panel& panel : panels_) {
    const bool shares_camera = scene_.layout == Layout::kLinked && &panel != &panels_.front();
    if (shares_camera) panel.renderer->SetActiveCamera(panels_.front().renderer->GetActiveCamera());
    place_camera(panel.renderer, camera_, panel.angle);
  }
  writing_->SetLayer(1);
  writing_->InteractiveOff();
  window->AddRenderer(writing_);
  write_legend();
}

void ComparisonScene::write_legend() {
  writing_->RemoveAllViewProps();
  if (scene_.legend) add_scene_legend(writing_, *this, scale_factor_);
}

void ComparisonScene::change_to(const Scene& scene) {
  scene_ = scene;
  check(scene_);
  choose_scales();
  make_offsets();
  for (const Panel& panel : panels_) window_->RemoveRenderer(panel.renderer);
  camera_ = camera_of(panels_.front().renderer);
  lay_out();
  for (Panel& panel : panels_) fill(panel);
  for (Panel& panel : panels_) {
    if (scene_.layout == Layout::kLinked && &panel != &panels_.front())
      panel.renderer->SetActiveCamera(panels_.front().renderer->GetActiveCamera());
    place_camera(panel.renderer, camera_, panel.angle);
  }
  write_legend();
}

}  // namespace espdiff
