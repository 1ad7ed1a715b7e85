// options.h: options that several verbs share.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "engine/engine.h"
#include "io/read_structure.h"
#include "pipeline/compare.h"

namespace espdiff::cli {

struct DeviceArguments {
  std::string device = "auto";
  int threads = 0;
};
void add_device_options(CLI::App& parser, DeviceArguments& arguments);
std::unique_ptr<Engine> make_engine(const DeviceArguments& arguments);

void add_structure_options(CLI::App& parser, StructureOptions& options);
void add_surface_options(CLI::App& parser, SurfaceOptions& options);

/// Reads a potential map and, where `unit` is not empty, declares its unit.
Grid read_map(const std::string& path, const std::string& array, const std::string& unit);

}  // namespace espdiff::cli
