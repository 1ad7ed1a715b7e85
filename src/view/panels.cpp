// panels.cpp: the layouts.
#include "view/panels.h"

#include "view/drawings/legend.h"

namespace espdiff {
namespace {

constexpr double kTurn = 6.28318530717958647693;

std::string view_name(int i, int n_views) {
  if (n_views == 1) return "";
  if (n_views == 2) return i == 0 ? "front" : "back";
  return std::to_string(i * 360 / n_views) + "\xC2\xB0";
}

std::string compared_name(RenderArray array) {
  switch (array) {
    case RenderArray::kMagnitude: return "|target \xE2\x88\x92 source|";
    case RenderArray::kSign: return "change of sign";
    case RenderArray::kDisplacement: return "distance to the counterpart";
    case RenderArray::kResidue: return "residues";
    case RenderArray::kPlain: return "shape";
    case RenderArray::kSlip: return "slip";
    case RenderArray::kWhy: return "trusted, or why not";
    default: return "target \xE2\x88\x92 source";
  }
}

Panel turned_panel(const Scene& scene, int i, bool fades) {
  Panel panel;
  panel.name = view_name(i, scene.n_views);
  panel.angle = kTurn * i / scene.n_views;
  panel.sheets = {{scene.array, scene.morph, fades, 0, 0, 1}};
  return panel;
}

/// The surface and its offset surfaces, side by side.
Panel offset_panel(const Scene& scene, std::size_t i, bool fades) {
  Panel panel;
  const double offset = i == 0 ? 0 : scene.offsets_A[i - 1];
  panel.name = i == 0 ? "surface" : readable_number(offset) + " \xC3\x85 outside";
  panel.sheets = {{scene.array, scene.morph, fades, offset, 0, 1}};
  return panel;
}

}  // namespace

RenderArray compared_array(RenderArray array) {
  const bool is_one_side = array == RenderArray::kSource || array == RenderArray::kTarget;
  return is_one_side ? RenderArray::kDifference : array;
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
    panels[2].name = compared_name(compared_array(scene.array));
    panels[2].sheets = {{compared_array(scene.array), scene.morph, fades, 0, 0, 1}};
  } else {
    panels.resize(1);
    panels[0].sheets = {{RenderArray::kSource, 0, false, 0, 0, scene.split},
                        {RenderArray::kTarget, 1, false, 0, scene.split, 1}};
  }
  return panels;
}

void place(std::vector<Panel>& panels, double bottom, double top) {
  const auto n = static_cast<double>(panels.size());
  for (std::size_t i = 0; i < panels.size(); ++i) {
    panels[i].left = static_cast<double>(i) / n;
    panels[i].right = static_cast<double>(i + 1) / n;
    panels[i].bottom = bottom;
    panels[i].top = top;
  }
}

}  // namespace espdiff
