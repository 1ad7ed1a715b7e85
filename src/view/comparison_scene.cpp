// comparison_scene.cpp: surfaces and molecules in their panels, and one camera for all of them.
#include "view/comparison_scene.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "view/drawings/camera_view.h"
#include "view/drawings/field_lines.h"
#include "view/drawings/map_drawings.h"
#include "view/drawings/molecule_actors.h"
#include "view/drawings/residue_labels.h"
#include "view/scene_legend.h"

namespace espdiff {
namespace {

/// Both sides share one scale, since their potentials are compared by eye.
std::vector<float> both_potentials(const SurfaceFile& surface) {
  std::vector<float> values = surface.potential_source;
  values.insert(values.end(), surface.potential_target.begin(), surface.potential_target.end());
  return values;
}

bool draws_maps(const Scene& scene) {
  return !scene.isopotentials.empty() || scene.n_field_lines > 0 || scene.slice.has_value();
}

/// Whether two scenes contain the same objects, apart from their look.
bool same_things(const Scene& a, const Scene& b) {
  return a.layout == b.layout && a.n_views == b.n_views && a.width == b.width && a.height == b.height &&
         a.surface == b.surface && a.molecule == b.molecule && a.around_A == b.around_A && a.n_labels == b.n_labels &&
         a.causes == b.causes && a.focus == b.focus && a.isopotentials == b.isopotentials &&
         a.offsets_A == b.offsets_A && a.n_field_lines == b.n_field_lines && a.slice == b.slice &&
         a.legend == b.legend && a.title.empty() == b.title.empty() && a.colours == b.colours;
}

}  // namespace

ComparisonScene::ComparisonScene(const ComparisonFiles& files, Scene scene)
    : files_(files),
      scene_(std::move(scene)),
      geometry_(files.surface, files.record, files.maps, outlined_residues(files.record, scene_)),
      source_texture_(std::make_shared<MapTexture>(files.maps.source)),
      target_texture_(std::make_shared<MapTexture>(files.maps.target)),
      no_texture_(std::make_shared<MapTexture>(nullptr)) {
  check(scene_);
  const SurfaceFile& surface = files_.surface;
  std::vector<bool> is_shown(surface.positions.size(), false);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.is_matched(t)) continue;
    for (const std::uint32_t corner : surface.triangles[t]) is_shown[corner] = true;
  }
  for (std::size_t i = 0; i < is_shown.size(); ++i) {
    if (!is_shown[i]) continue;
    shown_.push_back(i);
    shown_positions_.push_back(surface.positions[i]);
  }
  choose_scales(scene_);
}

void ComparisonScene::choose_scales(const Scene& scene) {
  unit_ = scene.unit.empty() ? files_.surface.potential_unit : scene.unit;
  std::vector<ColourScale> scales;
  const ScaleRange automatic{0, scene.range.percentile, false, 0, 0};
  const ScaleRange of_potentials{scene.potential_limit, scene.range.percentile, false, 0, 0};
  const DivergingMap& map = diverging_map(scene.colours);
  for (const Panel& panel : panels_of(scene, false)) {
    for (const Sheet& sheet : panel.sheets) {
      const auto is_same = [&](const ColourScale& s) { return s.array() == sheet.array; };
      if (std::any_of(scales.begin(), scales.end(), is_same)) continue;
      const bool is_one_side = sheet.array == RenderArray::kSource || sheet.array == RenderArray::kTarget;
      const bool shares = scene.layout != Layout::kTurned && is_one_side;
      // A given range applies only to the array it was given for.
      const bool is_asked_for = scene.layout == Layout::kLinked ? sheet.array == compared_array(scene.array) : true;
      scales.emplace_back(sheet.array, shares ? both_potentials(files_.surface) : files_.surface.values(sheet.array),
                          is_asked_for ? scene.range
                          : shares     ? of_potentials
                                       : automatic,
                          map, files_.surface.is_signed);
    }
  }
  std::optional<ColourScale> map_scale;
  if (draws_maps(scene)) map_scale.emplace(RenderArray::kTarget, both_potentials(files_.surface), automatic, map);
  scales_ = std::move(scales);
  map_scale_ = std::move(map_scale);
}

const ColourScale& ComparisonScene::scale(RenderArray array) const {
  for (const ColourScale& scale : scales_) {
    if (scale.array() == array) return scale;
  }
  throw Error(ErrorClass::kInternal, std::string("no colour scale for ") + to_string(array));
}

void ComparisonScene::make_offsets() {
  offsets_.clear();
  for (const double offset : scene_.offsets_A) {
    auto moved = moved_outward(files_.surface, geometry_.start(), files_.record.source_to_target, offset);
    auto geometry = std::make_unique<SurfaceGeometry>(*moved, files_.record, files_.maps);
    offsets_.emplace_back(std::move(moved), std::move(geometry));
  }
}

