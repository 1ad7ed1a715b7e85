// scene.cpp: the table of a scene's settings, scenes as JSON, and checks of their values.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "io/files/read_input.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

/// Headings of the options.
constexpr const char *kColours = "Colours", *kLayout = "Layout", *kContext = "Beside the surface";
constexpr NumberRange kAnyNumber{-HUGE_VAL};

using Json = nlohmann::ordered_json;
using Rows = RowsOf<Scene>;

/// One setting of a scene: an entry of scene files and, but for the camera, an option.
struct Entry {
  std::string key;  ///< in scene files
  Rows::Row option;
  std::function<Json(const Scene&)> write;
  std::function<void(Scene&, const Json&)> read;
};

/// An option's value, as JSON has it.
Json json_of(const OptionRow<Scene>& row, const Scene& scene) {
  const std::string text = row.get(scene);
  switch (row.kind) {
    case SettingKind::kBoolean: return text == "1";
    case SettingKind::kInteger: return std::stoi(text);
    case SettingKind::kNumber: {
      double value = 0;
      read_value(text, value);
      return value;
    }
    case SettingKind::kChoice:
    case SettingKind::kText: break;
  }
  return text;
}

std::string text_of(const OptionRow<Scene>& row, const Json& json) {
  switch (row.kind) {
    case SettingKind::kBoolean: return json.get<bool>() ? "1" : "0";
    case SettingKind::kInteger: return std::to_string(integer_of<int>(json));
    case SettingKind::kNumber: return written_value(json.get<double>());
    case SettingKind::kChoice:
    case SettingKind::kText: break;
  }
  return json.get<std::string>();
}

/// An entry whose key is the option's name unless `key` is given: "fade_to_grey" of "fade-to-grey".
Entry entry(OptionRow<Scene> row, std::string key = {}) {
  if (key.empty()) {
    key = row.name;
    std::replace(key.begin(), key.end(), '-', '_');
  }
  return {key, row, [row](const Scene& s) { return json_of(row, s); },
          [row](Scene& s, const Json& json) { row.set(s, text_of(row, json)); }};
}

/// Numbers between commas; an empty text is none. @throws InputError
std::vector<double> parse_numbers(const std::string& name, const NumberRange& range, std::size_t most,
                                  const std::string& accepted, const std::string& text) {
  std::vector<double> numbers;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    double value = 0;
    if (!read_value(part, value) || !is_within(range, value)) refuse_value(name, text, accepted);
    numbers.push_back(value);
  }
  if (numbers.size() > most || (!text.empty() && text.back() == ',')) refuse_value(name, text, accepted);
  return numbers;
}

template <typename At>
Entry numbers(const std::string& key, const std::string& name, const std::string& group, NumberRange range,
              std::size_t most, At at, const std::string& help) {
  const auto text_of_list = [](const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ",") + written_value(value);
    return text;
  };
  const std::string accepts = to_string(range, SettingKind::kNumber) + ", or up to " + std::to_string(most) +
                              " of these with commas between them";
  auto row = Rows::parsed(
      name, group, [=](Scene& s, const std::string& text) { at(s) = parse_numbers(name, range, most, accepts, text); },
      [=](const Scene& s) { return text_of_list(at(s)); }, help);
  row.accepts = accepts;
  return {key, row, [at](const Scene& s) { return Json(at(s)); },
          [=](Scene& s, const Json& json) { row.set(s, text_of_list(json.get<std::vector<double>>())); }};
}

/// "5" is symmetric, "-8:2" gives both ends. @throws InputError
void set_range(Scene& scene, const std::string& text) {
  const std::size_t colon = text.find(':');
  ScaleRange range = scene.range;
  range.given_ends = colon != std::string::npos;
  const bool are_numbers =
      range.given_ends ? read_value(text.substr(0, colon), range.low) && read_value(text.substr(colon + 1), range.high)
                       : read_value(text, range.limit);
  if (!are_numbers) refuse_value("range", text, "one number, such as 5 for -5 to 5, or two, such as -8:2");
  scene.range = range;
}

Entry range_entry() {
  const auto row = Rows::parsed(
      "range", kColours, set_range,
      [](const Scene& s) {
        return s.range.given_ends ? written_value(s.range.low) + ':' + written_value(s.range.high)
                                  : written_value(s.range.limit);
      },
      "End of the colour scale, for signed values both ends, or LOW:HIGH; 0: by the percentile");
  return {"range", row,
          [](const Scene& s) {
            return s.range.given_ends ? Json{s.range.low, s.range.high} : Json(s.range.limit);
          },
          [row](Scene& s, const Json& json) {
            row.set(s, json.is_array() ? written_value(json.at(0)) + ':' + written_value(json.at(1))
                                       : written_value(json.get<double>()));
          }};
}

