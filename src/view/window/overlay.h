// overlay.h: text over the viewer's views: messages, help, and the slider of the morph.
#pragma once

#include <vtkNew.h>
#include <vtkRenderer.h>

#include <string>
#include <vector>

#include "scene/scene.h"

class vtkRenderWindow;

namespace espdiff {

class Overlay {
 public:
  explicit Overlay(bool has_slider) : has_slider_(has_slider) {}

  void add_to(vtkRenderWindow* window);
  /// Sets the lines in the upper left corner (none if empty), shown by the next draw().
  void say(const std::vector<std::string>& lines) { lines_ = lines; }
  void toggle_help() { shows_help_ = !shows_help_; }
  void draw(const Scene& scene);

  bool is_on_slider(const Scene& scene, int x, int y) const;
  /// The morph value of a slider position, 0 to 1.
  double slider_value(const Scene& scene, int x) const;

 private:
  void draw_slider(const Scene& scene);
  void draw_lines(const std::vector<std::string>& lines, double left, double top);

  bool has_slider_;
  bool shows_help_ = false;
  std::vector<std::string> lines_;
  vtkNew<vtkRenderer> renderer_;
};

}  // namespace espdiff
