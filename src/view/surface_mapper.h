// surface_mapper.h: draws a mapped surface with the shaders of shaders/, both potentials looked up at every fragment.
#pragma once

#include <vtkOpenGLPolyDataMapper.h>

#include <memory>

#include "view/colour_scale.h"
#include "view/map_texture.h"

namespace espdiff {

/// Which triangles a mapper draws; the numbers are those of shaders/surface.frag.
enum class SurfacePart { kTrusted, kCorrupt, kWithoutCounterpart };

/// Names of the point arrays that the shaders take besides positions and normals.
inline constexpr const char* kSurfaceAttributes[] = {"startMC",         "startNormalMC", "sourceIndex", "targetIndex",
                                                     "vertexPotential", "displacement",  "residueIndex"};

/// How a surface is drawn; may change from picture to picture.
struct SurfaceLook {
  ColourScale scale{RenderArray::kPlain, {}, 0.0};
  OpacityScale opacity;
  bool fades = false;                             ///< opacity by displacement
  double morph = 1;                               ///< 0 on the source, 1 on the target
  double first_column = -1e9, last_column = 1e9;  ///< of the window that are drawn
  double hatch_pixels = 14;
  bool reads_back = false;  ///< draws the difference as 24 bits instead of a colour; for tests
};

/// The mapper; its input has the point arrays of kSurfaceAttributes (see surface_geometry.h).
class SurfaceMapper : public vtkOpenGLPolyDataMapper {
 public:
  static SurfaceMapper* New();
  vtkTypeMacro(SurfaceMapper, vtkOpenGLPolyDataMapper)  // NOLINT: ends in a declaration
      SurfaceMapper(const SurfaceMapper&) = delete;
  SurfaceMapper& operator=(const SurfaceMapper&) = delete;

  void set_look(const SurfaceLook& look) { look_ = look; }
  const SurfaceLook& look() const { return look_; }
  void set_part(SurfacePart part) { part_ = part; }
  /// Without maps (textures of nothing) values are interpolated between the vertices.
  void set_maps(std::shared_ptr<MapTexture> source, std::shared_ptr<MapTexture> target);

  void RenderPieceStart(vtkRenderer* renderer, vtkActor* actor) override;
  void RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

 protected:
  SurfaceMapper();
  ~SurfaceMapper() override = default;

  void GetShaderTemplate(std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer,
                         vtkActor* actor) override;
  void SetMapperShaderParameters(vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) override;

 private:
  void set_colour_uniforms(vtkShaderProgram* program);

  SurfaceLook look_;
  SurfacePart part_ = SurfacePart::kTrusted;
  std::shared_ptr<MapTexture> source_map_, target_map_;
};

}  // namespace espdiff
