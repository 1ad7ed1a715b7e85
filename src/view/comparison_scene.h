// comparison_scene.h: turns a comparison and a scene into renderers of a window.
#pragma once

#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/comparison_files.h"
#include "view/scene.h"
#include "view/surface_geometry.h"
#include "view/surface_mapper.h"

class vtkRenderWindow;

namespace espdiff {

/// A surface as one view shows it.
struct Sheet {
  RenderArray array = RenderArray::kDifference;
  double morph = 1;
  bool fades = false;
  double offset_A = 0;  ///< how far outside of the surface it is taken
  double from = 0, to = 1;  ///< shares of the view's width
};

/// One view: a place in the window, and the sheets in it.
struct Panel {
  std::string name;
  double left = 0, bottom = 0, right = 1, top = 1;  ///< shares of the window
  double angle = 0;                                 ///< about the vertical, radians
  std::vector<Sheet> sheets;
  vtkSmartPointer<vtkRenderer> renderer;
};

class ComparisonScene {
 public:
  /// `files` is kept by reference.
  /// @throws InputError when the scene cannot be drawn of these files
  ComparisonScene(const ComparisonFiles& files, Scene scene);

  /// Adds renderers to a window without any: one a panel, and one above them for what is written.
  /// @param scale_factor pixels of the window per pixel of the scene
  void add_to(vtkRenderWindow* window, double scale_factor);

  /// Shows another scene in the same window; cheap unless the layout changes. The camera stays.
  void change_to(const Scene& scene);

  const Scene& scene() const { return scene_; }
  const std::vector<Panel>& panels() const { return panels_; }
  /// What a scale of this array looks like here; source and target share one.
  const ColourScale& scale(RenderArray array) const;
  const std::string& unit() const { return unit_; }
  /// Whether potentials are looked up at every pixel.
  bool per_fragment() const { return files_.maps.complete() && !scene_.per_vertex; }
  const SurfaceGeometry& geometry() const { return geometry_; }
  /// Of what is drawn of the maps themselves; nullptr when nothing is.
  const ColourScale* map_scale() const { return map_scale_ ? &*map_scale_ : nullptr; }
  /// Vertices that take part in a triangle with counterpart.
  const std::vector<Vec3d>& shown_positions() const { return shown_positions_; }

 private:
  void choose_scales();
  void lay_out();
  void fill(Panel& panel);
  void add_molecule(const Panel& panel);
  void add_labels(const Panel& panel);
  void add_map_drawings(const Panel& panel);
  void make_offsets();
  void add_sheet(const Panel& panel, const Sheet& sheet);
  void write_legend();

  const ComparisonFiles& files_;
  Scene scene_;
  std::string unit_;
  SurfaceGeometry geometry_;
  std::shared_ptr<MapTexture> source_texture_, target_texture_;
  std::vector<Vec3d> shown_positions_;
  std::vector<float> shown_values_;
  std::vector<ColourScale> scales_;  ///< one for each array that is shown
  std::optional<ColourScale> map_scale_;
  std::vector<Vec3f> shown_normals_;
  /// Surfaces of the scene's offsets_A, with their geometry.
  std::vector<std::pair<std::unique_ptr<SurfaceFile>, std::unique_ptr<SurfaceGeometry>>> offsets_;
  CameraView camera_;
  std::vector<Panel> panels_;
  vtkRenderWindow* window_ = nullptr;
  double scale_factor_ = 1;
  vtkNew<vtkRenderer> paper_, writing_;
};

}  // namespace espdiff
