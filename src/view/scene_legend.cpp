// scene_legend.cpp: places the parts of the legend.
#include "view/scene_legend.h"

#include <vtkCamera.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/reasons.h"
#include "view/comparison_scene.h"
#include "view/drawings/camera_view.h"
#include "view/drawings/cause_drawings.h"
#include "view/drawings/legend.h"

namespace espdiff {
namespace {

/// Heights from the bottom as fractions of the picture's: legend, names of the views, title.
constexpr double kLegendShare = 0.19;
constexpr double kNameShare = 0.03;
constexpr double kTitleShare = 0.075;
/// The line at the top: what is compared, and the verdict.
constexpr double kHeadShare = 0.045;
/// What the molecule's colours mean, below the title.
constexpr double kCaptionShare = 0.045;

/// Behind a verdict that is not TRUSTWORTHY: on a part of the surface, and NOT TRUSTWORTHY.
constexpr Rgb kPartColour{250, 240, 170}, kWarningColour{255, 196, 120};

/// Short titles for scales side by side.
std::string short_title(RenderArray array, const ComparisonScene& scene) {
  const std::string& unit = scene.unit();
  const std::string& quantity = scene.surface_file().quantity;
  const std::string in_unit = unit.empty() ? "" : " (" + unit + ")";
  if (array == RenderArray::kSource || array == RenderArray::kTarget) return quantity + in_unit;
  if (array == RenderArray::kDifference) return "target \xE2\x88\x92 source" + in_unit;
  if (array == RenderArray::kMagnitude) return "|target \xE2\x88\x92 source|" + in_unit;
  if (array == RenderArray::kSign) return "sign";
  return legend_title(array, unit, quantity);
}

/// The groups of an ensemble instead of source and target.
std::string with_groups(std::string title, const ComparisonScene& scene) {
  const SurfaceFile& surface = scene.surface_file();
  const auto name = [&](const std::string& side, const std::string& group) {
    const std::size_t at = title.find(side);
    if (at != std::string::npos && !group.empty()) title.replace(at, side.size(), group);
  };
  name("source", surface.source_group);
  name("target", surface.target_group);
  return title;
}

/// Pixels of the window.
struct Paper {
  double width, height, text_height, bar_bottom, bar_top;

