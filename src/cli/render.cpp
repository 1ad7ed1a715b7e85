// render.cpp: `espdiff render OUT.vtp -o OUT.png`.
#include "cli/verbs.h"
#if defined(ESPDIFF_HAVE_VTK)
#include "view/render_surface.h"
#endif

namespace espdiff::cli {

#if defined(ESPDIFF_HAVE_VTK)
namespace {

struct Arguments {
  std::string input, output, colour_by = "difference";
  RenderOptions options;
};

int run(Arguments& a, const Context& context) {
  context.progress->report("render", 0.0);
  a.options.array = parse_render_array(a.colour_by);
  render_surface(a.input, a.output, a.options);
  return 0;
}

}  // namespace

Verb add_render(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* parser = app.add_subcommand("render", "Draw a result's surface into a PNG");
  parser->footer(
      "Needs an X display; without one: xvfb-run -a espdiff render ...\n\nExample:\n  espdiff render result.vtp -o "
      "result.png --title 'mutant - wild type'");
  RenderOptions& o = a->options;
  parser->add_option("SURFACE", a->input, "OUT.vtp of compare")->required();
  parser->add_option("-o,--output", a->output, "Picture to write (.png)")->required();
  parser->add_option("--color,--colour", a->colour_by, "What to colour by")
      ->check(CLI::IsMember({"difference", "source", "target", "sign", "displacement"}))
      ->capture_default_str();
  parser
      ->add_option("--range", o.limit, "End of the colour scale, for potentials both ends; 0 takes the 98th percentile")
      ->capture_default_str();
  parser->add_option("--title", o.title, "Title above the views");
  parser->add_option("--unit", o.unit, "Unit in the legend, if the file does not say");
  parser->add_option("--views", o.n_views, "Views side by side, each turned on about the vertical, 1 to 4")
      ->capture_default_str();
  parser->add_option("--width", o.width, "Pixels")->capture_default_str();
  parser->add_option("--height", o.height, "Pixels")->capture_default_str();
  parser
      ->add_option("--opaque-below", o.opacity.opaque_below_A,
                   "Displacement up to which the surface is opaque, Angstrom")
      ->capture_default_str();
  parser->add_option("--faint-above", o.opacity.faint_above_A, "Displacement from which it is faintest, Angstrom")
      ->capture_default_str();
  return {parser, [a](const Context& context) { return run(*a, context); }};
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
