// orbit_style.h: mouse control of the viewer: rotate, pan, zoom, click, and drag.
#pragma once

#include <vtkInteractorStyle.h>

#include <functional>
#include <string>
#include <vector>

class vtkRenderer;

namespace espdiff {

/// Left button: rotate, or click if the mouse does not move. Middle button, or Shift and left: pan. Right button or
/// wheel: zoom. All renderers rotate together.
class OrbitStyle : public vtkInteractorStyle {
 public:
  static OrbitStyle* New();
  vtkTypeMacro(OrbitStyle, vtkInteractorStyle)  // NOLINT: ends in a declaration
      OrbitStyle(const OrbitStyle&) = delete;
  OrbitStyle& operator=(const OrbitStyle&) = delete;

  /// Called with window pixels from the lower left corner.
  struct Calls {
    std::function<std::vector<vtkRenderer*>()> renderers;
    std::function<void()> moved;         ///< after the cameras have
    std::function<bool(int, int)> grab;  ///< whether the object there takes the drag
    std::function<void(int, int)> drag;
    std::function<void(int, int)> click;
    std::function<void(const std::string&)> key;  ///< X's name of the key, such as "bracketleft"
  };
  void set_calls(Calls calls) { calls_ = std::move(calls); }

  void OnMouseMove() override;
  void OnLeftButtonDown() override;
  void OnLeftButtonUp() override;
  void OnMiddleButtonDown() override { start(Motion::kShift); }
  void OnMiddleButtonUp() override { motion_ = Motion::kNone; }
  void OnRightButtonDown() override { start(Motion::kZoom); }
  void OnRightButtonUp() override { motion_ = Motion::kNone; }
  void OnMouseWheelForward() override { zoom(1.1); }
  void OnMouseWheelBackward() override { zoom(1 / 1.1); }
  void OnKeyPress() override;
  /// Disables VTK's own keys.
  void OnChar() override {}

 protected:
  OrbitStyle() = default;
  ~OrbitStyle() override = default;

 private:
  enum class Motion { kNone, kTurn, kShift, kZoom, kDrag };

  void start(Motion motion);
  void turn(int dx, int dy);
  void shift(int dx, int dy);
  void zoom(double factor);
  void draw();

  Calls calls_;
  Motion motion_ = Motion::kNone;
  bool has_moved_ = false;
  int start_[2] = {0, 0};
};

}  // namespace espdiff
