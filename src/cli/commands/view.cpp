// view.cpp: `espdiff view OUT.vtp`: the window.
#include "base/error.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "io/files/atomic_file.h"
#if defined(ESPDIFF_HAVE_VTK)
#include <filesystem>

#include "cli/scene_options.h"
#include "io/files/check_outputs.h"
#include "scene/scene_keys.h"
#include "view/window/viewer.h"
#endif

namespace espdiff::cli {

#if defined(ESPDIFF_HAVE_VTK)
namespace {

struct ViewArguments {
  std::string input, prefix;
  bool overwrite = false;
  SceneArguments scene;
};

Scene window() {
  Scene scene;
  scene.width = 1280;
  scene.height = 860;
  return scene;
}

int view_verb(ViewArguments& a, const Context&) {
  const Scene scene = scene_of(a.scene, a.input, window());
  if (a.prefix.empty()) a.prefix = std::filesystem::path(a.input).stem().string() + "-view";
  check_outputs({a.input, a.scene.scene_file}, {a.scene.saved_scene}, a.overwrite);
  if (const auto saved = saved_scene_of(a.scene, scene)) saved->commit();
  run_viewer(a.input, scene, a.prefix);
  return 0;
}

std::string footer() {
  std::string text = "Keys:\n";
  for (const ViewerKey& key : viewer_keys()) {
    text += "  " + key.keys + std::string(key.keys.size() < 14 ? 14 - key.keys.size() : 1, ' ') + key.help + "\n";
  }
  text.pop_back();
  return text;
}

}  // namespace

Verb add_view(CLI::App& app) {
  auto a = std::make_shared<ViewArguments>();
  CLI::App* parser = app.add_subcommand("view", "Show a comparison in a window");
  parser->footer(footer());
  parser->add_option("SURFACE", a->input, "A result of compare: its prefix OUT, OUT.vtp or OUT.json")->required();
  parser->add_option("-o,--output", a->prefix,
                     "Pictures and scenes are saved as PREFIX.png and PREFIX.json [OUT-view]");
  parser->add_flag("--overwrite", a->overwrite, "Replace the file of --save-scene, if there is one");
  add_scene_options(*parser, a->scene, window());
  set_help(*parser, {"", {"espdiff view result.vtp --layout linked"}});
  return {parser, [a](const Context& context) {
            a->input = surface_of_result(a->input);
            return view_verb(*a, context);
          }};
}

#else

Verb add_view(CLI::App& app) {
  CLI::App* parser = app.add_subcommand("view", "Show a comparison in a window (not in this build)");
  parser->allow_extras();
  return {
      parser, [](const Context&) -> int {
        throw InputError("this build has no viewer: VTK 9 was not found when it was configured (Debian: libvtk9-dev)");
      }};
}

#endif

}  // namespace espdiff::cli
