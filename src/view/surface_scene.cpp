// surface_scene.cpp: actors, lights, cameras and the layout of the picture.
#include "view/surface_scene.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "view/legend.h"
#include "view/orientation.h"

namespace espdiff {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kCorruptOpacity = 0.3;

/// Shares of the picture's height, from the bottom: legend, views, title.
constexpr double kLegendShare = 0.19;
constexpr double kTitleShare = 0.09;
/// Room left around the surface in each view.
constexpr double kMargin = 1.06;

bool is_corrupt(const SurfaceFile& surface, std::size_t triangle) {
  return !surface.corrupt.empty() && surface.corrupt[triangle] != 0;
}

vtkNew<vtkPolyData> with_vertices(const SurfaceFile& surface) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vec3d p = surface.positions[i];
    const Vec3f n = surface.normals[i];
    points->InsertNextPoint(p.x, p.y, p.z);
    normals->InsertNextTuple3(n.x, n.y, n.z);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  return data;
}

void add_triangles(vtkPolyData* data, const SurfaceFile& surface, bool corrupt) {
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (is_corrupt(surface, i) != corrupt) continue;
    const Triangle& t = surface.triangles[i];
    cells->InsertNextCell({static_cast<vtkIdType>(t[0]), static_cast<vtkIdType>(t[1]), static_cast<vtkIdType>(t[2])});
  }
  data->SetPolys(cells);
}

vtkNew<vtkUnsignedCharArray> colours_of(const SurfaceFile& surface, const ColourScale& scale,
                                        const RenderOptions& options) {
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(4);
  // A displacement is in the colour already; fading it too would hide the places it is to show.
  const bool fades = options.array != RenderArray::kDisplacement && !surface.displacement.empty();
  for (std::size_t i = 0; i < surface.values.size(); ++i) {
    const Rgb colour = scale.colour(surface.values[i]);
    const double opacity = fades ? options.opacity.opacity(surface.displacement[i]) : 1;
    colours->InsertNextTuple4(colour.red, colour.green, colour.blue, std::lround(255 * opacity));
  }
  return colours;
}

void set_material(vtkActor* actor) {
  vtkProperty* material = actor->GetProperty();
  material->SetInterpolationToPhong();
  material->SetAmbient(0.28);
  material->SetDiffuse(0.82);
  material->SetSpecular(0.06);
  material->SetSpecularPower(20);
}

/// The trusted surface. Back faces are left out: through a faint place the paper shows, not the inside of the far wall.
vtkNew<vtkActor> make_surface_actor(const SurfaceFile& surface, const ColourScale& scale,
                                    const RenderOptions& options) {
  vtkNew<vtkPolyData> data = with_vertices(surface);
  add_triangles(data, surface, false);
  data->GetPointData()->SetScalars(colours_of(surface, scale, options));
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetColorModeToDirectScalars();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_material(actor);
  actor->GetProperty()->BackfaceCullingOn();
  return actor;
}

/// The corrupt triangles: faint grey whatever their values.
vtkNew<vtkActor> make_corrupt_actor(const SurfaceFile& surface) {
  vtkNew<vtkPolyData> data = with_vertices(surface);
  add_triangles(data, surface, true);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_material(actor);
  actor->GetProperty()->SetColor(kNoValueColour.red / 255.0, kNoValueColour.green / 255.0, kNoValueColour.blue / 255.0);
  actor->GetProperty()->SetOpacity(kCorruptOpacity);
  actor->GetProperty()->BackfaceCullingOn();
  return actor;
}

void add_light(vtkRenderer* renderer, double x, double y, double z, double intensity) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(x, y, z);
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(intensity);
  renderer->AddLight(light);
}

void add_lights(vtkRenderer* renderer) {
  renderer->AutomaticLightCreationOff();
  add_light(renderer, -0.5, 0.7, 1.0, 0.75);
  add_light(renderer, 0.7, -0.3, 1.0, 0.35);
}

void place_camera(vtkRenderer* renderer, const Orientation& view, double angle, double half_height_A) {
  const Vec3d toward = std::cos(angle) * view.toward_viewer + std::sin(angle) * view.right;
  const double distance = 3 * view.radius_A + 1;
  const Vec3d eye = view.centre + distance * toward;
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(half_height_A);
  camera->SetFocalPoint(view.centre.x, view.centre.y, view.centre.z);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->SetViewUp(view.up.x, view.up.y, view.up.z);
  camera->SetClippingRange(distance - 1.01 * view.radius_A, distance + 1.01 * view.radius_A);
}