void ComparisonScene::lay_out() {
  // What is already shown as colour need not fade; fading would hide the places of interest.
  const bool shows_uncertainty = shows_certainty(scene_.array);
  const bool fades = scene_.fade && !shows_uncertainty && !files_.surface.uncertainty().empty();
  std::vector<Panel> panels = panels_of(scene_, fades);
  const LegendShares shares = legend_shares(scene_);
  place(panels, shares.bottom, shares.top);
  for (std::size_t i = 0; i < panels.size() && i < panels_.size(); ++i) panels[i].renderer = panels_[i].renderer;
  panels_ = std::move(panels);
}

SurfaceLook ComparisonScene::look_of(const Panel& panel, const Sheet& sheet) const {
  const double width = scene_.width * scale_factor_;
  SurfaceLook look;
  look.scale = scale(sheet.array);
  look.opacity = scene_.opacity;
  if (shows_significance()) {
    look.opacity.opaque_below_A = files_.surface.alpha;
    look.opacity.faint_above_A = 1.2 * files_.surface.alpha;
  }
  // Linked views keep the two sides opaque; only the third fades.
  if (scene_.layout == Layout::kLinked && &panel != &panels_.back()) look.opacity.greatest = 1;
  constexpr double kAboveCauses = 0.4;
  if (!scene_.causes.empty() && look.opacity.greatest == 1) look.opacity.greatest = kAboveCauses;
  look.opacity.least = std::min(look.opacity.least, look.opacity.greatest);
  look.fades = sheet.fades;
  look.morph = sheet.morph;
  look.hatch_pixels = 7 * scale_factor_;
  look.cuts = geometry_.has(SurfacePart::kUnmatched);
  look.marks = geometry_.has_untrusted() && compares_places(sheet.array);
  look.outlines = !outlined_residues(files_.record, scene_).empty();
  look.splits = sheet.from > 0 || sheet.to < 1;
  look.first_column = width * (panel.left + sheet.from * (panel.right - panel.left));
  look.last_column = width * (panel.left + sheet.to * (panel.right - panel.left));
  return look;
}

void ComparisonScene::add_parts(std::size_t panel, std::size_t sheet) {
  const double offset = panels_[panel].sheets[sheet].offset_A;
  const SurfaceGeometry* geometry = &geometry_;
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    if (offset == scene_.offsets_A[i]) geometry = offsets_[i].second.get();
  }
  for (const SurfacePart part : {SurfacePart::kMatched, SurfacePart::kUnmatched}) {
    if (!geometry->has(part)) continue;
    auto mapper = vtkSmartPointer<SurfaceMapper>::New();
    mapper->SetInputData(geometry->part(part));
    mapper->set_part(part);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    // Through a translucent surface the molecule shows, not the inside of the far wall.
    actor->GetProperty()->BackfaceCullingOn();
    panels_[panel].renderer->AddActor(actor);
    parts_.push_back({panel, sheet, part, geometry, mapper, actor});
  }
}

void ComparisonScene::update_looks() {
  for (const DrawnPart& drawn : parts_) {
    const Panel& panel = panels_[drawn.panel];
    SurfaceLook look = look_of(panel, panel.sheets[drawn.sheet]);
    look.inside_maps = drawn.geometry->inside_maps();
    drawn.mapper->set_look(look);
    drawn.mapper->set_maps(per_fragment() ? source_texture_ : no_texture_,
                           per_fragment() ? target_texture_ : no_texture_);
    if (look.opacity.greatest < 1)
      drawn.actor->ForceTranslucentOn();
    else
      drawn.actor->ForceTranslucentOff();
  }
}

void ComparisonScene::add_molecule(const Panel& panel) {
  const auto add = [&](const Molecule& molecule, const std::vector<bool>& residues, MoleculeStyle style) {
    const double line_pixels = 1.5 * scale_factor_;
    if (const auto drawn = make_molecule_actor(with_residues(molecule, residues), style, line_pixels))
      panel.renderer->AddViewProp(drawn);
  };
  const auto& molecule = panel.is_source() ? files_.source_molecule : files_.target_molecule;
  const auto& surroundings = panel.is_source() ? files_.source_surroundings : files_.target_surroundings;
  if (molecule && scene_.causes.empty()) add(*molecule, polymer_residues(*molecule), scene_.molecule);
  if (molecule && !scene_.focus.empty() && scene_.molecule != MoleculeStyle::kSticks)
    add(*molecule, focused_side_chains(*molecule, panel.is_source()), MoleculeStyle::kSticks);
  if (scene_.around_A > 0 && surroundings)
    add(*surroundings, residues_around(*surroundings, scene_.around_A), MoleculeStyle::kSticks);
}

void ComparisonScene::add_labels(const Panel& panel) {
  if (scene_.n_labels == 0 || !files_.source_molecule) return;
  for (const ResidueMark& mark : most_different_residues(files_.surface, scene_.n_labels)) {
    const std::string text = residue_name(*files_.source_molecule, mark.residue);
    const auto props = make_label(mark, text, scene_.height * scale_factor_ / 60);
    for (const auto& prop : props) panel.renderer->AddViewProp(prop);
    labels_.push_back({mark, panel.renderer, props});
  }
}