  PixelBox bar(double left, double right) const { return {width * left, bar_bottom, width * right, bar_top}; }
};

Paper paper_of(const ComparisonScene& drawn, double scale_factor) {
  const Scene& scene = drawn.scene();
  const double width = scene.width * scale_factor, height = scene.height * scale_factor;
  // A narrow picture needs smaller text to keep its legends apart.
  const double letters = drawn.panels().size() > 2 || drawn.map_scale() != nullptr ? 84 : 64;
  const double text_height = std::min(height / 42, width / letters);
  const double bottom = height * 0.085;
  return {width, height, text_height, bottom, bottom + 0.95 * text_height};
}

bool is_potential(RenderArray array) { return array == RenderArray::kSource || array == RenderArray::kTarget; }

/// The second scale: of both sides beside the compared one, or of the drawings of the maps.
const ColourScale* second_scale(const ComparisonScene& scene) {
  if (scene.scene().layout == Layout::kLinked) return &scene.scale(RenderArray::kSource);
  return is_potential(scene.scene().array) ? nullptr : scene.map_scale();
}

void add_scales(Legend& legend, const ComparisonScene& scene, const Paper& paper) {
  const auto add = [&](const ColourScale& scale, double left, double right, const std::string& title) {
    if (scale.has_bar()) legend.colours(paper.bar(left, right), scale, title);
  };
  const ColourScale& compared = scene.scale(scene.panels().back().sheets.front().array);
  if (!scene.scene().surface) {
    if (scene.map_scale() != nullptr) add(*scene.map_scale(), 0.31, 0.66, short_title(RenderArray::kTarget, scene));
    return;
  }
  if (const ColourScale* potential = second_scale(scene)) {
    add(*potential, 0.22, 0.46, short_title(potential->array(), scene));
    add(compared, 0.54, 0.76, short_title(compared.array(), scene));
    return;
  }
  const bool split = scene.scene().layout == Layout::kSplit;
  add(compared, 0.31, 0.66,
      split ? short_title(compared.array(), scene)
            : with_groups(legend_title(compared.array(), scene.unit(), scene.surface_file().quantity), scene));
}

/// One key a reason, with its share of the source's surface, in rows below a title.
void add_reasons(Legend& legend, const ComparisonScene& scene, const Paper& paper) {
  const double left = 0.25 * paper.width, right = 0.98 * paper.width, gap = 1.2 * paper.text_height;
  double x = left, y = paper.bar_top;
  legend.text((left + right) / 2, y + 1.7 * paper.text_height, legend_title(RenderArray::kWhy, ""), Align::kCentre);
  const auto place = [&](const std::string& meaning) {
    if (x > left && x + legend.key_width(meaning) > right) {
      x = left;
      y -= 1.6 * paper.text_height;
    }
    const double here = x;
    x += legend.key_width(meaning) + gap;
    return here;
  };
  const SurfaceFile& surface = scene.surface_file();
  const auto areas = areas_of_reasons({surface.triangles, surface.why, surface.turned},
                                      surface.source_positions.empty() ? surface.positions : surface.source_positions);
  double matched = 0;
  for (std::size_t r = 0; r < areas.size(); ++r) {
    matched += areas[r];
    if (!(areas[r] > 0)) continue;
    const std::string meaning = reason_in_words(kDrawnReasons[r].words, areas[r]);
    const double here = place(meaning);
    legend.key(here, y, kDrawnReasons[r].colour, 1, meaning);
  }
  if (!scene.geometry().has(SurfacePart::kUnmatched)) return;
  const std::string meaning = reason_in_words("unmatched", 1 - matched);
  const double here = place(meaning);
  legend.hatched_key(here, y, meaning);
}

void add_keys(Legend& legend, const ComparisonScene& scene, const Paper& paper) {
  if (!scene.scene().surface) return;
  if (scene.panels().back().sheets.front().array == RenderArray::kWhy) {
    add_reasons(legend, scene, paper);
    return;
  }
  const double left = second_scale(scene) != nullptr ? 0.82 : 0.79;
  const auto& sheets = scene.panels().back().sheets;
  const bool fades = std::any_of(sheets.begin(), sheets.end(), [](const Sheet& s) { return s.fades; });
  if (fades && scene.shows_significance()) {
    legend.key(paper.width * left, (paper.bar_bottom + paper.bar_top) / 2, kNoValueColour, scene.scene().opacity.least,
               "not significant, p > " + readable_number(scene.alpha()));
  } else if (fades) {
    legend.opacity(paper.bar(left, 0.96), scene.scene().opacity);
  }
  const bool untrusted = scene.geometry().has_untrusted() && compares_places(sheets.front().array);
  const bool no_value = !untrusted && scene.scale(sheets.front().array).has_missing();
  const bool unmatched = scene.geometry().has(SurfacePart::kUnmatched);
  const char* const unmatched_words = scene.shows_significance() ? "not tested" : "unmatched";
  const auto needed = [&](bool drawn, const char* meaning) {
    return drawn ? legend.key_width(meaning) + paper.text_height : 0.0;
  };
  const double all =
      needed(no_value, "no value") + needed(untrusted, "not trusted") + needed(unmatched, unmatched_words);
  const double y = paper.height * 0.02 + paper.text_height / 2;
  double x = std::min(paper.width * left, paper.width - all);
  const auto key = [&](const char* meaning) { x += legend.key(x, y, kNoValueColour, 1, meaning) + paper.text_height; };
  if (no_value) key("no value");
  if (untrusted) key("not trusted");
  if (unmatched) legend.hatched_key(x, y, unmatched_words);
}

void add_names(Legend& legend, const ComparisonScene& scene, const Paper& paper) {
  const double y = paper.height * (kLegendShare + 0.015);
  for (const Panel& panel : scene.panels()) {
    if (!panel.name.empty())
      legend.text(paper.width * (panel.left + panel.right) / 2, y, panel.name, Align::kCentre, 1.15);
  }
  if (scene.scene().layout != Layout::kSplit) return;
  const Panel& panel = scene.panels().front();
  const double x = paper.width * scene.scene().split;
  legend.rule(x, paper.height * panel.bottom, paper.height * panel.top);
  legend.text(x - paper.text_height, y, "source", Align::kRight, 1.15);
  legend.text(x + paper.text_height, y, "target", Align::kLeft, 1.15);
}

/// As many characters as fit, with "..." in the place of the rest.
std::string shortened(const std::string& words, double n_fitting) {
  const auto n = static_cast<std::size_t>(std::max(n_fitting, 8.0));
  return words.size() <= n ? words : words.substr(0, n - 3) + "...";
}

/// The compared files on the left, and on the right the verdict, loud where the result is not trusted as a whole.
void add_head(Legend& legend, const ComparisonScene& scene, const Paper& paper) {
  const RunRecord& record = scene.record();
  if (!record.found) return;
  const double y = paper.height * (1 - kHeadShare / 2), letter = 0.52 * paper.text_height;
  const std::string names = record.source_name + " to " + record.target_name;
  const std::string full = "TRUSTWORTHY";
  if (record.verdict == full) {
    legend.text(0.015 * paper.width, y, shortened(names, 0.7 * paper.width / letter), Align::kLeft);
    legend.text(0.985 * paper.width, y, record.verdict, Align::kRight);
    return;
  }
  std::string verdict = record.verdict;
  if (!record.reasons.empty()) verdict += ": " + record.reasons.front();
  if (record.trustworthy && !record.untrusted_parts.empty()) verdict += ": not " + record.untrusted_parts.front();
  const double n_names = std::min(0.35 * paper.width / letter, static_cast<double>(names.size()));
  legend.text(0.015 * paper.width, y, shortened(names, n_names), Align::kLeft);
  // Names have wide letters more often than sentences do.
  const double left = 0.03 * paper.width + n_names * 1.15 * letter;
  legend.rectangle({left, y - 0.8 * paper.text_height, paper.width, y + 0.8 * paper.text_height},
                   record.trustworthy ? kPartColour : kWarningColour);
  legend.text(left + 0.5 * paper.text_height, y, shortened(verdict, (paper.width - left) / letter - 3), Align::kLeft);
}

}  // namespace

LegendShares legend_shares(const Scene& scene) {
  if (!scene.legend) return {0, 1};
  const bool has_names = scene.layout != Layout::kTurned || scene.n_views > 1 || !scene.offsets_A.empty();
  return {kLegendShare + (has_names ? kNameShare : 0),
          1 - (scene.title.empty() ? 0 : kTitleShare) - kHeadShare - (scene.causes.empty() ? 0 : kCaptionShare)};
}

void add_scene_legend(vtkRenderer* renderer, const ComparisonScene& scene, double scale_factor) {
  const Paper paper = paper_of(scene, scale_factor);
  Legend legend(renderer, paper.text_height);
  if (!scene.scene().title.empty()) {
    legend.text(paper.width / 2, paper.height * (1 - kHeadShare - kTitleShare / 2), scene.scene().title, Align::kCentre,
                1.5);
  }
  if (scene.causes()) {
    const double title = scene.scene().title.empty() ? 0 : kTitleShare;
    const std::string words = causes_in_words(*scene.causes());
    const double size =
        std::min(1.0, 0.97 * paper.width / (0.52 * paper.text_height * static_cast<double>(words.size())));
    legend.text(paper.width / 2, paper.height * (1 - kHeadShare - title - kCaptionShare / 2), words, Align::kCentre,
                size);
  }
  add_head(legend, scene, paper);
  add_names(legend, scene, paper);
  add_scales(legend, scene, paper);
  add_keys(legend, scene, paper);
}

void add_scene_gauges(vtkRenderer* renderer, const ComparisonScene& scene, double scale_factor) {
  const Paper paper = paper_of(scene, scale_factor);
  Legend legend(renderer, paper.text_height);
  const Panel& panel = scene.panels().front();
  if (scene.scene().legend) {
    const double pixels_per_A =
        paper.height * (panel.top - panel.bottom) / (2 * panel.renderer->GetActiveCamera()->GetParallelScale());
    const bool linked = second_scale(scene) != nullptr;
    legend.length(paper.width * 0.04, (paper.bar_bottom + paper.bar_top) / 2, paper.width * (linked ? 0.12 : 0.16),
                  pixels_per_A);
  }
  if (!scene.scene().axes) return;
  const double length = 2.2 * paper.text_height, room = 2 * paper.text_height + length;
  const double* before = nullptr;
  for (const Panel& each : scene.panels()) {
    // If all views look in the same direction, one is enough.
    const double* from = each.renderer->GetActiveCamera()->GetDirectionOfProjection();
    if (before != nullptr && std::equal(from, from + 3, before)) continue;
    before = from;
    const CameraView view = camera_of(each.renderer);
    legend.axes(paper.width * each.left + room, paper.height * each.bottom + room, length,
                cross(view.up, view.toward_viewer), view.up, view.toward_viewer);
  }
}

}  // namespace espdiff
