// render.cpp: `espdiff render OUT`.
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "io/files/atomic_file.h"
#if defined(ESPDIFF_HAVE_VTK)
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "base/error.h"
#include "base/text/printable.h"
#include "cli/options.h"
#include "cli/scene_options.h"
#include "io/files/check_outputs.h"
#include "io/text/text_cursor.h"
#include "view/render_surface.h"
#endif

namespace espdiff::cli {

#if defined(ESPDIFF_HAVE_VTK)
namespace {

struct RenderArguments {
  std::string input, output;
  bool overwrite = false;
  SceneArguments scene;
};

/// A surface is pixels; what is named otherwise would not be what its name says.
void require_png(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (ending == ".png") return;
  throw InputError(path + ": surfaces are drawn as PNG; name it .png (larger: " + option("width", "3600") +
                   "), and take `espdiff plot` for lines and bars as .svg");
}

int render_verb(RenderArguments& a, const Context& context) {
  const bool is_named = !a.output.empty();
  if (!is_named) a.output = output_file(a.input, ".png");
  require_png(a.output);
  const Scene scene = scene_of(a.scene, a.input);
  check_outputs({a.input, a.scene.scene_file}, {a.output, a.scene.saved_scene}, a.overwrite);
  const std::unique_ptr<AtomicFile> saved = saved_scene_of(a.scene, scene);
  context.progress->report("render", 0.0);
  for (const std::string& note : render_surface(a.input, a.output, scene, saved.get())) {
    std::fprintf(stderr, "espdiff: note: %s\n", printable(note).c_str());
  }
  if (!is_named) std::cout << "written        " << printable(a.output) << '\n';
  return 0;
}

}  // namespace

Verb add_render(CLI::App& app) {
  auto a = std::make_shared<RenderArguments>();
  CLI::App* parser = app.add_subcommand("render", "Draw a comparison to a PNG");
  parser->footer("Needs an X display; without one: xvfb-run -a espdiff render ...");
  parser->add_option("SURFACE", a->input, "A result of compare: its prefix OUT, OUT.vtp or OUT.json")->required();
  parser->add_option("-o,--output", a->output, "Picture to write (.png); SURFACE.png in the working folder");
  add_overwrite(*parser, a->overwrite);
  add_scene_options(*parser, a->scene);
  set_help(*parser, {"",
                     {"espdiff render result.vtp -o result.png --title 'mutant - wild type'",
                      "espdiff render result.vtp -o linked.png --layout linked --molecule cartoon"}});
  return {parser, [a](const Context& context) {
            a->input = surface_of_result(a->input);
            return render_verb(*a, context);
          }};
}

#else

Verb add_render(CLI::App& app) {
  CLI::App* parser = app.add_subcommand("render", "Draw a result's surface into a PNG (not in this build)");
  parser->allow_extras();
  return {parser, [](const Context&) -> int {
            throw InputError(
                "this build has no renderer: VTK 9 was not found when it was configured (Debian: libvtk9-dev)");
          }};
}

#endif

}  // namespace espdiff::cli
