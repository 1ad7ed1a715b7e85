// scene.cpp: scenes as JSON, and checks of their values.
#include "scene/scene.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/joined_words.h"
#include "io/files/read_input.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"

namespace espdiff {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int kMinSize = 400, kMaxSize = 6000;
constexpr std::array<const char*, 3> kLayouts = {"turned", "linked", "split"};
constexpr std::array<const char*, 4> kStyles = {"none", "cartoon", "sticks", "lines"};

template <typename Enum, std::size_t Count>
Enum parse_word(const std::array<const char*, Count>& words, const std::string& text, const char* what) {
  for (std::size_t i = 0; i < Count; ++i) {
    if (text == words[i]) return static_cast<Enum>(i);
  }
  throw InputError(std::string("no ") + what + " '" + text + "'; use " + joined_words({words.begin(), words.end()}));
}

// Writing and reading a member by its type; numbers, texts and lists are JSON's own.

template <typename T>
OrderedJson json_of(const T& value) {
  return value;
}
template <typename T>
void read(const OrderedJson& json, T& value) {
  if constexpr (std::is_same_v<T, int>)
    value = integer_of<int>(json);
  else
    json.get_to(value);
}

OrderedJson json_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
void read(const OrderedJson& json, Vec3d& v) { v = {json.at(0), json.at(1), json.at(2)}; }

OrderedJson json_of(const CameraView& camera) {
  return {{"centre_A", json_of(camera.centre)},
          {"toward_viewer", json_of(camera.toward_viewer)},
          {"up", json_of(camera.up)},
          {"half_height_A", camera.half_height_A}};
}
void read(const OrderedJson& json, CameraView& camera) {
  read(json.at("centre_A"), camera.centre);
  read(json.at("toward_viewer"), camera.toward_viewer);
  read(json.at("up"), camera.up);
  read(json.at("half_height_A"), camera.half_height_A);
}

template <typename T>
OrderedJson json_of(const std::optional<T>& value) {
  return value ? json_of(*value) : OrderedJson(nullptr);
}
template <typename T>
void read(const OrderedJson& json, std::optional<T>& value) {
  value.reset();
  if (!json.is_null()) read(json, value.emplace());
}

OrderedJson json_of(RenderArray array) { return to_string(array); }
void read(const OrderedJson& json, RenderArray& array) { array = parse_render_array(json); }
OrderedJson json_of(Layout layout) { return kLayouts[static_cast<std::size_t>(layout)]; }
void read(const OrderedJson& json, Layout& layout) { layout = parse_layout(json); }
OrderedJson json_of(MoleculeStyle style) { return kStyles[static_cast<std::size_t>(style)]; }
void read(const OrderedJson& json, MoleculeStyle& style) { style = parse_molecule_style(json); }

/// A limit, or both ends; the percentile has an entry of its own.
OrderedJson json_of(const ScaleRange& range) {
  if (range.given_ends) return {range.low, range.high};
  return range.limit;
}
void read(const OrderedJson& json, ScaleRange& range) {
  range.given_ends = json.is_array();
  if (!range.given_ends) {
    range.limit = json;
    return;
  }
  range.low = json.at(0);
  range.high = json.at(1);
}

/// One entry of a scene file.
struct Entry {
  const char* key;
  std::function<OrderedJson(const Scene&)> get;
  std::function<void(Scene&, const OrderedJson&)> set;
};

/// `at` finds the member in a scene.
template <typename At>
Entry entry(const char* key, At at) {
  return {key, [at](const Scene& s) { return json_of(at(s)); },
          [at](Scene& s, const OrderedJson& json) { read(json, at(s)); }};
}

/// A member by its path from the scene.
#define ESPDIFF_ENTRY_OF(key, path) \
  entry(                            \
      key, [](auto& s) -> auto& { return s.path; })

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      ESPDIFF_ENTRY_OF("colour_by", array),
      ESPDIFF_ENTRY_OF("field", field),
      ESPDIFF_ENTRY_OF("range", range),
      ESPDIFF_ENTRY_OF("percentile", range.percentile),
      ESPDIFF_ENTRY_OF("potential_range", potential_limit),
      ESPDIFF_ENTRY_OF("colours", colours),
      ESPDIFF_ENTRY_OF("unit", unit),
      ESPDIFF_ENTRY_OF("per_vertex", per_vertex),
      ESPDIFF_ENTRY_OF("fade", fade),
      ESPDIFF_ENTRY_OF("opaque_below_A", opacity.opaque_below_A),
      ESPDIFF_ENTRY_OF("faint_above_A", opacity.faint_above_A),
      ESPDIFF_ENTRY_OF("least_opacity", opacity.least),
      ESPDIFF_ENTRY_OF("opacity", opacity.greatest),
      ESPDIFF_ENTRY_OF("fade_to_grey", opacity.to_grey),
      ESPDIFF_ENTRY_OF("layout", layout),
      ESPDIFF_ENTRY_OF("width", width),
      ESPDIFF_ENTRY_OF("height", height),
      ESPDIFF_ENTRY_OF("views", n_views),
      ESPDIFF_ENTRY_OF("title", title),
      ESPDIFF_ENTRY_OF("legend", legend),
      ESPDIFF_ENTRY_OF("axes", axes),
      ESPDIFF_ENTRY_OF("morph", morph),
      ESPDIFF_ENTRY_OF("split", split),
      ESPDIFF_ENTRY_OF("camera", camera),
      ESPDIFF_ENTRY_OF("turn_deg", turn_deg),
      ESPDIFF_ENTRY_OF("tilt_deg", tilt_deg),
      ESPDIFF_ENTRY_OF("zoom", zoom),
      ESPDIFF_ENTRY_OF("surface", surface),
      ESPDIFF_ENTRY_OF("molecule", molecule),
      ESPDIFF_ENTRY_OF("around_A", around_A),
      ESPDIFF_ENTRY_OF("causes", causes),
      ESPDIFF_ENTRY_OF("focus", focus),
      ESPDIFF_ENTRY_OF("labels", n_labels),
      ESPDIFF_ENTRY_OF("isopotentials", isopotentials),
      ESPDIFF_ENTRY_OF("offsets_A", offsets_A),
      ESPDIFF_ENTRY_OF("field_lines", n_field_lines),
      ESPDIFF_ENTRY_OF("slice", slice),
  };
  return all;
}
#undef ESPDIFF_ENTRY_OF