void ComparisonScene::add_map_drawings(const Panel& panel) {
  if (!map_scale_) return;
  PlacedMap map{files_.maps.target.get(), {}};
  if (panel.is_source()) map = {files_.maps.source.get(), files_.record.source_to_target};
  const auto add = [&](const vtkSmartPointer<vtkProp>& prop) {
    if (prop != nullptr) panel.renderer->AddViewProp(prop);
  };
  for (const double value : scene_.isopotentials) add(make_isopotential(map, value, *map_scale_));
  if (scene_.n_field_lines > 0) {
    std::vector<Vec3f> normals;
    for (const std::size_t i : shown_) normals.push_back(files_.surface.normals[i]);
    add(make_field_lines(map, trace_field_lines(map, shown_positions_, normals, scene_.n_field_lines), *map_scale_));
  }
  if (scene_.slice) {
    double radius = 0;
    for (const Vec3d& p : shown_positions_) radius = std::max(radius, norm(p - camera_.centre));
    add(make_slice(map, camera_, 1.15 * radius, *scene_.slice, *map_scale_));
  }
}

void ComparisonScene::fill_panels() {
  parts_.clear();
  labels_.clear();
  make_offsets();
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    Panel& panel = panels_[p];
    panel.renderer = vtkSmartPointer<vtkRenderer>::New();
    panel.renderer->SetViewport(panel.left, panel.bottom, panel.right, panel.top);
    panel.renderer->SetBackground(1, 1, 1);
    // Sorts fragments by depth; otherwise translucent triangles would hide each other according to their order in the
    // file.
    panel.renderer->UseDepthPeelingOn();
    panel.renderer->SetMaximumNumberOfPeels(16);
    panel.renderer->SetOcclusionRatio(0);
    add_lights(panel.renderer);
    for (std::size_t s = 0; scene_.surface && s < panel.sheets.size(); ++s) add_parts(p, s);
    add_molecule(panel);
    add_causes(panel);
    add_map_drawings(panel);
    // Labels belong to the compared surface.
    if (scene_.layout == Layout::kTurned || p + 1 == panels_.size()) add_labels(panel);
    window_->AddRenderer(panel.renderer);
  }
  update_looks();
  share_camera();
}

void ComparisonScene::share_camera() {
  for (Panel& panel : panels_) {
    const bool shares = scene_.layout == Layout::kLinked && &panel != &panels_.front();
    if (shares) panel.renderer->SetActiveCamera(panels_.front().renderer->GetActiveCamera());
    place_camera(panel.renderer, camera_, panel.angle);
  }
}

double ComparisonScene::view_aspect() const {
  const Panel& first = panels_.front();
  return (first.top - first.bottom) * scene_.height / ((first.right - first.left) * scene_.width);
}

void ComparisonScene::aim_camera() {
  const double aspect = view_aspect();
  std::vector<float> values;
  const std::vector<float>& all = files_.surface.values(scene_.array);
  for (const std::size_t i : shown_) values.push_back(all.empty() ? 0 : all[i]);
  camera_ = choose_camera(scene_, shown_positions_, values, aspect);
  // The outermost surface must fit too, and the labels beside it.
  double beside_A = scene_.n_labels > 0 || !scene_.causes.empty() ? 6 : 0;
  for (const double offset : scene_.offsets_A) beside_A = std::max(beside_A, offset);
  if (!scene_.camera && scene_.focus.empty()) {
    const double whole = height_that_fits(camera_, geometry_.cover().positions, aspect) / scene_.zoom;
    camera_.half_height_A = std::max(camera_.half_height_A, whole);
  }
  if (!scene_.camera && !scene_.focus.empty()) aim_at_focus(aspect);
  if (!scene_.camera) camera_.half_height_A += beside_A * std::max(1.0, aspect) / scene_.zoom;
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
  aim_camera();
  fill_panels();
  writing_->SetLayer(1);
  writing_->InteractiveOff();
  window->AddRenderer(writing_);
  gauges_->SetLayer(1);
  gauges_->InteractiveOff();
  window->AddRenderer(gauges_);
  write_legend();
}

void ComparisonScene::write_legend() {
  writing_->RemoveAllViewProps();
  if (scene_.legend) add_scene_legend(writing_, *this, scale_factor_);
  camera_moved();
}

void ComparisonScene::camera_moved() {
  place_labels();
  gauges_->RemoveAllViewProps();
  add_scene_gauges(gauges_, *this, scale_factor_);
}

void ComparisonScene::change_to(const Scene& scene) {
  check(scene);
  choose_scales(scene);
  const bool only_looks = same_things(scene, scene_);
  camera_ = camera_of(panels_.front().renderer);
  const double fitted = height_that_fits(camera_, shown_positions_, view_aspect());
  scene_ = scene;
  if (!only_looks) {
    for (const Panel& panel : panels_) window_->RemoveRenderer(panel.renderer);
    panels_.clear();
  }
  lay_out();
  // Views of another shape show as much of the molecule as the previous ones.
  camera_.half_height_A *= height_that_fits(camera_, shown_positions_, view_aspect()) / fitted;
  if (only_looks)
    update_looks();
  else
    fill_panels();
  write_legend();
}

void ComparisonScene::reset_camera() {
  scene_.camera.reset();
  aim_camera();
  share_camera();
  camera_moved();
}

}  // namespace espdiff
