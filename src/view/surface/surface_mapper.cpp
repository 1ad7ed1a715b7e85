// surface_mapper.cpp: passes our shaders, and the data they need, to VTK's mapper.
#include "view/surface/surface_mapper.h"

#include <vtkCamera.h>
#include <vtkDataObject.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLHelper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>

#include "base/error.h"
#include "scene/reasons.h"
#include "view/surface/shader_text.h"

namespace espdiff {
namespace {

/// Sets a uniform, which the compiler may have removed.
template <typename Set>
void if_used(vtkShaderProgram* program, const char* name, const Set& set) {
  if (program->IsUniformUsed(name)) set(name);
}

void set_colour(vtkShaderProgram* program, const char* name, Rgb colour) {
  const float rgb[3] = {static_cast<float>(colour.red) / 255, static_cast<float>(colour.green) / 255,
                        static_cast<float>(colour.blue) / 255};
  if_used(program, name, [&](const char* n) { program->SetUniform3f(n, rgb); });
}

void set_floats(vtkShaderProgram* program, const char* name, float a, float b) {
  const float values[2] = {a, b};
  if_used(program, name, [&](const char* n) { program->SetUniform2f(n, values); });
}

void set_float(vtkShaderProgram* program, const char* name, double value) {
  if_used(program, name, [&](const char* n) { program->SetUniformf(n, static_cast<float>(value)); });
}

void set_integer(vtkShaderProgram* program, const char* name, int value) {
  if_used(program, name, [&](const char* n) { program->SetUniformi(n, value); });
}

/// Table size: finer than eight bits. GPUs of the last fifteen years support 8192.
constexpr std::size_t kColours = 2048;

/// kReadBack of shaders/surface.frag.
constexpr int kReadBack = 10;

}  // namespace

vtkStandardNewMacro(SurfaceMapper);

SurfaceMapper::SurfaceMapper() {
  set_maps(std::make_shared<MapTexture>(nullptr), std::make_shared<MapTexture>(nullptr));
  set_look({});
  this->ScalarVisibilityOff();
  // The shaders mix two sets of positions, which must not be shifted separately.
  this->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
  for (const char* name : kSurfaceAttributes) {
    this->MapDataArrayToVertexAttribute(name, name, vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
  }
}

std::map<std::string, std::string> shader_definitions(const SurfaceLook& look, SurfacePart part, Lookup lookup,
                                                      bool parallel_projection) {
  const auto truth = [](bool value) { return std::string(value ? "true" : "false"); };
  return {{"COLOUR_BY", std::to_string(look.reads_back ? kReadBack : static_cast<int>(look.scale.array()))},
          {"CUTS", truth(look.cuts)},
          {"MARKS", truth(look.marks && !look.reads_back)},
          {"OUTLINES", truth(look.outlines)},
          {"PART", std::to_string(static_cast<int>(part))},
          {"PER_FRAGMENT", truth(lookup != Lookup::kPerVertex)},
          {"FILTERED_IN_FLOATS", truth(lookup == Lookup::kFiltered)},
          {"SOME_OUTSIDE", truth(!look.inside_maps)},
          {"FADES", truth(look.fades)},
          {"TO_GREY", truth(look.fades && look.opacity.to_grey)},
          {"SPLIT", truth(look.splits)},
          {"PARALLEL", truth(parallel_projection)}};
}

Lookup SurfaceMapper::lookup(vtkRenderer* renderer) const {
  if (source_map_->map() == nullptr || target_map_->map() == nullptr) return Lookup::kPerVertex;
  const std::string driver = renderer->GetRenderWindow()->ReportCapabilities();
  bool is_software = false;
  for (const char* name : {"llvmpipe", "softpipe", "SWR"}) is_software |= driver.find(name) != std::string::npos;
  return is_software && !look_.fetches ? Lookup::kFiltered : Lookup::kFetched;
}

void SurfaceMapper::set_look(const SurfaceLook& look) {
  look_ = look;
  colours_.set(look.scale.table(kColours));
  changed_ = true;
}

void SurfaceMapper::set_part(SurfacePart part) {
  part_ = part;
  changed_ = true;
}

bool SurfaceMapper::GetNeedToRebuildShaders(vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) {
  const bool needed = Superclass::GetNeedToRebuildShaders(cells, renderer, actor) || changed_;
  changed_ = false;
  return needed;
}

void SurfaceMapper::set_maps(std::shared_ptr<MapTexture> source, std::shared_ptr<MapTexture> target) {
  source_map_ = std::move(source);
  target_map_ = std::move(target);
  changed_ = true;
}

void SurfaceMapper::GetShaderTemplate(std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer, vtkActor*) {
  const bool parallel = renderer->GetActiveCamera()->GetParallelProjection() != 0;
  const auto definitions = shader_definitions(look_, part_, lookup(renderer), parallel);
  for (const bool is_vertex_shader : {true, false}) {
    const char* name = is_vertex_shader ? "surface.vert" : "surface.frag";
    const std::string text = shader_text(name, definitions);
    const std::string problem = compile_problem(text, is_vertex_shader);
    if (!problem.empty()) {
      throw DeviceError(std::string("this OpenGL driver does not take the shader ") + name + ": " + problem +
                        "; OpenGL 3.2 is needed, which `xvfb-run -a` provides");
    }
    shaders[is_vertex_shader ? vtkShader::Vertex : vtkShader::Fragment]->SetSource(text);
  }
  shaders[vtkShader::Geometry]->SetSource("");
}

void SurfaceMapper::RenderPieceStart(vtkRenderer* renderer, vtkActor* actor) {
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  source_map_->activate(window);
  target_map_->activate(window);
  colours_.activate(window);
  Superclass::RenderPieceStart(renderer, actor);
}

void SurfaceMapper::RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor) {
  Superclass::RenderPieceFinish(renderer, actor);
  colours_.deactivate();
  target_map_->deactivate();
  source_map_->deactivate();
}

void SurfaceMapper::ReleaseGraphicsResources(vtkWindow* window) {
  source_map_->release(window);
  target_map_->release(window);
  colours_.release(window);
  Superclass::ReleaseGraphicsResources(window);
}

void SurfaceMapper::SetMapperShaderParameters(vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) {
  Superclass::SetMapperShaderParameters(cells, renderer, actor);
  vtkShaderProgram* program = cells.Program;
  set_integer(program, "sourceMap", source_map_->unit());
  set_integer(program, "targetMap", target_map_->unit());
  set_float(program, "morph", look_.morph);
  set_float(program, "hatchPitch", look_.hatch_pixels);
  const OpacityScale& opacity = look_.opacity;
  const float fade[4] = {static_cast<float>(opacity.opaque_below_A), static_cast<float>(opacity.faint_above_A),
                         static_cast<float>(opacity.least), static_cast<float>(opacity.greatest)};
  if_used(program, "fade", [&](const char* name) { program->SetUniform4f(name, fade); });
  set_floats(program, "shownColumns", static_cast<float>(look_.first_column), static_cast<float>(look_.last_column));
  set_colour_uniforms(program);
}

void SurfaceMapper::set_colour_uniforms(vtkShaderProgram* program) {
  const ColourScale& scale = look_.scale;
  set_floats(program, "range", static_cast<float>(scale.low()), static_cast<float>(scale.high()));
  set_integer(program, "colours", colours_.unit());
  set_colour(program, "noValueColour", kNoValueColour);
  set_colour(program, "sameSignColour", kSameSignColour);
  set_colour(program, "signChangeColour", kSignChangeColour);
  set_colour(program, "plainColour", kPlainColour);
  for (std::size_t r = 0; r < kDrawnReasons.size(); ++r)
    set_colour(program, ("reasonColours[" + std::to_string(r) + "]").c_str(), kDrawnReasons[r].colour);
}

}  // namespace espdiff
