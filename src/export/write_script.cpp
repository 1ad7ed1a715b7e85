// write_script.cpp: fills in the scripts of exports/.
#include "export/write_script.h"

#include <map>

#include "base/error.h"
#include "base/formatted.h"
#include "export/export_texts.h"

namespace espdiff {
namespace {

using ScriptJson = nlohmann::ordered_json;

/// A string of Python and of JSON. @throws InputError
std::string quoted(const std::string& text) {
  try {
    return ScriptJson(text).dump();
  } catch (const ScriptJson::exception&) {
    throw InputError(text + ": a script cannot name a file whose name is not UTF-8; choose another " +
                     option("output"));
  }
}

/// A word in quotes, as ChimeraX's commands read it. @throws InputError
std::string chimerax_word(const std::string& text) {
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || std::string("\"'\\;*?[]#").find(c) != std::string::npos)
      throw InputError(text +
                       ": a command of ChimeraX cannot name a file with quotes, brackets or one of \\ ; * ? #; "
                       "choose another " +
                       option("output"));
  }
  return '"' + text + '"';
}

/// A text that is shown: what ChimeraX's commands would read is left out.
std::string shown_text(std::string text) {
  for (char& c : text) c = std::string("\"'\\;#").find(c) != std::string::npos ? ' ' : c;
  return '"' + text + '"';
}

/// Colours at even steps of a scale.
std::vector<std::pair<double, Rgb>> steps_of(const ExportScale& scale, int n) {
  std::vector<std::pair<double, Rgb>> steps;
  for (int i = 0; i < n; ++i) {
    const double value = scale.low() + (scale.limit - scale.low()) * i / (n - 1);
    steps.emplace_back(value, scale.colour(value));
  }
  return steps;
}

/// "-5,#b40426:0,#dddddd:5,#3b4cc0" for ChimeraX.
std::string palette(const ExportScale& scale) {
  std::string text;
  for (const auto& [value, rgb] : steps_of(scale, 9))
    text += formatted("%s%g,#%02x%02x%02x", text.empty() ? "" : ":", value, rgb.red, rgb.green, rgb.blue);
  return text;
}

/// "#b40426:-5 #dddddd:0 #3b4cc0:5" for ChimeraX.
std::string key(const ExportScale& scale) {
  std::string text;
  for (const auto& [value, rgb] : steps_of(scale, 3))
    text += formatted("%s#%02x%02x%02x:%g", text.empty() ? "" : " ", rgb.red, rgb.green, rgb.blue, value);
  return text;
}

std::string scale_title(const ExportScale& scale) {
  return scale.label + (scale.unit.empty() ? "" : " [" + scale.unit + "]");
}

/// A scale as a dictionary of Python.
std::string python_scale(const ExportScale& scale) {
  ScriptJson values = ScriptJson::array(), colours = ScriptJson::array();
  for (const auto& [value, rgb] : steps_of(scale, 9)) {
    values.push_back(value);
    colours.push_back({rgb.red / 255.0, rgb.green / 255.0, rgb.blue / 255.0});
  }
  const ScriptJson json = {
      {"title", scale_title(scale)}, {"array", scale.name}, {"values", values}, {"colours", colours}};
  return json.dump(-1, ' ', false, ScriptJson::error_handler_t::replace);
}

std::map<std::string, std::string> placeholders(const std::string& script, const ExportedResult& result,
                                                const ScriptFiles& files) {
  std::string notes;
  for (const auto& [name, text] : result.notes) notes += (notes.empty() ? "# " : "\n# ") + name + ": " + text;
  if (script == "chimerax.cxc")
    return {{"NOTES", notes},
            {"MESH", chimerax_word(files.mesh)},
            {"STRUCTURE", chimerax_word(files.structure)},
            {"PALETTE", palette(result.residue_scale)},
            {"KEY", key(result.scale)},
            {"TITLE", shown_text(result.title)},
            {"SCALE", shown_text(scale_title(result.scale))}};
  return {{"NOTES", notes},
          {"MESH", quoted(files.mesh)},
          {"STRUCTURE", quoted(files.structure)},
          {"SCALE", python_scale(result.scale)},
          {"RESIDUES", python_scale(result.residue_scale)},
          {"READ_PLY", export_texts().at("read_ply.py")}};
}

}  // namespace

void write_script(std::ostream& out, const std::string& script, const ExportedResult& result,
                  const ScriptFiles& files) {
  const std::map<std::string, std::string> values = placeholders(script, result, files);
  const std::string& text = export_texts().at(script);
  std::size_t at = 0;
  for (std::size_t mark = text.find('@'); mark != std::string::npos; mark = text.find('@', at)) {
    const std::size_t end = text.find('@', mark + 1);
    out << text.substr(at, mark - at) << values.at(text.substr(mark + 1, end - mark - 1));
    at = end + 1;
  }
  out << text.substr(at);
}

}  // namespace espdiff
