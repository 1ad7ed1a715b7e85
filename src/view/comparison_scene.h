// comparison_scene.h: turns a comparison and a scene into the renderers of a window.
#pragma once

#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/comparison_files.h"
#include "scene/scene.h"
#include "view/drawings/residue_labels.h"
#include "view/panels.h"
#include "view/surface/surface_geometry.h"
#include "view/surface/surface_mapper.h"

class vtkActor;
class vtkProp;
class vtkRenderWindow;

namespace espdiff {

class ComparisonScene {
 public:
  /// `files` is kept by reference and must hold what the scene needs (see read_comparison()).
  /// @throws InputError if the scene cannot be drawn from these files
  ComparisonScene(const ComparisonFiles& files, Scene scene);

  /// Adds renderers to an empty window: one per panel, and one above them for text.
  /// @param scale_factor pixels of the window per pixel of the scene
  void add_to(vtkRenderWindow* window, double scale_factor);

  /// Shows another scene in the same window with the current camera. Changes that concern only the look of surfaces
  /// (colours, range, morph, split, opacity) upload nothing.
  /// @throws as the constructor; the previous scene then stays
  void change_to(const Scene& scene);
  /// The same with the automatic camera.
  void reset_camera();
  /// Updates what depends on the camera: length bar and axes.
  void camera_moved();

  /// Whether the surface is of an ensemble, and fades by p instead of slip.
  bool shows_significance() const { return !files_.surface.p_family_wise.empty(); }
  const SurfaceFile& surface_file() const { return files_.surface; }
  double alpha() const { return files_.surface.alpha; }
  const Scene& scene() const { return scene_; }
  const std::vector<Panel>& panels() const { return panels_; }
  /// The scale of an array; source and target share one.
  const ColourScale& scale(RenderArray array) const;
  const std::string& unit() const { return unit_; }
  const RunRecord& record() const { return files_.record; }
  /// Whether potentials are looked up at every pixel.
  bool per_fragment() const { return files_.maps.complete() && !scene_.per_vertex && scene_.field.empty(); }
  const SurfaceGeometry& geometry() const { return geometry_; }
  /// The causes that are drawn.
  const std::optional<ReadingCauses>& causes() const { return files_.causes; }
  /// The scale of the drawings of the maps themselves; nullptr if there are none.
  const ColourScale* map_scale() const { return map_scale_ ? &*map_scale_ : nullptr; }
  /// The renderer of the text, above all others.
  vtkRenderer* writing() { return writing_; }

 private:
  /// A part of a sheet in a panel.
  struct DrawnPart {
    std::size_t panel, sheet;
    SurfacePart part;
    const SurfaceGeometry* geometry;
    vtkSmartPointer<SurfaceMapper> mapper;
    vtkSmartPointer<vtkActor> actor;
  };

  /// A label in one view.
  struct PlacedLabel {
    ResidueMark mark;
    vtkSmartPointer<vtkRenderer> renderer;
    std::vector<vtkSmartPointer<vtkProp>> props;
    bool is_inside = false;  ///< of a residue inside the molecule, shown from all sides
  };

  void choose_scales(const Scene& scene);
  void lay_out();
  double view_aspect() const;
  void aim_camera();
  void share_camera();
  void fill_panels();
  void add_parts(std::size_t panel, std::size_t sheet);
  void update_looks();
  SurfaceLook look_of(const Panel& panel, const Sheet& sheet) const;
  void add_causes(const Panel& panel);
  void add_molecule(const Panel& panel);
  void add_labels(const Panel& panel);
  void add_map_drawings(const Panel& panel);
  void aim_at_focus(double aspect);
  /// [residue] those that the scene looks at.
  std::vector<bool> focused_side_chains(const Molecule& molecule, bool is_source) const;
  void place_labels();
  void make_offsets();
  void write_legend();

  const ComparisonFiles& files_;
  Scene scene_;
  std::string unit_;
  SurfaceGeometry geometry_;
  /// Surfaces of the scene's offsets_A, with their geometry.
  std::vector<std::pair<std::unique_ptr<SurfaceFile>, std::unique_ptr<SurfaceGeometry>>> offsets_;
  std::shared_ptr<MapTexture> source_texture_, target_texture_, no_texture_;
  std::vector<std::size_t> shown_;      ///< vertices of matched triangles
  std::vector<Vec3d> shown_positions_;  ///< of those
  std::vector<ColourScale> scales_;     ///< one per array shown
  std::optional<ColourScale> map_scale_;
  std::vector<Panel> panels_;
  std::vector<DrawnPart> parts_;
  std::vector<PlacedLabel> labels_;
  CameraView camera_;
  vtkRenderWindow* window_ = nullptr;
  double scale_factor_ = 1;
  vtkNew<vtkRenderer> paper_, writing_, gauges_;
};

}  // namespace espdiff
