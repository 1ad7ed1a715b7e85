// panels.h: the views of a scene's layout, and the surfaces in each.
#pragma once

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "scene/scene.h"

namespace espdiff {

/// A surface as shown in one view.
struct Sheet {
  RenderArray array = RenderArray::kDifference;
  double morph = 1;
  bool fades = false;
  double offset_A = 0;      ///< distance outside the molecular surface
  double from = 0, to = 1;  ///< fractions of the view's width
};

/// One view: its position in the window, and its sheets.
struct Panel {
  std::string name;
  double left = 0, bottom = 0, right = 1, top = 1;  ///< fractions of the window
  double angle = 0;                                 ///< about the vertical, radians
  std::vector<Sheet> sheets;
  vtkSmartPointer<vtkRenderer> renderer;

  /// Whether it shows the source's shape, and hence the source's molecule.
  bool is_source() const { return sheets.front().morph == 0; }
};

/// The array of the third linked view: the scene's, or the difference if that belongs to one side.
RenderArray compared_array(RenderArray array);

/// @param fades whether the compared surface fades by displacement
std::vector<Panel> panels_of(const Scene& scene, bool fades);

/// Places the panels side by side between two heights, as fractions of the window's.
void place(std::vector<Panel>& panels, double bottom, double top);

}  // namespace espdiff