Vec3d vector_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

/// The only entry that is no option.
Entry camera_entry() {
  return {"camera",
          {},
          [](const Scene& s) {
            if (!s.camera) return Json(nullptr);
            const auto of = [](const Vec3d& v) { return Json{v.x, v.y, v.z}; };
            return Json{{"centre_A", of(s.camera->centre)},
                        {"toward_viewer", of(s.camera->toward_viewer)},
                        {"up", of(s.camera->up)},
                        {"half_height_A", s.camera->half_height_A}};
          },
          [](Scene& s, const Json& json) {
            s.camera.reset();
            if (!json.is_null())
              s.camera = CameraView{vector_of(json.at("centre_A")), vector_of(json.at("toward_viewer")),
                                    vector_of(json.at("up")), json.at("half_height_A")};
          }};
}

Entry colour_entry() {
  std::vector<std::string> words = render_array_names();
  words.emplace_back("uncertainty");
  Entry made =
      entry(Rows::choice(
                "color", kColours, words, [](Scene& s, const std::string& text) { s.array = parse_render_array(text); },
                [](const Scene& s) { return to_string(s.array); }, "What to colour by"),
            "colour_by");
  made.option.other_name = "colour";
  return made;
}

/// `--opaque` of the entry `fade`.
Entry fade_entry() {
  const auto row = Rows::parsed(
      "opaque", kColours, [](Scene& s, const std::string& text) { s.fade = text != "1"; },
      [](const Scene& s) { return s.fade ? "0" : "1"; }, "Do not fade by slip");
  Entry made = entry(row, "fade");
  made.option.kind = SettingKind::kBoolean;
  made.write = [](const Scene& s) { return Json(s.fade); };
  made.read = [](Scene& s, const Json& json) { json.get_to(s.fade); };
  return made;
}

/// The option changes the view as well, which a scene file has by itself.
Entry focus_entry() {
  const auto row = Rows::parsed(
      "focus", kContext,
      [](Scene& s, const std::string& text) {
        s.focus = text;
        if (text.empty()) return;
        s.n_views = 1;
        s.opacity.greatest = std::min(s.opacity.greatest, 0.6);
      },
      [](const Scene& s) { return s.focus; },
      "Look at this part with its side chains, from one side: region, or the name of a fixed patch");
  Entry made = entry(row);
  made.read = [](Scene& s, const Json& json) { json.get_to(s.focus); };
  return made;
}

Entry slice_entry() {
  const auto row = Rows::optional_number(
      "slice", kContext, kShare, [](auto& s) -> auto& { return s.slice; },
      "Potential on a plane across the view: 0 in front, 1 behind");
  return {"slice", row, [](const Scene& s) { return s.slice ? Json(*s.slice) : Json(nullptr); },
          [row](Scene& s, const Json& json) {
            row.set(s, json.is_null() ? std::string() : written_value(json.get<double>()));
          }};
}

/// A member by its path from the scene.
#define ESPDIFF_AT(path) \
  [](auto& s) -> auto& { return s.path; }

void add_colours(std::vector<Entry>& all) {
  all.push_back(colour_entry());
  all.push_back(entry(Rows::text("field", kColours, ESPDIFF_AT(field),
                                 "A field that was compared, drawn in the place of the potential")));
  all.push_back(range_entry());
  all.push_back(entry(Rows::number("percentile", kColours, {50, 100}, ESPDIFF_AT(range.percentile),
                                   "Percentage of the values that an automatic scale covers")));
  all.push_back(entry(Rows::number("potential-range", kColours, kNotNegative, ESPDIFF_AT(potential_limit),
                                   "End of the scale of both potentials in the layout linked; 0: automatic")));
  all.push_back(entry(Rows::word("colours", kColours, {"red-blue", "cool-warm", "purple-orange"}, ESPDIFF_AT(colours),
                                 "Colour map of signed values")));
  all.back().option.other_name = "colors";
  all.push_back(
      entry(Rows::text("unit", kColours, ESPDIFF_AT(unit), "Unit in the legend, if the file does not give it")));
  all.push_back(entry(Rows::boolean("per-vertex", kColours, ESPDIFF_AT(per_vertex),
                                    "Interpolate vertex values instead of looking up the maps at every pixel")));
  all.push_back(fade_entry());
  all.push_back(entry(Rows::number("opaque-below", kColours, kNotNegative, ESPDIFF_AT(opacity.opaque_below_A),
                                   "Slip up to which the surface has its full colour, Angstrom"),
                      "opaque_below_A"));
  all.push_back(entry(Rows::number("faint-above", kColours, kNotNegative, ESPDIFF_AT(opacity.faint_above_A),
                                   "Slip from which it is palest, Angstrom"),
                      "faint_above_A"));
  all.push_back(entry(Rows::number("least-opacity", kColours, kShare, ESPDIFF_AT(opacity.least), "Opacity there")));
  all.push_back(entry(Rows::number("opacity", kColours, {0, 1, true}, ESPDIFF_AT(opacity.greatest),
                                   "Opacity of certain parts; below 1 a molecule inside is visible")));
  all.push_back(entry(Rows::boolean("fade-to-grey", kColours, ESPDIFF_AT(opacity.to_grey),
                                    "Fade to dark grey by slip, instead of becoming pale")));
}

