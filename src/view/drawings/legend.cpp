// legend.cpp: builds the legend from polygons and text, with exact positions and sizes in pixels.
#include "view/drawings/legend.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFreeTypeTools.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/formatted.h"

namespace espdiff {
namespace {

constexpr double kInk = 0.1;

struct Point2 {
  double x, y;
};

void add_polygon(vtkRenderer* renderer, const std::vector<Point2>& corners, Rgb colour, double opacity) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(corners.size()));
  for (const Point2& corner : corners) cells->InsertCellPoint(points->InsertNextPoint(corner.x, corner.y, 0));
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->SetPolys(cells);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shape);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
  actor->GetProperty()->SetOpacity(opacity);
  renderer->AddActor2D(actor);
}

}  // namespace

std::string readable_number(double value) {
  return (value < 0 ? "\xE2\x88\x92" : "") + formatted("%.4g", std::abs(value));
}

double round_down_to_length(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= value) return factor * power;
  }
  return power;
}

Legend::Legend(vtkRenderer* renderer, double text_height) : renderer_(renderer), text_height_(text_height) {
  // VTK's built-in font, because the system's choice for "Arial" differs between machines.
  vtkFreeTypeTools::GetInstance()->ForceCompiledFontsOn();
}

void Legend::text(double x, double y, const std::string& words, Align align, double factor) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(words.c_str());
  actor->SetTextScaleModeToNone();
  actor->SetPosition(x, y);
  vtkTextProperty* style = actor->GetTextProperty();
  style->SetFontFamilyToArial();
  style->SetFontSize(static_cast<int>(std::lround(text_height_ * factor)));
  style->SetColor(kInk, kInk, kInk);
  style->SetVerticalJustificationToCentered();
  if (align == Align::kCentre) style->SetJustificationToCentered();
  if (align == Align::kRight) style->SetJustificationToRight();
  renderer_->AddActor2D(actor);
}

void Legend::rectangle(const PixelBox& box, Rgb colour, double opacity) {
  add_polygon(renderer_, {{box.left, box.bottom}, {box.right, box.bottom}, {box.right, box.top}, {box.left, box.top}},
              colour, opacity);
}

void Legend::triangle(double x0, double y0, double x1, double y1, double x2, double y2, Rgb colour) {
  add_polygon(renderer_, {{x0, y0}, {x1, y1}, {x2, y2}}, colour, 1.0);
}

void Legend::strip(const PixelBox& bar, const std::vector<Rgb>& colours, const std::vector<double>& opacities) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetNumberOfComponents(4);
  const auto n = static_cast<double>(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double left = bar.left + bar.width() * static_cast<double>(i) / n,
                 right = bar.left + bar.width() * static_cast<double>(i + 1) / n;
    cells->InsertNextCell(4);
    for (const Point2& corner : {Point2{left, bar.bottom}, {right, bar.bottom}, {right, bar.top}, {left, bar.top}})
      cells->InsertCellPoint(points->InsertNextPoint(corner.x, corner.y, 0));
    bytes->InsertNextTuple4(colours[i].red, colours[i].green, colours[i].blue, std::round(255 * opacities[i]));
  }
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->SetPolys(cells);
  shape->GetCellData()->SetScalars(bytes);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shape);
  mapper->SetScalarModeToUseCellData();
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  renderer_->AddActor2D(actor);
}

void Legend::line(double x0, double y0, double x1, double y1, Rgb colour) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  const double half = std::max(2.0, text_height_ / 8) / 2;
  if (length < half) return;
  const double across_x = -(y1 - y0) / length * half, across_y = (x1 - x0) / length * half;
  add_polygon(renderer_,
              {{x0 - across_x, y0 - across_y},
               {x1 - across_x, y1 - across_y},
               {x1 + across_x, y1 + across_y},
               {x0 + across_x, y0 + across_y}},
              colour, 1.0);
}

void Legend::axes(double x, double y, double length, Vec3d right, Vec3d up, Vec3d toward_viewer) {
  struct Axis {
    double across, upward, toward;
    const char* letter;
  };
  std::array<Axis, 3> all = {{{right.x, up.x, toward_viewer.x, "x"},
                              {right.y, up.y, toward_viewer.y, "y"},
                              {right.z, up.z, toward_viewer.z, "z"}}};
  std::sort(all.begin(), all.end(), [](const Axis& a, const Axis& b) { return a.toward < b.toward; });
  for (const Axis& axis : all) {
    const Rgb colour = axis.toward < -0.05 ? Rgb{150, 150, 150} : Rgb{26, 26, 26};
    line(x, y, x + length * axis.across, y + length * axis.upward, colour);
    // Beside the end, where the axis is visible; an axis that points at the viewer has its letter at the origin.
    const double beyond = length + 0.7 * text_height_;
    text(x + beyond * axis.across, y + beyond * axis.upward, axis.letter, Align::kCentre);
  }
}

void Legend::frame(const PixelBox& box) {
  const double line = std::max(1.0, text_height_ / 16);
  constexpr Rgb kLine{90, 90, 90};
  rectangle({box.left - line, box.bottom - line, box.right + line, box.bottom}, kLine);
  rectangle({box.left - line, box.top, box.right + line, box.top + line}, kLine);
  rectangle({box.left - line, box.bottom, box.left, box.top}, kLine);
  rectangle({box.right, box.bottom, box.right + line, box.top}, kLine);
}

double Legend::text_width(const std::string& words) const {
  // Accurate enough for layout; the font's true widths differ by a few per cent.
  return 0.57 * text_height_ * static_cast<double>(words.size());
}

