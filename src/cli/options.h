// options.h: options that several verbs share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "io/read_structure.h"
#include "pipeline/potential.h"
#include "pipeline/settings.h"

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
/// The settings of a comparison that were given, by name; make_options() takes them.
using GivenSettings = std::vector<std::pair<std::string, std::string>>;
/// Adds every setting as an option `--name`; a boolean one as a flag, `--no-name` where it is on by default.
/// @param of_surface_only leaves out what only a mapping depends on
void add_settings(CLI::App& parser, GivenSettings& given, bool of_surface_only);

/// Reads a potential map and, where `unit` is not empty, declares its unit.
Grid read_map(const std::string& path, const std::string& array, const std::string& unit);

}  // namespace espdiff::cli
