// camera_view.cpp: turns an orientation into a camera.
#include "view/drawings/camera_view.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

#include "base/vector.h"
#include "scene/orientation.h"

namespace espdiff {
namespace {

constexpr double kDegree = kPi / 180;
/// Margin around the surface in each view.
constexpr double kMargin = 1.06;

double half_extent(const std::vector<Vec3d>& positions, Vec3d centre, Vec3d axis) {
  double largest = 0;
  for (const Vec3d& p : positions) largest = std::max(largest, std::abs(dot(p - centre, axis)));
  return largest;
}

void add_light(vtkRenderer* renderer, double x, double y, double z, double intensity) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(x, y, z);
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(intensity);
  renderer->AddLight(light);
}

}  // namespace

CameraView choose_camera(const Scene& scene, const std::vector<Vec3d>& positions, const std::vector<float>& values,
                         double aspect) {
  if (scene.camera) {
    CameraView given = *scene.camera;
    given.half_height_A /= scene.zoom;
    return given;
  }
  const int n_views = scene.layout == Layout::kTurned ? scene.n_views : 1;
  const std::vector<float> shown = values.empty() ? std::vector<float>(positions.size(), 0) : values;
  Orientation o = choose_orientation(positions, shown, aspect > 1, n_views);
  const double turn = scene.turn_deg * kDegree, tilt = scene.tilt_deg * kDegree;
  if (turn != 0 || tilt != 0) {
    // Rotating the molecule to the right means moving the camera to the left.
    const Vec3d forward = std::cos(turn) * o.toward_viewer - std::sin(turn) * o.right;
    o.right = cross(o.up, forward);
    o.toward_viewer = std::cos(tilt) * forward - std::sin(tilt) * o.up;
    o.up = cross(o.toward_viewer, o.right);
    o.half_height_A = half_extent(positions, o.centre, o.up);
    const double deep = n_views > 2 ? half_extent(positions, o.centre, o.toward_viewer) : 0;
    o.half_width_A = std::max(half_extent(positions, o.centre, o.right), deep);
  }
  const double half_height = std::max({kMargin * o.half_height_A, kMargin * o.half_width_A * aspect, 0.5});
  return {o.centre, o.toward_viewer, o.up, half_height / scene.zoom};
}

double height_that_fits(const CameraView& view, const std::vector<Vec3d>& positions, double aspect) {
  const Vec3d right = cross(view.up, view.toward_viewer);
  const double up = half_extent(positions, view.centre, view.up);
  return std::max({kMargin * up, kMargin * half_extent(positions, view.centre, right) * aspect, 0.5});
}

void place_camera(vtkRenderer* renderer, const CameraView& view, double angle) {
  const Vec3d right = cross(view.up, view.toward_viewer);
  const Vec3d toward = std::cos(angle) * view.toward_viewer + std::sin(angle) * right;
  double bounds[6];
  renderer->ComputeVisiblePropBounds(bounds);
  double radius = 10;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{bounds[corner & 1], bounds[2 + ((corner >> 1) & 1)], bounds[4 + (corner >> 2)]};
    if (bounds[0] <= bounds[1]) radius = std::max(radius, norm(p - view.centre));
  }
  const double distance = 3 * radius;
  const Vec3d eye = view.centre + distance * toward;
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(view.half_height_A);
  camera->SetFocalPoint(view.centre.x, view.centre.y, view.centre.z);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->SetViewUp(view.up.x, view.up.y, view.up.z);
  camera->SetClippingRange(distance - 1.05 * radius, distance + 1.05 * radius);
}

CameraView camera_of(vtkRenderer* renderer) {
  vtkCamera* camera = renderer->GetActiveCamera();
  double centre[3], toward[3], up[3];
  camera->GetFocalPoint(centre);
  camera->GetDirectionOfProjection(toward);
  camera->OrthogonalizeViewUp();
  camera->GetViewUp(up);
  return {{centre[0], centre[1], centre[2]},
          {-toward[0], -toward[1], -toward[2]},
          {up[0], up[1], up[2]},
          camera->GetParallelScale()};
}

void add_lights(vtkRenderer* renderer) {
  renderer->AutomaticLightCreationOff();
  add_light(renderer, -0.5, 0.7, 1.0, 0.75);
  add_light(renderer, 0.7, -0.3, 1.0, 0.35);
}

}  // namespace espdiff
