// scene_focus.cpp: the part that a scene looks at, the causes of its difference, and labels in front of the surface.
#include "base/error.h"
#include "scene/surface_cover.h"
#include "view/comparison_scene.h"
#include "view/drawings/camera_view.h"
#include "view/drawings/cause_drawings.h"
#include "view/drawings/residue_labels.h"

namespace espdiff {

std::vector<bool> ComparisonScene::focused_side_chains(const Molecule& molecule, bool is_source) const {
  const std::vector<int> focused = focused_residues(files_.record, scene_);
  std::vector<bool> kept(molecule.residues.size(), false);
  if (is_source) {
    for (const int residue : focused) kept.at(static_cast<std::size_t>(residue)) = true;
    return kept;
  }
  // The target's residues that lie where the source's do: the superposed source's nearest within 3 A of an atom.
  constexpr double kNear_A = 3;
  const Molecule& source = *files_.source_molecule;
  std::vector<bool> of_source(source.residues.size(), false);
  for (const int residue : focused) of_source.at(static_cast<std::size_t>(residue)) = true;
  for (std::size_t a = 0; a < molecule.size(); ++a) {
    if (molecule.atoms[a].name != "CA" && molecule.atoms[a].name != "C1'") continue;
    for (std::size_t b = 0; b < source.size(); ++b) {
      if (of_source[static_cast<std::size_t>(source.atoms[b].residue)] &&
          source.atoms[b].name == molecule.atoms[a].name && norm(source.positions[b] - molecule.positions[a]) < kNear_A)
        kept[static_cast<std::size_t>(molecule.atoms[a].residue)] = true;
    }
  }
  return kept;
}

void ComparisonScene::add_causes(const Panel& panel) {
  if (!files_.causes || !files_.source_molecule) return;
  const CauseDrawing drawing{*files_.source_molecule, *files_.causes, diverging_map(scene_.colours),
                             scene_.height * scale_factor_ / 60};
  for (const auto& prop : make_causes(drawing, scene_.molecule)) panel.renderer->AddViewProp(prop);
  for (const CauseLabel& label : make_cause_labels(drawing)) {
    for (const auto& prop : label.props) panel.renderer->AddViewProp(prop);
    labels_.push_back({label.mark, panel.renderer, label.props, true});
  }
  const auto outline =
      make_outline(files_.surface, residues_of_reading(files_.record, drawing), scene_.height * scale_factor_ / 250);
  if (outline != nullptr) panel.renderer->AddViewProp(outline);
}

void ComparisonScene::place_labels() {
  for (const PlacedLabel& label : labels_) {
    const Vec3d toward = camera_of(label.renderer).toward_viewer;
    const bool is_seen =
        label.is_inside || !is_hidden(files_.surface.triangles, geometry_.cover().positions, label.mark, toward);
    for (const auto& prop : label.props) prop->SetVisibility(is_seen);
    lift_label(label.props, label.mark, label.renderer);
  }
}

void ComparisonScene::aim_at_focus(double aspect) {
  const std::vector<float> share = share_of_residues(files_.surface, focused_residues(files_.record, scene_));
  std::vector<Vec3d> places;
  Vec3d centre{}, outward{};
  for (std::size_t v = 0; v < share.size(); ++v) {
    if (share[v] < 0.5F) continue;
    places.push_back(geometry_.cover().positions[v]);
    centre += places.back();
    outward += static_cast<Vec3d>(geometry_.cover().normals[v]);
  }
  if (places.empty()) throw InputError(option("focus", scene_.focus) + " has no surface to look at");
  camera_.centre = (1.0 / static_cast<double>(places.size())) * centre;
  const double length = norm(outward);
  if (length > 1e-6) camera_.toward_viewer = (1 / length) * outward;
  const Vec3d up = camera_.up - dot(camera_.up, camera_.toward_viewer) * camera_.toward_viewer;
  const Vec3d across = norm(up) > 0.1 ? up : cross(camera_.toward_viewer, Vec3d{1, 0.3, 0.2});
  camera_.up = (1 / norm(across)) * across;
  constexpr double kMargin = 1.25;
  camera_.half_height_A = kMargin * height_that_fits(camera_, places, aspect) / scene_.zoom;
}

}  // namespace espdiff
