// shader_text.h: the GLSL of shaders/, embedded by the build.
#pragma once

#include <map>
#include <string>

namespace espdiff {

/// File name in shaders/, such as "surface.frag" -> its text. Generated at build time.
const std::map<std::string, std::string>& embedded_shaders();

/// A shader in the form VTK's mappers need: lines `#include "name"` replaced by that file, preceded by VTK's first line
/// (GLSL version) and the definitions.
/// @param definitions name -> value
/// @throws Error (internal) if there is no such file
std::string shader_text(const std::string& name, const std::map<std::string, std::string>& definitions = {});

/// Compiles a shader alone, in the current OpenGL context. VTK's mappers crash on a shader that the driver refuses.
/// @param text from shader_text()
/// @returns the driver's first error; empty if there is none
std::string compile_problem(const std::string& text, bool is_vertex_shader);

}  // namespace espdiff
