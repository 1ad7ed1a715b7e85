// shader_text.cpp: assembles a shader from its files.
#include "view/surface/shader_text.h"

#include <vtkNew.h>
#include <vtkShader.h>

#include <sstream>

#include "base/error.h"

namespace espdiff {
namespace {

void append(std::string& text, const std::string& name) {
  const auto found = embedded_shaders().find(name);
  if (found == embedded_shaders().end()) throw Error(ErrorClass::kInternal, "no shader '" + name + "' in the program");
  const std::string directive = "#include \"";
  std::istringstream lines(found->second);
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, directive.size(), directive) == 0) {
      append(text, line.substr(directive.size(), line.rfind('"') - directive.size()));
    } else {
      text += line + '\n';
    }
  }
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

}  // namespace

std::string shader_text(const std::string& name, const std::map<std::string, std::string>& definitions) {
  std::string text = "//VTK::System::Dec\n";
  for (const auto& [word, meaning] : definitions) text += "#define " + word + " " + meaning + "\n";
  append(text, name);
  return text;
}

std::string compile_problem(const std::string& text, bool is_vertex_shader) {
  std::string alone = text;
  // The text that VTK inserts for opaque surfaces.
  replace_all(alone, "//VTK::System::Dec", "#version 150");
  replace_all(alone, "//VTK::Output::Dec", "out vec4 fragOutput0;");
  replace_all(alone, "gl_FragData[0]", "fragOutput0");
  vtkNew<vtkShader> shader;
  shader->SetType(is_vertex_shader ? vtkShader::Vertex : vtkShader::Fragment);
  shader->SetSource(alone);
  if (shader->Compile()) {
    shader->Cleanup();
    return {};
  }
  const std::string complaint = shader->GetError();
  return complaint.empty() ? "the driver does not say why" : complaint.substr(0, complaint.find('\n'));
}

}  // namespace espdiff
