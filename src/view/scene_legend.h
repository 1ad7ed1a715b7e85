// scene_legend.h: the annotations around a scene's views: title, names of views, scales, keys.
#pragma once

#include "scene/scene.h"

class vtkRenderer;

namespace espdiff {

class ComparisonScene;

/// The heights between which the views lie, as fractions of the picture's height.
struct LegendShares {
  double bottom = 0, top = 1;
};

LegendShares legend_shares(const Scene& scene);

/// Adds title and names, colours in the middle, opacity and keys on the right.
/// @param scale_factor pixels of the window per pixel of the scene
void add_scene_legend(vtkRenderer* renderer, const ComparisonScene& scene, double scale_factor);

/// Adds the annotations that depend on the camera: length bar on the left, axes if the scene asks for them.
/// @param scale_factor as above
void add_scene_gauges(vtkRenderer* renderer, const ComparisonScene& scene, double scale_factor);

}  // namespace espdiff