double Legend::key(double x, double y, Rgb colour, double opacity, const std::string& meaning) {
  const double side = text_height_;
  const PixelBox box{x, y - side / 2, x + side, y + side / 2};
  rectangle(box, colour, opacity);
  frame(box);
  text(x + 1.5 * side, y, meaning, Align::kLeft);
  return key_width(meaning);
}

double Legend::hatched_key(double x, double y, const std::string& meaning) {
  const double side = text_height_;
  constexpr int kStripes = 3;
  const double step = side / kStripes;
  rectangle({x, y - side / 2, x + side, y + side / 2}, {237, 237, 237});
  for (int i = 0; i < kStripes; ++i) {
    // Two triangles per stripe cut it where it leaves the square, at the diagonal.
    const double a = x + i * step, b = a + 0.45 * step;
    const double top = y + side / 2;
    triangle(a, top, b, top, x, top - (a - x), kNoValueColour);
    triangle(b, top, x, top - (b - x), x, top - (a - x), kNoValueColour);
    const double right = x + side, bottom = y - side / 2;
    const double c = bottom + side - i * step, d = c - 0.45 * step;
    triangle(right, c, right, d, right - (c - bottom), bottom, kNoValueColour);
    triangle(right, d, right - (c - bottom), bottom, right - (d - bottom), bottom, kNoValueColour);
  }
  frame({x, y - side / 2, x + side, y + side / 2});
  text(x + 1.5 * side, y, meaning, Align::kLeft);
  return key_width(meaning);
}

void Legend::rule(double x, double bottom, double top) {
  const double half = std::max(1.0, text_height_ / 12) / 2;
  rectangle({x - half, bottom, x + half, top}, {26, 26, 26});
}

void Legend::colours(const PixelBox& bar, const ColourScale& scale, const std::string& title) {
  const double middle = (bar.left + bar.right) / 2;
  text(middle, bar.top + text_height_, title, Align::kCentre, 1.1);
  if (scale.two_classes()) {
    const double y = (bar.bottom + bar.top) / 2;
    key(bar.left, y, kSameSignColour, 1, "same");
    key(middle, y, kSignChangeColour, 1, "changed");
    return;
  }
  constexpr int kSteps = 256;
  std::vector<Rgb> colours;
  for (int i = 0; i < kSteps; ++i) {
    const double value = scale.low() + (scale.high() - scale.low()) * (i + 0.5) / kSteps;
    colours.push_back(scale.colour(static_cast<float>(value)));
  }
  strip(bar, colours, std::vector<double>(kSteps, 1.0));
  frame(bar);
  const double gap = text_height_ / 6;
  const double middle_y = (bar.bottom + bar.top) / 2;
  const double point = bar.height() * 0.8;
  if (scale.exceeds_low()) {
    triangle(bar.left - gap, bar.bottom, bar.left - gap, bar.top, bar.left - gap - point, middle_y,
             scale.colour(static_cast<float>(scale.low())));
  }
  if (scale.exceeds_high()) {
    triangle(bar.right + gap, bar.bottom, bar.right + gap + point, middle_y, bar.right + gap, bar.top,
             scale.colour(static_cast<float>(scale.high())));
  }
  constexpr int kTicks = 4;
  const double tick = text_height_ / 4;
  for (int i = 0; i <= kTicks; ++i) {
    const double x = bar.left + bar.width() * i / kTicks;
    const double half_line = std::max(1.0, text_height_ / 16) / 2;
    rectangle({x - half_line, bar.bottom - tick, x + half_line, bar.bottom}, {90, 90, 90});
    text(x, bar.bottom - tick - 0.7 * text_height_,
         readable_number(scale.low() + (scale.high() - scale.low()) * i / kTicks), Align::kCentre);
  }
}

void Legend::length(double x, double y, double max_pixels, double pixels_per_A) {
  const double length_A = round_down_to_length(max_pixels / pixels_per_A);
  const double right = x + length_A * pixels_per_A;
  const double line = std::max(2.0, text_height_ / 8);
  const double end = text_height_ / 3;
  constexpr Rgb kLine{26, 26, 26};
  rectangle({x, y - line / 2, right, y + line / 2}, kLine);
  rectangle({x, y - end, x + line, y + end}, kLine);
  rectangle({right - line, y - end, right, y + end}, kLine);
  text((x + right) / 2, y - 1.1 * text_height_, readable_number(length_A) + " \xC3\x85", Align::kCentre);
}

void Legend::opacity(const PixelBox& bar, const OpacityScale& scale) {
  text((bar.left + bar.right) / 2, bar.top + text_height_,
       scale.to_grey ? "grey: far from its own atoms" : "faint: far from its own atoms", Align::kCentre);
  const double highest_A = scale.faint_above_A * 1.2;
  constexpr int kSteps = 64;
  std::vector<double> opacities;
  opacities.reserve(kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const double value = highest_A * (i + 0.5) / kSteps;
    opacities.push_back(scale.to_grey ? scale.faded(value) : scale.opacity(value));
  }
  strip(bar, std::vector<Rgb>(kSteps, scale.to_grey ? Rgb{90, 90, 90} : Rgb{110, 110, 110}), opacities);
  frame(bar);
  for (const double value : {scale.opaque_below_A, scale.faint_above_A}) {
    const double x = bar.left + bar.width() * std::clamp(value / highest_A, 0.0, 1.0);
    const double tick = text_height_ / 4;
    rectangle({x - 1, bar.bottom - tick, x + 1, bar.bottom}, {90, 90, 90});
    text(x, bar.bottom - tick - 0.7 * text_height_, readable_number(value) + " \xC3\x85", Align::kCentre);
  }
}

}  // namespace espdiff