void add_layout(std::vector<Entry>& all) {
  const NumberRange pixels{400, 6000};
  all.push_back(entry(Rows::choice_of<Layout>(
      "layout", kLayout, {{"turned", Layout::kTurned}, {"linked", Layout::kLinked}, {"split", Layout::kSplit}},
      ESPDIFF_AT(layout),
      "turned: from several sides; linked: source, target and difference; split: source | target")));
  all.push_back(entry(Rows::count("width", kLayout, pixels, ESPDIFF_AT(width), "Pixels")));
  all.push_back(entry(Rows::count("height", kLayout, pixels, ESPDIFF_AT(height), "Pixels")));
  all.push_back(
      entry(Rows::count("views", kLayout, {1, 4}, ESPDIFF_AT(n_views), "Number of views of the layout turned")));
  all.push_back(entry(Rows::text("title", kLayout, ESPDIFF_AT(title), "Title above the views")));
  all.push_back(entry(Rows::boolean("legend", kLayout, ESPDIFF_AT(legend), "Draw title, scales and keys")));
  all.push_back(
      entry(Rows::boolean("axes", kLayout, ESPDIFF_AT(axes), "Show the directions of the target's x, y and z")));
  all.push_back(entry(Rows::number("morph", kLayout, kShare, ESPDIFF_AT(morph),
                                   "Shape: 0 the source's, 1 the target's, or in between")));
  all.push_back(entry(Rows::number("split", kLayout, kShare, ESPDIFF_AT(split),
                                   "Position of the layout split's line, as a share of the width")));
  all.push_back(camera_entry());
  all.push_back(entry(Rows::number("turn", kLayout, kAnyNumber, ESPDIFF_AT(turn_deg),
                                   "Rotate the molecule to the right from the automatic view, degrees"),
                      "turn_deg"));
  all.push_back(entry(
      Rows::number("tilt", kLayout, kAnyNumber, ESPDIFF_AT(tilt_deg), "Tilt its upper side toward the viewer, degrees"),
      "tilt_deg"));
  all.push_back(
      entry(Rows::number("zoom", kLayout, {0.1, 50}, ESPDIFF_AT(zoom), "Magnification relative to the fitted size")));
}

void add_context(std::vector<Entry>& all) {
  all.push_back(entry(Rows::boolean("surface", kContext, ESPDIFF_AT(surface), "Draw the surface")));
  all.push_back(entry(Rows::choice_of<MoleculeStyle>("molecule", kContext,
                                                     {{"none", MoleculeStyle::kNone},
                                                      {"cartoon", MoleculeStyle::kCartoon},
                                                      {"sticks", MoleculeStyle::kSticks},
                                                      {"lines", MoleculeStyle::kLines}},
                                                     ESPDIFF_AT(molecule),
                                                     "Draw the molecule too; sticks are balls and sticks")));
  all.push_back(
      entry(Rows::number("around", kContext, {0, 20}, ESPDIFF_AT(around_A),
                         "Draw ligands, ions and water within this distance of the protein, Angstrom; 0 for none"),
            "around_A"));
  all.push_back(entry(Rows::text(
      "causes", kContext, ESPDIFF_AT(causes),
      "A reading whose causes the comparison has, such as region: colour the source's molecule by what its residues "
      "contribute, outline the reading's patch, and label the five largest")));
  all.push_back(focus_entry());
  all.push_back(entry(Rows::count("labels", kContext, {0, 50}, ESPDIFF_AT(n_labels),
                                  "Label this many residues with the largest mean difference")));
  all.push_back(numbers("isopotentials", "isopotential", kContext, kAnyNumber, 8, ESPDIFF_AT(isopotentials),
                        "Isosurfaces of the potential at these values, such as -2,2"));
  all.push_back(numbers("offsets_A", "offsets", kContext, {0, 10, true}, 3, ESPDIFF_AT(offsets_A),
                        "Also compare on surfaces this far outside, Angstrom, such as 1,2,4"));
  all.push_back(entry(Rows::count("field-lines", kContext, {0, 2000}, ESPDIFF_AT(n_field_lines),
                                  "Number of field lines, from the points of the surface with the strongest field")));
  all.push_back(slice_entry());
}
#undef ESPDIFF_AT

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = [] {
    std::vector<Entry> made;
    add_colours(made);
    add_layout(made);
    add_context(made);
    return made;
  }();
  return all;
}

