// options.h: options that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/molecule/structure_options.h"
#include "cli/words/words.h"
#include "engine/select_engine.h"
#include "io/grids/read_grid.h"
#include "options/settings.h"
#include "potential/potential.h"
#include "potential/potential_settings.h"

namespace espdiff::cli {

/// --no-hetero, and --water or --no-water, whichever changes what `options` are.
void add_structure_options(CLI::App& parser, StructureOptions& options);
/// --model, of verbs that read one model.
void add_model_option(CLI::App& parser, StructureOptions& options);
/// What help calls the value of an option.
std::string type_of(SettingKind kind, const std::vector<std::string>& choices, bool is_file);
/// What is wrong with a value that `set` refuses, without the option's name, which the parser puts before it.
std::string refusal(const std::function<void()>& set, const std::string& name);
/// "Do not reuse the cache" of "Reuse the cache".
std::string negated(std::string help);

/// Adds a row as the option `words`; a boolean one as a flag, `--no-name` if it is on by default. A value is checked
/// during parsing, so that the message names the option.
/// @param take receives the texts, each by itself where `is_list`, whose option may be given several times
template <typename Options>
CLI::Option* add_row(CLI::App& parser, const std::string& words, const OptionRow<Options>& row, const Options& defaults,
                     const std::function<void(const std::string&)>& take, bool is_list = false) {
  const std::string value = row.get(defaults);
  if (row.kind == SettingKind::kBoolean) {
    const bool on = value == "1";
    return parser
        .add_flag_callback(
            on ? "--no-" + words.substr(2) : words, [take, on] { take(on ? "0" : "1"); },
            on ? negated(row.help) : row.help)
        ->group(row.group);
  }
  CLI::Option* const added = is_list ? parser.add_option_function<std::vector<std::string>>(
                                           words,
                                           [take](const std::vector<std::string>& texts) {
                                             for (const std::string& text : texts) take(text);
                                           },
                                           row.full_help())
                                     : parser.add_option_function<std::string>(words, take, row.full_help());
  if (is_list) added->expected(1)->take_all();
  const auto check = [&row](const std::string& text) {
    Options scratch;
    const std::string why = refusal([&] { row.set(scratch, text); }, row.name);
    return why.empty() ? why : why + did_you_mean(text, row.choices);
  };
  return added->check(CLI::Validator(check, ""))
      ->type_name(type_of(row.kind, row.choices, row.is_file))
      ->default_str(value)
      ->group(row.group);
}

/// "--color,--colour"
template <typename Options>
std::string words_of(const OptionRow<Options>& row) {
  return "--" + row.name + (row.other_name.empty() ? "" : ",--" + row.other_name);
}

/// Adds the options of a study, which are set as they are read.
template <typename Study>
void add_rows(CLI::App& parser, const std::vector<OptionRow<Study>>& rows, Study& study) {
  for (const OptionRow<Study>& row : rows)
    add_row<Study>(parser, words_of(row), row, study,
                   [&row, &study](const std::string& text) { row.set(study, text); });
}

/// The given settings of a comparison, by name, for make_options().
using GivenSettings = std::vector<std::pair<std::string, std::string>>;
/// What a verb does decides which settings it has.
enum class SettingsFor {
  kPair,        ///< all
  kVariants,    ///< of many structures alike: none of one side, no patches of one state, no interface
  kComplexes,   ///< one or two complexes: no fields
  kSurface,     ///< those that one molecule's surface depends on
  kMap,         ///< the same, and the temperature
  kPreparation  ///< which atoms, and where charges come from
};
/// Adds settings as options `--name`; a boolean one as a flag, `--no-name` if it is on by default.
void add_settings(CLI::App& parser, GivenSettings& given, SettingsFor what);

/// Adds every option of computed potentials, for make_potential_options().
/// @param of_maps by the names of `espdiff potential`: `--grid` as PMEPot has it, not `--pme-grid`
void add_potential_settings(CLI::App& parser, GivenPotentialSettings& given, bool of_maps);

/// --overwrite, of a verb whose outputs are the files that its options name.
void add_overwrite(CLI::App& parser, bool& overwrite);

/// --range-of, of a verb that draws: other results, whose automatic range counts too.
CLI::Option* add_range_of(CLI::App& parser, std::vector<std::string>& others);
/// Behind both --range and --range-of.
inline constexpr const char* kTwoRanges = "--range-of and --range exclude each other: one of them sets the scale";

/// Reads a potential map and, unless `unit` is empty, declares its unit.
GridFile read_map(const std::string& path, const std::string& array, const std::string& unit);

}  // namespace espdiff::cli
