// shader_text.h: the GLSL of shaders/, which the build put into the program.
#pragma once

#include <map>
#include <string>

namespace espdiff {

/// Name of the file in shaders/, such as "surface.frag" -> its text. Generated at build time.
const std::map<std::string, std::string>& embedded_shaders();

/// A shader as VTK's mappers take it: lines `#include "name"` replaced by that file, and VTK's own first line (GLSL
/// version) and the definitions above.
/// @param definitions name -> what it stands for
/// @throws Error (internal) when there is no such file
std::string shader_text(const std::string& name, const std::map<std::string, std::string>& definitions = {});

/// Compiles a shader alone, in the OpenGL context that is current. VTK's mappers crash on one that the driver refuses.
/// @param text as shader_text() gives it
/// @returns the driver's first complaint; empty when there is none
std::string compile_problem(const std::string& text, bool is_vertex_shader);

}  // namespace espdiff