std::string view_name(int i, int n_views) {
  if (n_views == 2) return i == 0 ? "front" : "back";
  return std::to_string(i * 360 / n_views) + "\xC2\xB0";
}

/// What the picture's lower part says, and where: length bar on the left, colours in the middle, opacity on the right.
void add_legend(vtkRenderer* renderer, const SurfaceFile& surface, const ColourScale& scale,
                const RenderOptions& options, const std::string& unit, double width, double height,
                double pixels_per_A) {
  // A narrow picture needs smaller text, so that its three legends stay apart.
  const double text_height = std::min(height / 42, width / 64);
  Legend legend(renderer, text_height);
  if (!options.title.empty()) {
    legend.text(width / 2, height * (1 - kTitleShare / 2), options.title, Align::kCentre, 1.5);
  }
  for (int i = 0; options.n_views > 1 && i < options.n_views; ++i) {
    legend.text(width * (i + 0.5) / options.n_views, height * (kLegendShare + 0.015), view_name(i, options.n_views),
                Align::kCentre);
  }
  const double bar_bottom = height * 0.085;
  const double bar_top = bar_bottom + 0.95 * text_height;
  legend.length(width * 0.04, (bar_bottom + bar_top) / 2, width * 0.16, pixels_per_A);
  legend.colours({width * 0.31, bar_bottom, width * 0.66, bar_top}, scale, legend_title(options.array, unit));

  const bool fades = options.array != RenderArray::kDisplacement && !surface.displacement.empty();
  if (fades) legend.opacity({width * 0.79, bar_bottom, width * 0.95, bar_top}, options.opacity);
  const bool has_corrupt = std::find(surface.corrupt.begin(), surface.corrupt.end(), 1) != surface.corrupt.end();
  const double key_y = height * 0.02 + text_height / 2;
  double x = width * 0.79;
  if (scale.has_missing()) x += legend.key(x, key_y, kNoValueColour, 1, "no value") + text_height;
  if (has_corrupt) legend.key(x, key_y, kNoValueColour, kCorruptOpacity, "corrupt");
}

}  // namespace

void add_surface_scene(vtkRenderWindow* window, const SurfaceFile& surface, const ColourScale& scale,
                       const RenderOptions& options, const std::string& unit, double scale_factor) {
  const double width = options.width * scale_factor;
  const double height = options.height * scale_factor;
  const double top = options.title.empty() ? 1.0 - 0.25 * kTitleShare : 1.0 - kTitleShare;
  const double view_width = width / options.n_views;
  const double bottom = kLegendShare + (options.n_views > 1 ? 0.03 : 0.0);
  const double view_height = height * (top - bottom);

  const Orientation view =
      choose_orientation(surface.positions, surface.values, view_height > view_width, options.n_views);
  const double half_height_A =
      std::max({kMargin * view.half_height_A, kMargin * view.half_width_A * view_height / view_width, 0.5});

  vtkNew<vtkActor> surface_actor = make_surface_actor(surface, scale, options);
  vtkNew<vtkActor> corrupt_actor = make_corrupt_actor(surface);
  window->SetNumberOfLayers(2);
  window->SetAlphaBitPlanes(1);
  window->SetMultiSamples(0);
  vtkNew<vtkRenderer> legend_renderer;
  legend_renderer->SetBackground(1, 1, 1);
  legend_renderer->InteractiveOff();
  window->AddRenderer(legend_renderer);
  for (int i = 0; i < options.n_views; ++i) {
    vtkNew<vtkRenderer> renderer;
    renderer->SetViewport(static_cast<double>(i) / options.n_views, bottom, (i + 1.0) / options.n_views, top);
    renderer->SetBackground(1, 1, 1);
    renderer->AddActor(surface_actor);
    renderer->AddActor(corrupt_actor);
    // Sorts every fragment by depth; without it, faint triangles would cover or miss each other by their order in the
    // file.
    renderer->UseDepthPeelingOn();
    renderer->SetMaximumNumberOfPeels(16);
    renderer->SetOcclusionRatio(0);
    add_lights(renderer);
    place_camera(renderer, view, 2 * kPi * i / options.n_views, half_height_A);
    window->AddRenderer(renderer);
  }
  add_legend(legend_renderer, surface, scale, options, unit, width, height, view_height / (2 * half_height_A));
}

}  // namespace espdiff
