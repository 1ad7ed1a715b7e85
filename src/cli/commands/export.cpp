// export.cpp: `espdiff export OUT --to FORMAT`.
#include <iostream>
#include <memory>

#include "base/text/printable.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "export/export_result.h"

namespace espdiff::cli {
namespace {

struct ExportArguments {
  std::string input, format, output;
  std::vector<std::string> range_of;
  ExportOptions options;
};

int export_verb(const ExportArguments& a, const Context& context) {
  context.progress->report("export", 0.0);
  ExportOptions options = a.options;
  for (const std::string& other : a.range_of) options.range_of.push_back(result_prefix(other));
  for (const std::string& path : export_result(result_prefix(a.input), export_format(a.format), a.output, options))
    std::cout << "wrote " << printable(path) << '\n';
  return 0;
}

std::string formats_help() {
  std::string text = "Formats:";
  for (const ExportFormat& format : export_formats())
    text +=
        "\n  " + format.name + std::string(10 - format.name.size(), ' ') + format.help + " (OUT" + format.ending + ")";
  return text;
}

/// Of the colours.
const std::vector<OptionRow<ExportOptions>>& scale_settings() {
  using Rows = RowsOf<ExportOptions>;
  const std::string group = "Colours";
  static const std::vector<Rows::Row> all = [&] {
    std::vector<Rows::Row> rows{
        Rows::number(
            "range", group, kNotNegative, [](auto& o) -> auto& { return o.limit; },
            "End of the surface's colour scale, for signed values both ends; 0: covers 90 % of the values"),
        Rows::word(
            "colours", group, {"red-blue", "cool-warm", "purple-orange"}, [](auto& o) -> auto& { return o.colours; },
            "Colour map of signed values")};
    rows.back().other_name = "colors";
    return rows;
  }();
  return all;
}

}  // namespace

Verb add_export(CLI::App& app) {
  auto a = std::make_shared<ExportArguments>();
  CLI::App* parser = app.add_subcommand("export", "Write a comparison as files of other programs");
  parser->footer(formats_help());
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) names.push_back(format.name);
  parser->add_option("OUT", a->input, "A result of compare: its prefix, OUT.json or OUT.vtp")->required();
  parser->add_option("--to", a->format, "Format")->required()->check(CLI::IsMember(names))->type_name("FORMAT");
  parser->add_option("-o,--output", a->output, "File to write; default: OUT with the format's ending")
      ->type_name("FILE");
  a->options.overwrite = false;
  add_overwrite(*parser, a->options.overwrite);
  parser->add_option("--array", a->options.array,
                     "Point array of OUT.vtp to colour the surface by [potential_difference, or displacement]");
  parser->add_option("--residues", a->options.residues,
                     "Column of OUT.residues.csv for the residues [mean_abs_difference, or mean_displacement]");
  add_rows(*parser, scale_settings(), a->options);
  add_range_of(*parser, a->range_of);
  parser->add_option("--title", a->options.title, "Title; default: the names of both structures");
  set_help(*parser, {"",
                     {"espdiff export ldh --to glb -o ldh.glb", "espdiff export ldh --to pymol && pymol ldh.pymol.py",
                      "espdiff export ldh --to cif --residues mean_signed_difference"}});
  return {parser, [a](const Context& context) { return export_verb(*a, context); }};
}

}  // namespace espdiff::cli
