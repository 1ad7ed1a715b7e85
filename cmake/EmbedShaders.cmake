# EmbedShaders.cmake: writes GLSL files into one C++ source, each as a raw string under its name.
# Run at build time: cmake -DOUTPUT=shader_texts.cpp "-DSHADERS=a.vert;b.glsl" -P EmbedShaders.cmake
set(text "// Generated from shaders/ by cmake/EmbedShaders.cmake.\n#include \"view/shader_text.h\"\n\nnamespace espdiff {\n\n")
string(APPEND text "const std::map<std::string, std::string>& embedded_shaders() {\n")
string(APPEND text "  static const std::map<std::string, std::string> shaders = {\n")
foreach(path ${SHADERS})
  get_filename_component(name "${path}" NAME)
  file(READ "${path}" glsl)
  string(APPEND text "      {\"${name}\", R\"glsl(${glsl})glsl\"},\n")
endforeach()
string(APPEND text "  };\n  return shaders;\n}\n\n}  // namespace espdiff\n")
file(WRITE "${OUTPUT}" "${text}")
