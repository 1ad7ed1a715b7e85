// scene_options.cpp: one row per option of a scene.
#include "cli/scene_options.h"

#include <algorithm>

#include "base/error.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "io/files/atomic_file.h"
#include "io/text/text_cursor.h"
#include "plot/shared_range.h"

namespace espdiff::cli {
namespace {

/// "5" is symmetric, "-8:2" gives both ends.
void set_range(Scene& scene, const std::string& text) {
  const std::size_t colon = text.find(':');
  scene.range.given_ends = colon != std::string::npos;
  const std::string_view words = text;
  const bool are_numbers = scene.range.given_ends ? parse_number(words.substr(0, colon), scene.range.low) &&
                                                        parse_number(words.substr(colon + 1), scene.range.high)
                                                  : parse_number(words, scene.range.limit);
  if (!are_numbers)
    throw InputError("--range " + text + ": give one number, such as 5 for -5 to 5, or two, such as -8:2");
}

/// Adds an option whose value changes the scene.
template <typename T>
CLI::Option* add(CLI::App& parser, SceneArguments& a, const std::string& names, const std::string& help,
                 const std::function<void(Scene&, const T&)>& change) {
  return parser.add_option_function<T>(
      names, [&a, change](const T& value) { a.changes.push_back([=](Scene& s) { change(s, value); }); }, help);
}

CLI::Option* add_flag(CLI::App& parser, SceneArguments& a, const std::string& name, const std::string& help,
                      const std::function<void(Scene&)>& change) {
  return parser.add_flag_callback(
      name, [&a, change] { a.changes.push_back(change); }, help);
}

using Text = std::string;
using Number = double;
using Numbers = std::vector<double>;

void add_colour_options(CLI::App& p, SceneArguments& a) {
  const Scene d;
  add<Text>(p, a, "--color,--colour", "What to colour by [difference]",
            [](Scene& s, const Text& t) { s.array = parse_render_array(t); })
      ->check(CLI::IsMember([] {
        auto names = render_array_names();
        names.emplace_back("uncertainty");
        return names;
      }()))
      ->type_name("WORD");
  add<Text>(p, a, "--field", "A field of --field of the comparison, drawn in the place of the potential [none]",
            [](Scene& s, const Text& t) { s.field = t; })
      ->type_name("NAME");
  add<Text>(p, a, "--range",
            "End of the colour scale, for signed values both ends, or LOW:HIGH; 0: by --percentile [0]", set_range)
      ->type_name("NUMBER");
  add_range_of(p, a.range_of);
  add<Number>(p, a, "--potential-range", "End of the scale of both potentials in the layout linked; 0: automatic [0]",
              [](Scene& s, Number v) { s.potential_limit = v; });
  add<Number>(p, a, "--percentile", "Percentage of the values that an automatic scale covers, 50 to 100 [90]",
              [](Scene& s, Number v) { s.range.percentile = v; });
  add<Text>(p, a, "--colours,--colors", "Colour map of signed values [red-blue]", [](Scene& s, const Text& t) {
    s.colours = t;
  })->check(CLI::IsMember({"red-blue", "cool-warm", "purple-orange"}));
  add<Text>(p, a, "--unit", "Unit in the legend, if the file does not give it",
            [](Scene& s, const Text& t) { s.unit = t; });
  add_flag(p, a, "--per-vertex", "Interpolate vertex values instead of looking up the maps at every pixel",
           [](Scene& s) { s.per_vertex = true; });
  add_flag(p, a, "--opaque", "Do not fade by slip", [](Scene& s) { s.fade = false; });
  add_flag(p, a, "--fade-to-grey", "Fade to dark grey by slip, instead of becoming pale",
           [](Scene& s) { s.opacity.to_grey = true; });
  add<Number>(p, a, "--opaque-below", "Slip up to which the surface has its full colour, Angstrom [0.5]",
              [](Scene& s, Number v) { s.opacity.opaque_below_A = v; });
  add<Number>(p, a, "--faint-above", "Slip from which it is palest, Angstrom [3]",
              [](Scene& s, Number v) { s.opacity.faint_above_A = v; });
  add<Number>(p, a, "--opacity", "Opacity of certain parts, 0 to 1; below 1 a molecule inside is visible [1]",
              [](Scene& s, Number v) { s.opacity.greatest = v; });
  add<Number>(p, a, "--least-opacity", "Opacity there, 0 to 1 [0.25]", [](Scene& s, Number v) { s.opacity.least = v; });
}

void add_context_options(CLI::App& p, SceneArguments& a) {
  add<Text>(p, a, "--molecule", "Draw the molecule too: none, cartoon, sticks (balls and sticks) or lines [none]",
            [](Scene& s, const Text& t) { s.molecule = parse_molecule_style(t); })
      ->check(CLI::IsMember({"none", "cartoon", "sticks", "lines"}));
  add<Number>(p, a, "--around", "Ligands, ions and water within this distance of the protein, Angstrom [none]",
              [](Scene& s, Number v) { s.around_A = v; });
  add<Text>(
      p, a, "--causes",
      "A reading of --causes of the comparison, such as region: colour the source's molecule by what its residues "
      "contribute, outline the reading's patch, and label the five largest [none]",
      [](Scene& s, const Text& t) { s.causes = t; })
      ->type_name("READING");
  add<Text>(p, a, "--focus",
            "Look at this part with its side chains, from one side: region, or the name of a fixed patch [none]",
            [](Scene& s, const Text& t) {
              s.focus = t;
              s.n_views = 1;
              s.opacity.greatest = std::min(s.opacity.greatest, 0.6);
            })
      ->type_name("REGION");
  add<int>(p, a, "--labels", "Label this many residues with the largest mean difference [0]",
           [](Scene& s, int v) { s.n_labels = v; });
  add<Numbers>(p, a, "--isopotential", "Isosurfaces of the potential at these values, such as -2,2",
               [](Scene& s, const Numbers& v) { s.isopotentials = v; })
      ->delimiter(',');
  add<int>(p, a, "--field-lines", "Number of field lines, from the points of the surface with the strongest field [0]",
           [](Scene& s, int v) { s.n_field_lines = v; });
  add<Number>(p, a, "--slice", "Potential on a plane across the view: 0 in front, 1 behind [none]",
              [](Scene& s, Number v) { s.slice = v; });
  add<Numbers>(p, a, "--offsets", "Also compare on surfaces this far outside, Angstrom, such as 1,2,4",
               [](Scene& s, const Numbers& v) { s.offsets_A = v; })
      ->delimiter(',');
  add_flag(p, a, "--no-surface", "Do not draw the surface", [](Scene& s) { s.surface = false; });
}

void add_layout_options(CLI::App& p, SceneArguments& a) {
  add<Text>(p, a, "--layout",
            "turned: from several sides; linked: source, target and difference; split: source | target [turned]",
            [](Scene& s, const Text& t) { s.layout = parse_layout(t); })
      ->check(CLI::IsMember({"turned", "linked", "split"}));
  add<int>(p, a, "--views", "Number of views of the layout turned, 1 to 4 [2]", [](Scene& s, int v) { s.n_views = v; });
  add<Number>(p, a, "--split", "Position of the layout split's line, 0 to 1 of the width [0.5]",
              [](Scene& s, Number v) { s.split = v; });
  add<Number>(p, a, "--morph", "Shape: 0 the source's, 1 the target's, or in between [1]",
              [](Scene& s, Number v) { s.morph = v; });
  add<Text>(p, a, "--title", "Title above the views", [](Scene& s, const Text& t) { s.title = t; });
  add_flag(p, a, "--no-legend", "Omit title, scales and keys", [](Scene& s) { s.legend = false; });
  add_flag(p, a, "--axes", "Show the directions of the target's x, y and z", [](Scene& s) { s.axes = true; });
  add<int>(p, a, "--width", "Pixels [1800; in a window 1280]", [](Scene& s, int v) { s.width = v; });
  add<int>(p, a, "--height", "Pixels [1100; in a window 860]", [](Scene& s, int v) { s.height = v; });
  add<Number>(p, a, "--turn", "Rotate the molecule to the right from the automatic view, degrees [0]",
              [](Scene& s, Number v) { s.turn_deg = v; });
  add<Number>(p, a, "--tilt", "Tilt its upper side toward the viewer, degrees [0]",
              [](Scene& s, Number v) { s.tilt_deg = v; });
  add<Number>(p, a, "--zoom", "Magnification relative to the fitted size [1]", [](Scene& s, Number v) { s.zoom = v; });
}

/// Sets the scene's ranges to the widest of all results, that of `surface` among them.
void share_ranges(Scene& scene, const std::string& surface, const std::vector<std::string>& others) {
  if (scene.range.given_ends || scene.range.limit > 0) throw InputError(kTwoRanges);
  if (!scene.field.empty()) throw InputError("--range-of is a scale of potentials; give --range with --field");
  std::vector<std::string> surfaces = {surface};
  for (const std::string& other : others) surfaces.push_back(surface_of_result(other));
  const std::map<std::string, double> limits = shared_limits(surfaces, scene.range.percentile);
  const auto limit_of = [&](RenderArray array) {
    const auto found = limits.find(array_name(array));
    return found == limits.end() ? 0.0 : found->second;
  };
  const double of_potentials = std::max(limit_of(RenderArray::kSource), limit_of(RenderArray::kTarget));
  const bool is_one_side = scene.array == RenderArray::kSource || scene.array == RenderArray::kTarget;
  const bool is_beside_them = scene.layout == Layout::kLinked && is_one_side;
  const RenderArray array = is_beside_them ? RenderArray::kDifference : scene.array;
  scene.range.limit = scene.layout == Layout::kSplit ? of_potentials : limit_of(array);
  if (scene.layout == Layout::kLinked && !(scene.potential_limit > 0)) scene.potential_limit = of_potentials;
}

}  // namespace

void add_scene_options(CLI::App& parser, SceneArguments& a) {
  add_colour_options(parser, a);
  add_layout_options(parser, a);
  add_context_options(parser, a);
  parser.add_option("--scene", a.scene_file, "Scene file (JSON) to start from; options change it");
  parser.add_option("--save-scene", a.saved_scene, "Write the scene to this file");
}

Scene scene_of(const SceneArguments& a, const std::string& surface, const Scene& defaults) {
  Scene scene = defaults;
  if (!a.scene_file.empty()) scene = read_scene(a.scene_file, scene);
  for (const auto& change : a.changes) change(scene);
  check(scene);
  if (!a.range_of.empty()) share_ranges(scene, surface, a.range_of);
  return scene;
}

std::unique_ptr<AtomicFile> saved_scene_of(const SceneArguments& a, const Scene& scene) {
  if (a.saved_scene.empty()) return nullptr;
  auto file = std::make_unique<AtomicFile>(a.saved_scene);
  file->stream() << scene_json(scene) << '\n';
  return file;
}

}  // namespace espdiff::cli
