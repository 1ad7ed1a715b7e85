// scene_options.cpp: the table of a scene's settings as options.
#include "cli/scene_options.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "io/files/atomic_file.h"
#include "plot/shared_range.h"

namespace espdiff::cli {
namespace {

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

void add_scene_options(CLI::App& parser, SceneArguments& a, const Scene& defaults) {
  for (const OptionRow<Scene>& option : scene_options()) {
    add_row(parser, words_of(option), option, defaults, [&a, &option](const std::string& text) {
      a.changes.push_back([&option, text](Scene& scene) { option.set(scene, text); });
    });
    if (option.name == "range") add_range_of(parser, a.range_of)->group(option.group);
  }
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