/// Sets one entry of a scene. @returns false when there is none of this name
bool set(Scene& scene, const std::string& key, const OrderedJson& value) {
  for (const Entry& entry : entries()) {
    if (key != entry.key) continue;
    entry.set(scene, value);
    return true;
  }
  return false;
}

void require(bool fulfilled, const Message& message) {
  if (!fulfilled) throw InputError(message);
}

bool is_share(double value) { return value >= 0 && value <= 1; }

}  // namespace

Layout parse_layout(const std::string& text) { return parse_word<Layout>(kLayouts, text, "layout"); }

MoleculeStyle parse_molecule_style(const std::string& text) {
  return parse_word<MoleculeStyle>(kStyles, text, "molecule style");
}

std::string scene_json(const Scene& scene) {
  OrderedJson json;
  for (const Entry& entry : entries()) json[entry.key] = entry.get(scene);
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
    const OrderedJson json = OrderedJson::parse(in);
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
  for (const int size : {s.width, s.height}) {
    require(size >= kMinSize && size <= kMaxSize,
            "the image size " + std::to_string(s.width) + " x " + std::to_string(s.height) +
                " is out of range; each side must be " + std::to_string(kMinSize) + " to " + std::to_string(kMaxSize) +
                " pixels");
  }
  require(s.potential_limit >= 0 && std::isfinite(s.potential_limit),
          "the potentials' range " + formatted(s.potential_limit) + " is not a number from 0 on (0: automatic)");
  require(s.n_views >= 1 && s.n_views <= 4, std::to_string(s.n_views) + " views cannot be drawn; use 1 to 4");
  require(
      is_share(s.opacity.least) && s.opacity.opaque_below_A >= 0 && s.opacity.faint_above_A > s.opacity.opaque_below_A,
      "the opacity scale must rise from a displacement >= 0 to a larger one, with a least opacity of 0 to 1");
  require(s.opacity.greatest > 0 && s.opacity.greatest <= 1 && s.opacity.greatest >= s.opacity.least,
          "the surface's opacity must be above 0, at most 1, and no less than the least opacity");
  require(s.layout != Layout::kSplit || s.molecule == MoleculeStyle::kNone,
          "the layout split draws no molecules, whose halves would not match; use linked");
  require(s.layout == Layout::kTurned || s.causes.empty(), "causes are drawn in the layout turned");
  require(is_share(s.morph), "a morph goes from 0 (source) to 1 (target), not to " + formatted(s.morph));
  require(is_share(s.split), "a split lies at 0 (left) to 1 (right), not at " + formatted(s.split));
  require(s.zoom >= 0.1 && s.zoom <= 50, "a zoom of " + formatted(s.zoom) + " cannot be drawn; use 0.1 to 50");
  require(std::isfinite(s.turn_deg) && std::isfinite(s.tilt_deg), "turn and tilt must be numbers of degrees");
  require(s.n_labels >= 0 && s.n_labels <= 50, std::to_string(s.n_labels) + " labels cannot be read; use 0 to 50");
  require(s.around_A >= 0 && s.around_A <= 20, "atoms around the protein are shown within 0 to 20 Angstrom");
  require(s.n_field_lines >= 0 && s.n_field_lines <= 2000,
          std::to_string(s.n_field_lines) + " field lines cannot be drawn; use 0 to 2000");
  require(s.isopotentials.size() <= 8, "at most 8 isopotential surfaces can be distinguished");
  for (const double value : s.isopotentials) require(std::isfinite(value), "an isopotential is not a number");
  for (const double offset : s.offsets_A) {
    require(offset > 0 && offset <= 10, "offset surfaces lie 0 to 10 Angstrom outside, not " + formatted(offset));
  }
  require(s.offsets_A.size() <= 3, "at most 3 offset surfaces fit beside the surface");
  require(s.offsets_A.empty() || s.layout == Layout::kTurned, "offset surfaces need the layout turned");
  require(s.offsets_A.empty() || !s.per_vertex,
          "offset surfaces need the maps; leave " + option("per-vertex") + " out");
  require(s.offsets_A.empty() || s.field.empty(),
          "offset surfaces are of the potential; leave " + option("field") + " out");
  require(!s.slice || is_share(*s.slice), "a slice lies at 0 (front) to 1 (back)");
  if (s.camera) {
    require(s.camera->half_height_A > 0 && norm(cross(s.camera->up, s.camera->toward_viewer)) > 1e-6,
            "the scene's camera has no height, or looks along its own vertical");
  }
  diverging_map(s.colours);
}

}  // namespace espdiff