/// Sets one entry of a scene. @returns false when there is none of this name
bool set(Scene& scene, const std::string& key, const Json& value) {
  for (const Entry& entry : entries()) {
    if (key != entry.key) continue;
    entry.read(scene, value);
    return true;
  }
  return false;
}

void require(bool fulfilled, const Message& message) {
  if (!fulfilled) throw InputError(message);
}

}  // namespace

const std::vector<Rows::Row>& scene_options() {
  static const std::vector<Rows::Row> all = [] {
    std::vector<Rows::Row> options;
    for (const Entry& entry : entries()) {
      if (!entry.option.name.empty()) options.push_back(entry.option);
    }
    return options;
  }();
  return all;
}

std::string scene_json(const Scene& scene) {
  Json json;
  for (const Entry& entry : entries()) json[entry.key] = entry.write(scene);
  return json.dump(1, ' ', true);
}

Scene read_scene(const std::string& path, const Scene& defaults) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) require_regular_file(path);
  require_memory_for_json(path);
  std::ifstream in(path);
  if (!in) throw IoError(path, "no such scene file; " + option("save-scene", "FILE") + " writes one");
  Scene scene = defaults;
  std::string key;
  try {
    const Json json = Json::parse(in);
    if (!json.is_object()) throw FormatError(path, 0, "a scene is a JSON object");
    for (const auto& [name, value] : json.items()) {
      key = name;
      if (!set(scene, key, value)) {
        throw FormatError(
            path, 0, "a scene has no setting '" + key + "'; " + option("save-scene", "FILE") + " writes all settings");
      }
    }
  } catch (const nlohmann::json::parse_error& error) {
    throw FormatError(path, 0,
                      "not JSON at byte " + std::to_string(error.byte) + "; " + option("save-scene", "FILE") +
                          " shows what a scene is");
  } catch (const nlohmann::json::exception&) {
    throw FormatError(
        path, 0,
        "the value of '" + key + "' has the wrong type; " + option("save-scene", "FILE") + " shows the right one");
  } catch (const std::out_of_range& error) {
    throw FormatError(path, 0, "the value of '" + key + "' is " + error.what());
  } catch (const InputError& error) {
    throw FormatError(path, 0, error.message());
  }
  return scene;
}

void check(const Scene& s) {
  for (const Rows::Row& option : scene_options()) {
    Scene scratch;
    option.set(scratch, option.get(s));
  }
  require(s.opacity.faint_above_A > s.opacity.opaque_below_A,
          option("faint-above", written_value(s.opacity.faint_above_A)) + " is not above " +
              option("opaque-below", written_value(s.opacity.opaque_below_A)) + ": the surface fades between the two");
  require(s.opacity.greatest >= s.opacity.least, option("opacity", written_value(s.opacity.greatest)) + " is below " +
                                                     option("least-opacity", written_value(s.opacity.least)));
  require(s.layout != Layout::kSplit || s.molecule == MoleculeStyle::kNone,
          "the layout split draws no molecules, whose halves would not match; use linked");
  require(s.layout == Layout::kTurned || s.causes.empty(), "causes are drawn in the layout turned");
  require(s.offsets_A.empty() || s.layout == Layout::kTurned, "offset surfaces need the layout turned");
  require(s.offsets_A.empty() || !s.per_vertex,
          "offset surfaces need the maps; leave " + option("per-vertex") + " out");
  require(s.offsets_A.empty() || s.field.empty(),
          "offset surfaces are of the potential; leave " + option("field") + " out");
  require(!s.camera || (s.camera->half_height_A > 0 && norm(cross(s.camera->up, s.camera->toward_viewer)) > 1e-6),
          "the scene's camera has no height, or looks along its own vertical");
}

}  // namespace espdiff
