// volume_store.h: volumes in memory by name, by which VMD and the Tcl commands exchange maps.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A volume and what VMD calls it, such as "PME potential (kT/e, T=300K)".
struct StoredVolume {
  Grid grid;
  std::string dataname;
};

/// A volume without its values.
struct VolumeDescription {
  Lattice lattice;
  PotentialUnit unit = PotentialUnit::kUnknown;
  std::string dataname;
};

// One store for the process; each function may be called from any thread.

/// Stores a volume under `name`; replaces an older one.
/// @throws InputError when an axis has fewer than 2 points or the number of values is not the lattice's
void put_volume(const std::string& name, Grid grid, std::string dataname);

/// Removes a volume and returns its grid; nothing when there is none. Free of copying unless VMD is reading it.
std::optional<Grid> take_volume(const std::string& name);

std::vector<std::string> volume_names();  ///< sorted

std::optional<VolumeDescription> describe_volume(const std::string& name);

/// The volume itself, which outlives its removal from the store; null when there is none.
std::shared_ptr<const StoredVolume> find_volume(const std::string& name);

}  // namespace espdiff
