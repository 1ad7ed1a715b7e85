// scene.cpp: scenes as JSON, and what they may hold.
#include "view/scene.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/gzip_text.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMinSize = 400, kMaxSize = 6000;
constexpr std::array<const char*, 3> kLayouts = {"turned", "linked", "split"};
constexpr std::array<const char*, 4> kStyles = {"none", "cartoon", "sticks", "lines"};

template <typename Enum, std::size_t Count>
Enum parse_word(const std::array<const char*, Count>& words, const std::string& text, const char* what) {
  std::string allowed;
  for (std::size_t i = 0; i < Count; ++i) {
    if (text == words[i]) return static_cast<Enum>(i);
    allowed += std::string(i == 0 ? "" : i + 1 == Count ? " or " : ", ") + words[i];
  }
  throw InputError(std::string("no ") + what + " '" + text + "'; use " + allowed);
}

Json vector(Vec3d v) { return {v.x, v.y, v.z}; }

Vec3d vector_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

Json camera_json(const CameraView& camera) {
  return {{"centre_A", vector(camera.centre)},
          {"toward_viewer", vector(camera.toward_viewer)},
          {"up", vector(camera.up)},
          {"half_height_A", camera.half_height_A}};
}

CameraView camera_of(const Json& json) {
  return {vector_of(json.at("centre_A")), vector_of(json.at("toward_viewer")), vector_of(json.at("up")),
          json.at("half_height_A")};
}

Json range_json(const ScaleRange& range) {
  if (range.given_ends) return {range.low, range.high};
  return range.limit;
}

void read_range(const Json& json, ScaleRange& range) {
  range.given_ends = json.is_array();
  if (!range.given_ends) {
    range.limit = json;
    return;
  }
  range.low = json.at(0);
  range.high = json.at(1);
}

/// Sets one entry of a scene. @returns false when there is none of this name
bool set(Scene& s, const std::string& key, const Json& value) {
  if (key == "colour_by")
    s.array = parse_render_array(value);
  else if (key == "range")
    read_range(value, s.range);
  else if (key == "percentile")
    s.range.percentile = value;
  else if (key == "colours")
    s.colours = value;
  else if (key == "unit")
    s.unit = value;
  else if (key == "per_vertex")
    s.per_vertex = value;
  else if (key == "fade")
    s.fade = value;
  else if (key == "opaque_below_A")
    s.opacity.opaque_below_A = value;
  else if (key == "faint_above_A")
    s.opacity.faint_above_A = value;
  else if (key == "least_opacity")
    s.opacity.least = value;
  else if (key == "opacity")
    s.opacity.greatest = value;
  else if (key == "layout")
    s.layout = parse_layout(value);
  else if (key == "width")
    s.width = value;
  else if (key == "height")
    s.height = value;
  else if (key == "views")
    s.n_views = value;
  else if (key == "title")
    s.title = value;
  else if (key == "legend")
    s.legend = value;
  else if (key == "axes")
    s.axes = value;
  else if (key == "morph")
    s.morph = value;
  else if (key == "split")
    s.split = value;
  else if (key == "camera")
    s.camera = value.is_null() ? std::nullopt : std::optional<CameraView>(camera_of(value));
  else if (key == "turn_deg")
    s.turn_deg = value;
  else if (key == "tilt_deg")
    s.tilt_deg = value;
  else if (key == "zoom")
    s.zoom = value;
  else if (key == "surface")
    s.surface = value;
  else if (key == "molecule")
    s.molecule = parse_molecule_style(value);
  else if (key == "around_A")
    s.around_A = value;
  else if (key == "labels")
    s.n_labels = value;
  else if (key == "isopotentials")
    s.isopotentials = value.get<std::vector<double>>();
  else if (key == "offsets_A")
    s.offsets_A = value.get<std::vector<double>>();
  else if (key == "field_lines")
    s.n_field_lines = value;
  else if (key == "slice")
    s.slice = value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
  else
    return false;
  return true;
}

void require(bool fulfilled, const std::string& message) {
  if (!fulfilled) throw InputError(message);
}

bool is_share(double value) { return value >= 0 && value <= 1; }

}  // namespace

Layout parse_layout(const std::string& text) { return parse_word<Layout>(kLayouts, text, "layout"); }

MoleculeStyle parse_molecule_style(const std::string& text) {
  return parse_word<MoleculeStyle>(kStyles, text, "molecule style");
}

