// scene_legend.h: what is written around the views of a scene: title, names of views, scales, keys.
#pragma once

#include "view/scene.h"

class vtkRenderer;

namespace espdiff {

class ComparisonScene;

/// Shares of the picture's height between which the views lie.
struct LegendShares {
  double bottom = 0, top = 1;
};

LegendShares legend_shares(const Scene& scene);

/// Title and names, colours in the middle, opacity and keys on the right.
/// @param scale_factor pixels of the window per pixel of the scene
void add_scene_legend(vtkRenderer* renderer, const ComparisonScene& scene, double scale_factor);

/// What depends on where the camera is: length bar on the left, axes where the scene asks for them.
/// @param scale_factor as above
void add_scene_gauges(vtkRenderer* renderer, const ComparisonScene& scene, double scale_factor);

}  // namespace espdiff
