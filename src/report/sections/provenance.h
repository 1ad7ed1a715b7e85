// provenance.h: what a result was made of, and by what.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/version.h"

namespace espdiff {

class ComputedMap;
struct MapRecipe;
struct Preparation;

/// An input by what it was used for: "source", "target", "source_map", "target_map".
struct InputFile {
  std::string role;
  std::string path;                                     ///< of a computed map: "pme of" whose charges
  std::string sha256;                                   ///< of a computed map: of charges, positions, cell and options
  std::shared_ptr<const MapRecipe> computed = nullptr;  ///< of a computed map
  /// Of a structure that was read from a file: which of its models and atoms.
  std::optional<StructureOptions> read_with = std::nullopt;
};
/// A computed map as an input.
InputFile computed_input(const std::string& role, const ComputedMap& map);

/// What a result needs besides numbers to be reproduced.
struct Provenance {
  std::string version = kVersion;
  std::string device;              ///< "cpu" or "cuda"
  std::string device_description;  ///< "16 OpenMP threads"
  int threads = 0;                 ///< of the CPU back end; 0 on a device
  std::vector<InputFile> inputs;
  /// "source" or "target", and what PDB2PQR did to it
  std::vector<std::pair<std::string, std::shared_ptr<const Preparation>>> preparations;
  std::string command_line;
};

}  // namespace espdiff
