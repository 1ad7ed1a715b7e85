// orbit_style.cpp: moves the cameras of all views.
#include "view/window/orbit_style.h"

#include <vtkCamera.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <cstdlib>
#include <set>

namespace espdiff {
namespace {

/// A drag across the window's height rotates by 180 degrees.
constexpr double kDegreesPerHeight = 180;
/// Largest movement of a click, pixels.
constexpr int kClickSlack = 3;

/// Linked views share a camera, which must be moved only once.
std::set<vtkCamera*> cameras_of(const std::vector<vtkRenderer*>& renderers) {
  std::set<vtkCamera*> cameras;
  for (vtkRenderer* renderer : renderers) cameras.insert(renderer->GetActiveCamera());
  return cameras;
}

}  // namespace

vtkStandardNewMacro(OrbitStyle);

void OrbitStyle::start(Motion motion) {
  motion_ = motion;
  has_moved_ = false;
  this->Interactor->GetEventPosition(start_);
}

void OrbitStyle::OnLeftButtonDown() {
  start(this->Interactor->GetShiftKey() != 0 ? Motion::kShift : Motion::kTurn);
  if (calls_.grab(start_[0], start_[1])) {
    motion_ = Motion::kDrag;
    calls_.drag(start_[0], start_[1]);
  }
}

void OrbitStyle::OnLeftButtonUp() {
  const bool is_click = motion_ == Motion::kTurn && !has_moved_;
  motion_ = Motion::kNone;
  if (is_click) calls_.click(start_[0], start_[1]);
}

void OrbitStyle::OnMouseMove() {
  if (motion_ == Motion::kNone) return;
  const int* now = this->Interactor->GetEventPosition();
  const int* before = this->Interactor->GetLastEventPosition();
  if (std::abs(now[0] - start_[0]) + std::abs(now[1] - start_[1]) > kClickSlack) has_moved_ = true;
  if (motion_ == Motion::kDrag) {
    calls_.drag(now[0], now[1]);
    return;
  }
  if (!has_moved_) return;
  const int dx = now[0] - before[0], dy = now[1] - before[1];
  if (motion_ == Motion::kTurn) turn(dx, dy);
  if (motion_ == Motion::kShift) shift(dx, dy);
  if (motion_ == Motion::kZoom) zoom(1 + 0.005 * dy);
}

void OrbitStyle::turn(int dx, int dy) {
  const double degrees = kDegreesPerHeight / this->Interactor->GetRenderWindow()->GetSize()[1];
  for (vtkCamera* camera : cameras_of(calls_.renderers())) {
    camera->Azimuth(-degrees * dx);
    camera->Elevation(-degrees * dy);
    camera->OrthogonalizeViewUp();
  }
  draw();
}

void OrbitStyle::shift(int dx, int dy) {
  const std::vector<vtkRenderer*> renderers = calls_.renderers();
  const double pixels = renderers.front()->GetSize()[1];
  for (vtkCamera* camera : cameras_of(renderers)) {
    const double length = 2 * camera->GetParallelScale() / pixels;
    double toward[3], up[3], focus[3], eye[3];
    camera->GetDirectionOfProjection(toward);
    camera->GetViewUp(up);
    camera->GetFocalPoint(focus);
    camera->GetPosition(eye);
    const double right[3] = {toward[1] * up[2] - toward[2] * up[1], toward[2] * up[0] - toward[0] * up[2],
                             toward[0] * up[1] - toward[1] * up[0]};
    for (int i = 0; i < 3; ++i) {
      const double move = -length * (dx * right[i] + dy * up[i]);
      focus[i] += move;
      eye[i] += move;
    }
    camera->SetFocalPoint(focus);
    camera->SetPosition(eye);
  }
  draw();
}

void OrbitStyle::zoom(double factor) {
  for (vtkCamera* camera : cameras_of(calls_.renderers())) {
    camera->SetParallelScale(camera->GetParallelScale() / (factor > 0.1 ? factor : 0.1));
  }
  draw();
}

void OrbitStyle::draw() {
  for (vtkRenderer* renderer : calls_.renderers()) renderer->ResetCameraClippingRange();
  calls_.moved();
  this->Interactor->Render();
}

void OrbitStyle::OnKeyPress() { calls_.key(this->Interactor->GetKeySym()); }

}  // namespace espdiff