std::string scene_json(const Scene& s) {
  Json json;
  json["colour_by"] = to_string(s.array);
  json["range"] = range_json(s.range);
  json["percentile"] = s.range.percentile;
  json["colours"] = s.colours;
  json["unit"] = s.unit;
  json["per_vertex"] = s.per_vertex;
  json["fade"] = s.fade;
  json["opaque_below_A"] = s.opacity.opaque_below_A;
  json["faint_above_A"] = s.opacity.faint_above_A;
  json["least_opacity"] = s.opacity.least;
  json["opacity"] = s.opacity.greatest;
  json["layout"] = kLayouts[static_cast<std::size_t>(s.layout)];
  json["width"] = s.width;
  json["height"] = s.height;
  json["views"] = s.n_views;
  json["title"] = s.title;
  json["legend"] = s.legend;
  json["axes"] = s.axes;
  json["morph"] = s.morph;
  json["split"] = s.split;
  json["camera"] = s.camera ? camera_json(*s.camera) : Json(nullptr);
  json["turn_deg"] = s.turn_deg;
  json["tilt_deg"] = s.tilt_deg;
  json["zoom"] = s.zoom;
  json["surface"] = s.surface;
  json["molecule"] = kStyles[static_cast<std::size_t>(s.molecule)];
  json["around_A"] = s.around_A;
  json["labels"] = s.n_labels;
  json["isopotentials"] = s.isopotentials;
  json["offsets_A"] = s.offsets_A;
  json["field_lines"] = s.n_field_lines;
  json["slice"] = s.slice ? Json(*s.slice) : Json(nullptr);
  return json.dump(1, ' ', true);
}

Scene read_scene(const std::string& path, const Scene& defaults) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) require_regular_file(path);
  std::ifstream in(path);
  if (!in) throw IoError(path, "no such scene file; `espdiff render --save-scene FILE` writes one");
  Scene scene = defaults;
  std::string key;
  try {
    const Json json = Json::parse(in);
    if (!json.is_object()) throw FormatError(path, 0, "a scene is a JSON object");
    for (const auto& [name, value] : json.items()) {
      key = name;
      if (!set(scene, key, value)) {
        throw FormatError(path, 0, "no setting '" + key + "' in scenes; `--save-scene FILE` writes all there are");
      }
    }
  } catch (const nlohmann::json::parse_error& error) {
    throw FormatError(path, 0,
                      "no JSON at byte " + std::to_string(error.byte) + "; `--save-scene FILE` shows what a scene is");
  } catch (const nlohmann::json::exception&) {
    throw FormatError(path, 0, "the value of '" + key + "' is of the wrong kind; `--save-scene FILE` shows which");
  } catch (const InputError& error) {
    throw FormatError(path, 0, error.what());
  }
  return scene;
}

void check(const Scene& s) {
  for (const int size : {s.width, s.height}) {
    require(size >= kMinSize && size <= kMaxSize,
            "the image size " + std::to_string(s.width) + " x " + std::to_string(s.height) +
                " is out of range; each side must be " + std::to_string(kMinSize) + " to " + std::to_string(kMaxSize) +
                " pixels");
  }
  require(s.n_views >= 1 && s.n_views <= 4, std::to_string(s.n_views) + " views cannot be drawn; use 1 to 4");
  require(
      is_share(s.opacity.least) && s.opacity.opaque_below_A >= 0 && s.opacity.faint_above_A > s.opacity.opaque_below_A,
      "the opacity scale must rise from a displacement >= 0 to a larger one, with a least opacity of 0 to 1");
  require(s.opacity.greatest > 0 && s.opacity.greatest <= 1 && s.opacity.greatest >= s.opacity.least,
          "the surface's opacity must be above 0, at most 1, and no less than the least opacity");
  require(s.layout != Layout::kSplit || s.molecule == MoleculeStyle::kNone,
          "the layout split draws no molecules, whose halves would not match; use linked");
  require(is_share(s.morph), "a morph goes from 0 (source) to 1 (target), not to " + std::to_string(s.morph));
  require(is_share(s.split), "a split lies at 0 (left) to 1 (right), not at " + std::to_string(s.split));
  require(s.zoom >= 0.1 && s.zoom <= 50, "a zoom of " + std::to_string(s.zoom) + " cannot be drawn; use 0.1 to 50");
  require(std::isfinite(s.turn_deg) && std::isfinite(s.tilt_deg), "turn and tilt must be numbers of degrees");
  require(s.n_labels >= 0 && s.n_labels <= 50, std::to_string(s.n_labels) + " labels cannot be read; use 0 to 50");
  require(s.around_A >= 0 && s.around_A <= 20, "atoms around the protein are shown within 0 to 20 Angstrom");
  require(s.n_field_lines >= 0 && s.n_field_lines <= 2000,
          std::to_string(s.n_field_lines) + " field lines cannot be drawn; use 0 to 2000");
  require(s.isopotentials.size() <= 8, "at most 8 isopotential surfaces can be told apart");
  for (const double value : s.isopotentials) require(std::isfinite(value), "an isopotential is not a number");
  for (const double offset : s.offsets_A) {
    require(offset > 0 && offset <= 10, "offset surfaces lie 0 to 10 Angstrom outside, not " + std::to_string(offset));
  }
  require(s.offsets_A.size() <= 3, "at most 3 offset surfaces fit beside the surface");
  require(s.offsets_A.empty() || s.layout == Layout::kTurned, "offset surfaces need the layout turned");
  require(s.offsets_A.empty() || !s.per_vertex, "offset surfaces need the maps; leave --per-vertex out");
  require(!s.slice || is_share(*s.slice), "a slice lies at 0 (front) to 1 (back)");
  if (s.camera) {
    require(s.camera->half_height_A > 0 && norm(cross(s.camera->up, s.camera->toward_viewer)) > 1e-6,
            "the scene's camera has no height, or looks along its own vertical");
  }
  diverging_map(s.colours);
}

}  // namespace espdiff
