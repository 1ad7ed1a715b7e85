// panels.h: the views of a scene's layout, and which surface each shows how.
#pragma once

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "view/scene.h"

namespace espdiff {

/// A surface as one view shows it.
struct Sheet {
  RenderArray array = RenderArray::kDifference;
  double morph = 1;
  bool fades = false;
  double offset_A = 0;      ///< how far outside of the surface it is taken
  double from = 0, to = 1;  ///< shares of the view's width
};

/// One view: a place in the window, and the sheets in it.
struct Panel {
  std::string name;
  double left = 0, bottom = 0, right = 1, top = 1;  ///< shares of the window
  double angle = 0;                                 ///< about the vertical, radians
  std::vector<Sheet> sheets;
  vtkSmartPointer<vtkRenderer> renderer;

  /// Whether it shows the source's shape, and hence what belongs to the source.
  bool is_source() const { return sheets.front().morph == 0; }
};

/// What the third of the linked views shows: the scene's array, or the difference where that is of one side.
RenderArray compared_array(RenderArray array);

/// @param fades whether the compared surface fades by displacement
std::vector<Panel> panels_of(const Scene& scene, bool fades);

/// Side by side between two heights, in shares of the window's.
void place(std::vector<Panel>& panels, double bottom, double top);

}  // namespace espdiff
