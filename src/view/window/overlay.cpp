// overlay.cpp: draws text and slider with the legend's functions.
#include "view/window/overlay.h"

#include <vtkRenderWindow.h>

#include <algorithm>
#include <cmath>

#include "scene/scene_keys.h"
#include "view/drawings/legend.h"
#include "view/scene_legend.h"

namespace espdiff {
namespace {

/// Pixels of the window.
constexpr double kText = 15, kLine = 21;
constexpr Rgb kTrack{150, 150, 150}, kKnob{40, 40, 40}, kPaper{255, 255, 255};

/// The slider's track, as fractions of the window.
constexpr double kLeft = 0.09, kRight = 0.18, kHeight = 0.165;

}  // namespace

void Overlay::add_to(vtkRenderWindow* window) {
  window->SetNumberOfLayers(3);
  renderer_->SetLayer(2);
  renderer_->InteractiveOff();
  window->AddRenderer(renderer_);
}

bool Overlay::is_on_slider(const Scene& scene, int x, int y) const {
  if (!has_slider_ || !scene.legend || scene.layout == Layout::kSplit) return false;
  return x >= kLeft * scene.width - kText && x <= kRight * scene.width + kText &&
         std::abs(y - kHeight * scene.height) <= kText;
}

double Overlay::slider_value(const Scene& scene, int x) const {
  return std::clamp((static_cast<double>(x) / scene.width - kLeft) / (kRight - kLeft), 0.0, 1.0);
}

void Overlay::draw_slider(const Scene& scene) {
  Legend legend(renderer_, kText);
  const double y = kHeight * scene.height;
  const double left = kLeft * scene.width, right = kRight * scene.width;
  legend.rectangle({left, y - 1.5, right, y + 1.5}, kTrack);
  const double knob = left + scene.morph * (right - left);
  legend.rectangle({knob - 5, y - 8, knob + 5, y + 8}, kKnob);
  legend.text(left - kText, y, "source", Align::kRight);
  legend.text(right + kText, y, "target", Align::kLeft);
}

void Overlay::draw_lines(const std::vector<std::string>& lines, double left, double top) {
  // A column of keys, and one of descriptions.
  constexpr double kColumn = 8.2 * kText;
  Legend legend(renderer_, kText);
  std::vector<std::pair<std::string, std::string>> columns;
  double width = 0;
  for (const std::string& line : lines) {
    const std::size_t gap = line.find("  ");
    const std::string says = gap == std::string::npos ? "" : line.substr(line.find_first_not_of(' ', gap));
    columns.emplace_back(line.substr(0, gap), says);
    const double column = says.empty() ? 0 : kColumn;
    width = std::max(width, column + 0.6 * kText * static_cast<double>(says.empty() ? line.size() : says.size()));
  }
  legend.rectangle({left, top - kLine * static_cast<double>(lines.size()) - 12, left + width + 20, top}, kPaper, 0.88);
  double y = top - 6 - kLine / 2;
  for (const auto& [name, says] : columns) {
    legend.text(left + 10, y, name, Align::kLeft);
    if (!says.empty()) legend.text(left + 10 + kColumn, y, says, Align::kLeft);
    y -= kLine;
  }
}

void Overlay::draw(const Scene& scene) {
  renderer_->RemoveAllViewProps();
  if (has_slider_ && scene.legend && scene.layout != Layout::kSplit) draw_slider(scene);
  const double top = legend_shares(scene).top * scene.height - 10;  // the head stays readable
  if (!lines_.empty()) draw_lines(lines_, 10, top);
  if (!shows_help_) return;
  std::vector<std::string> help;
  for (const ViewerKey& key : viewer_keys()) help.push_back(key.keys + "  " + key.help);
  draw_lines(help, std::max(10.0, scene.width - 520.0), top);
}

}  // namespace espdiff
