// volume_store.cpp: the map from names to volumes, and its lock.
#include "volume_store.h"

#include <map>
#include <mutex>
#include <utility>

#include "base/error.h"

namespace espdiff {
namespace {

struct Store {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<StoredVolume>> volumes;
};

Store& store() {
  static Store the_store;
  return the_store;
}

void check_volume(const std::string& name, const Grid& grid) {
  for (const int n : grid.lattice.size) {
    if (n < 2) {
      throw InputError("volume '" + name + "': an axis has " + std::to_string(n) +
                       " points; at least 2 along each axis were expected");
    }
  }
  if (grid.values.size() != grid.lattice.n_points()) {
    throw InputError("volume '" + name + "': " + std::to_string(grid.values.size()) + " values for " +
                     std::to_string(grid.lattice.n_points()) + " grid points; the numbers must be equal");
  }
}

}  // namespace

void put_volume(const std::string& name, Grid grid, std::string dataname) {
  check_volume(name, grid);
  auto volume = std::make_shared<StoredVolume>(StoredVolume{std::move(grid), std::move(dataname)});
  const std::lock_guard<std::mutex> lock(store().mutex);
  store().volumes[name] = std::move(volume);
}

std::optional<Grid> take_volume(const std::string& name) {
  std::shared_ptr<StoredVolume> volume;
  {
    const std::lock_guard<std::mutex> lock(store().mutex);
    const auto found = store().volumes.find(name);
    if (found == store().volumes.end()) return std::nullopt;
    volume = std::move(found->second);
    store().volumes.erase(found);
  }
  // After removal from the store nobody new can own it, so that a single owner stays the only one.
  if (volume.use_count() == 1) return std::move(volume->grid);
  return volume->grid;
}

std::vector<std::string> volume_names() {
  const std::lock_guard<std::mutex> lock(store().mutex);
  std::vector<std::string> names;
  for (const auto& entry : store().volumes) names.push_back(entry.first);
  return names;
}

std::optional<VolumeDescription> describe_volume(const std::string& name) {
  const auto volume = find_volume(name);
  if (volume == nullptr) return std::nullopt;
  return VolumeDescription{volume->grid.lattice, volume->grid.unit, volume->dataname};
}

std::shared_ptr<const StoredVolume> find_volume(const std::string& name) {
  const std::lock_guard<std::mutex> lock(store().mutex);
  const auto found = store().volumes.find(name);
  return found == store().volumes.end() ? nullptr : found->second;
}

}  // namespace espdiff
