// options.h: options that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/molecule/structure_options.h"
#include "io/grids/read_grid.h"
#include "options/settings.h"
#include "potential/potential.h"
#include "potential/potential_settings.h"

namespace espdiff::cli {

/// An option whose text passes when `check` throws no InputError, whose words become the message.
CLI::Validator checked_by(const std::function<void(const std::string&)>& check);
/// An option that takes finite numbers from `least` on.
CLI::Validator finite_number(double least = -std::numeric_limits<double>::infinity());

struct DeviceArguments {
  std::string device = "auto";
  int threads = 0;
};
void add_device_options(CLI::App& parser, DeviceArguments& arguments);
std::unique_ptr<Engine> make_engine(const DeviceArguments& arguments);

void add_structure_options(CLI::App& parser, StructureOptions& options);
/// --plugins, of commands that read trajectories.
void add_plugins_option(CLI::App& parser, std::string& folder, const std::string& group);
/// The given settings of a comparison, by name, for make_options().
using GivenSettings = std::vector<std::pair<std::string, std::string>>;
/// What a verb does decides which settings it has.
enum class SettingsFor {
  kPair,        ///< all
  kVariants,    ///< of many structures alike: none of one side, no patches of one state
  kSurface,     ///< those that one molecule's surface depends on
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
void add_range_of(CLI::App& parser, std::vector<std::string>& others);
/// Behind both --range and --range-of.
inline constexpr const char* kTwoRanges = "--range-of and --range exclude each other: one of them sets the scale";

/// Reads a potential map and, unless `unit` is empty, declares its unit.
GridFile read_map(const std::string& path, const std::string& array, const std::string& unit);

}  // namespace espdiff::cli
