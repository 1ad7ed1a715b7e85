// surface_mapper.h: draws a mapped surface with the shaders of shaders/, looking up both potentials at every fragment.
#pragma once

#include <vtkOpenGLPolyDataMapper.h>

#include <map>
#include <memory>
#include <string>

#include "scene/colour_scale.h"
#include "view/surface/colour_texture.h"
#include "view/surface/map_texture.h"

namespace espdiff {

/// The triangles that a mapper draws; the numbers are those of shaders/surface.frag.
enum class SurfacePart { kMatched, kUnmatched };

/// Names of the point arrays that the shaders need besides positions and normals.
inline constexpr const char* kSurfaceAttributes[] = {"startMC",         "startNormalMC", "sourcePlace", "targetPlace",
                                                     "vertexPotential", "displacement",  "slip",        "uncertainty",
                                                     "residueIndex",    "borders",       "reasonsA",    "reasonsB"};

/// How a surface is drawn; may change between pictures.
struct SurfaceLook {
  ColourScale scale{RenderArray::kPlain, {}, 0.0};
  OpacityScale opacity;
  bool fades = false;        ///< opacity by uncertainty
  bool inside_maps = false;  ///< no fragment lies outside a map
  double morph = 1;          ///< 0 on the source, 1 on the target
  bool splits = false;       ///< draws only these columns of the window
  double first_column = 0, last_column = 0;
  double hatch_pixels = 14;
  bool cuts = false;        ///< along the smooth borders of unmatched parts
  bool marks = false;       ///< grey in the smooth borders of what is not trusted
  bool outlines = false;    ///< the residues that the geometry was given
  bool reads_back = false;  ///< draws the difference as 24 bits instead of a colour, for tests
  bool fetches = false;     ///< looks up as on GPUs, on any renderer, for tests
};

/// How potentials are looked up: kFiltered if the OpenGL driver interpolates in floats, as software does; otherwise
/// kFetched.
enum class Lookup { kPerVertex, kFiltered, kFetched };

/// The shader program's constants for a look.
std::map<std::string, std::string> shader_definitions(const SurfaceLook& look, SurfacePart part, Lookup lookup,
                                                      bool parallel_projection);

/// The mapper; its input has the point arrays of kSurfaceAttributes (see surface_geometry.h).
class SurfaceMapper : public vtkOpenGLPolyDataMapper {
 public:
  static SurfaceMapper* New();
  vtkTypeMacro(SurfaceMapper, vtkOpenGLPolyDataMapper)  // NOLINT: ends in a declaration
      SurfaceMapper(const SurfaceMapper&) = delete;
  SurfaceMapper& operator=(const SurfaceMapper&) = delete;

  void set_look(const SurfaceLook& look);
  const SurfaceLook& look() const { return look_; }
  void set_part(SurfacePart part);
  /// Without maps (empty textures), values are interpolated between the vertices.
  void set_maps(std::shared_ptr<MapTexture> source, std::shared_ptr<MapTexture> target);

  void RenderPieceStart(vtkRenderer* renderer, vtkActor* actor) override;
  void RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

 protected:
  SurfaceMapper();
  ~SurfaceMapper() override = default;

  void GetShaderTemplate(std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer,
                         vtkActor* actor) override;
  bool GetNeedToRebuildShaders(vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) override;
  void SetMapperShaderParameters(vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) override;

 private:
  Lookup lookup(vtkRenderer* renderer) const;
  void set_colour_uniforms(vtkShaderProgram* program);

  SurfaceLook look_;
  SurfacePart part_ = SurfacePart::kMatched;
  bool changed_ = true;  ///< the program's constants are out of date
  std::shared_ptr<MapTexture> source_map_, target_map_;
  ColourTexture colours_;
};

}  // namespace espdiff
