// options.h: options that several verbs share.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/structure_options.h"
#include "compare/settings.h"
#include "io/read_grid.h"
#include "potential/potential.h"

namespace espdiff::cli {

struct DeviceArguments {
  std::string device = "auto";
  int threads = 0;
};
void add_device_options(CLI::App& parser, DeviceArguments& arguments);
std::unique_ptr<Engine> make_engine(const DeviceArguments& arguments);

void add_structure_options(CLI::App& parser, StructureOptions& options);
/// The settings of a comparison that were given, by name; make_options() takes them.
using GivenSettings = std::vector<std::pair<std::string, std::string>>;
/// Adds every setting as an option `--name`; a boolean one as a flag, `--no-name` where it is on by default.
/// @param of_surface_only leaves out what only a mapping depends on
void add_settings(CLI::App& parser, GivenSettings& given, bool of_surface_only);

/// Reads a potential map and, where `unit` is not empty, declares its unit.
GridFile read_map(const std::string& path, const std::string& array, const std::string& unit);

}  // namespace espdiff::cli
