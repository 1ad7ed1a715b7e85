// options.cpp: options that several commands share.
#include "cli/options.h"
#include "engine/engine.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "cli/words/spelling.h"
#include "io/grids/read_grid.h"
#include "options/input_settings.h"
#include "options/options.h"

namespace espdiff::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// The message without "--NAME: " at its beginning, which CLI11 puts there.
std::string without_name(const InputError& error, const std::string& name) {
  const std::string message = spelled(error.message()), before = "--" + name + ": ";
  return message.rfind(before, 0) == 0 ? message.substr(before.size()) : message;
}

}  // namespace

void add_structure_options(CLI::App& parser, StructureOptions& options) {
  using Rows = RowsOf<StructureOptions>;
  static const std::vector<Rows::Row> all{
      Rows::boolean(
          "hetero", kStructureGroup, [](auto& o) -> auto& { return o.include_hetero; },
          "Read HETATM records (ligands, ions)"),
      Rows::boolean(
          "water", kStructureGroup, [](auto& o) -> auto& { return o.include_water; }, "Keep water molecules")};
  add_rows(parser, all, options);
}

void add_model_option(CLI::App& parser, StructureOptions& options) {
  using Rows = RowsOf<StructureOptions>;
  static const std::vector<Rows::Row> all{Rows::count(
      "model", kStructureGroup, {1}, [](auto& o) -> auto& { return o.model; }, "Model of a file with several")};
  add_rows(parser, all, options);
}

namespace {

/// Refuses an old name with the new one. Help does not list it.
void refuse_earlier_names(CLI::App& parser) {
  for (const RenamedSetting& renamed : renamed_settings()) {
    const std::string message = "--" + renamed.old_name + " is now called --" + renamed.name;
    parser
        .add_option_function<std::string>(
            "--" + renamed.old_name, [message](const std::string&) { throw CLI::ValidationError(message); }, "")
        ->group("");
  }
}

bool has_setting(const Setting& setting, SettingsFor what) {
  const bool of_side = setting.name.rfind("source-", 0) == 0 || setting.name.rfind("target-", 0) == 0;
  switch (what) {
    case SettingsFor::kPair: return true;
    case SettingsFor::kVariants: return !of_side && setting.name != "patches-of" && setting.name != "interface";
    case SettingsFor::kComplexes: return setting.group != "Fields";
    case SettingsFor::kSurface: return setting.of_surface;
    case SettingsFor::kMap: return is_of_preparation(setting) || setting.name == "temperature";
    case SettingsFor::kPreparation: break;
  }
  return is_of_preparation(setting);
}

}  // namespace

std::string type_of(SettingKind kind, const std::vector<std::string>& choices, bool is_file) {
  if (kind == SettingKind::kChoice) return joined(choices, "|");
  return is_file ? "FILE" : kind == SettingKind::kText ? "TEXT" : "NUMBER";
}

std::string refusal(const std::function<void()>& set, const std::string& name) {
  try {
    set();
  } catch (const InputError& error) {
    return without_name(error, name);
  }
  return {};
}

std::string negated(std::string help) {
  help[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(help[0])));
  return "Do not " + help;
}

void add_settings(CLI::App& parser, GivenSettings& given, SettingsFor what) {
  const bool is_comparison =
      what == SettingsFor::kPair || what == SettingsFor::kVariants || what == SettingsFor::kComplexes;
  if (is_comparison) refuse_earlier_names(parser);
  const CompareOptions defaults;
  for (const Setting& setting : settings()) {
    if (!has_setting(setting, what)) continue;
    const std::string name = setting.name;
    CLI::Option* const added = add_row<CompareOptions>(
        parser, "--" + name, setting, defaults,
        [&given, name](const std::string& text) { given.emplace_back(name, text); }, setting.is_list);
    if (setting.is_named) added->type_name("NAME=SELECTION");
  }
}

void add_potential_settings(CLI::App& parser, GivenPotentialSettings& given, bool of_maps) {
  const PotentialOptions defaults = make_potential_options(PotentialMethod::kPme, {}, PmeOptions().temperature_K);
  for (const PotentialSetting& setting : potential_settings()) {
    const bool is_pb = setting.of.front() == PotentialMethod::kPoissonBoltzmann;
    const std::string words = of_maps && setting.key == "spline"
                                  ? "--spline,--order"
                                  : "--" + (of_maps ? setting.map_option() : setting.name);
    const std::string name = setting.name;
    add_row<PotentialOptions>(parser, words, setting, defaults,
                              [&given, name](const std::string& text) { given.emplace_back(name, text); })
        ->group(is_pb                                         ? "Poisson-Boltzmann (pb)"
                : setting.of.front() == PotentialMethod::kPme ? "Particle-mesh Ewald (pme)"
                                                              : "Coulomb's law (coulomb)");
  }
}

void add_overwrite(CLI::App& parser, bool& overwrite) {
  parser.add_flag("--overwrite", overwrite, "Replace files of these names, if there are any");
}

CLI::Option* add_range_of(CLI::App& parser, std::vector<std::string>& others) {
  return parser
      .add_option("--range-of", others,
                  "One scale for a study: the widest automatic range of this result and of these, each by its prefix "
                  "or one of its files")
      ->delimiter(',')
      ->type_name("RESULT,...");
}

GridFile read_map(const std::string& path, const std::string& array, const std::string& unit) {
  GridOptions options;
  options.array = array;
  options.unit = unit;
  return read_grid_file(path, options);
}

}  // namespace espdiff::cli
