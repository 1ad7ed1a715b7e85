// given_maps.cpp: finds the maps of frames, and reads them one at a time.
#include "ensemble/frames/given_maps.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "ensemble/frames/map_pattern.h"
#include "io/grids/read_grid.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

std::string name_of(const EnsembleReplicate& replicate) {
  return "replicate " + replicate.name + " of " + replicate.group;
}

}  // namespace

GivenMaps::GivenMaps(const GivenMapRequest& request, const std::vector<EnsembleReplicate>& replicates,
                     const std::vector<std::string>& patterns, const std::vector<std::vector<int>>& frames,
                     double temperature_K)
    : request_(request), temperature_K_(temperature_K) {
  const auto has_group = [&](const std::string& group) {
    return std::any_of(replicates.begin(), replicates.end(), [&](const auto& r) { return r.group == group; });
  };
  for (const auto& [group, pattern] : request.of_group) {
    if (pattern.empty() || !has_group(group))
      throw InputError(option("maps", pattern.empty() ? group : group + "=" + pattern) +
                       " is not GROUP=PATTERN with one of the groups, such as " + replicates.front().group +
                       "=maps/{replicate}.%d.dx");
  }
  std::map<std::string, std::string> taken;  // first file: replicate
  const EnsembleReplicate *with = nullptr, *without = nullptr;
  std::vector<std::vector<std::string>> files;
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    const auto of_group = request.of_group.find(replicates[r].group);
    const std::string pattern = !patterns[r].empty()                 ? patterns[r]
                                : of_group != request.of_group.end() ? of_group->second
                                                                     : std::string();
    (pattern.empty() ? without : with) = &replicates[r];
    files.emplace_back();
    if (pattern.empty()) continue;
    check_map_pattern(pattern);
    std::uintmax_t bytes = 0;
    for (const int frame : frames[r]) {
      files.back().push_back(map_file(pattern, replicates[r].name, frame));
      const std::string& path = files.back().back();
      std::error_code error;
      const std::uintmax_t size = fs::file_size(path, error);
      if (error)
        throw InputError("frame " + std::to_string(frame) + " of " + name_of(replicates[r]) +
                         " has no map: there is no file '" + path + "'");
      bytes += size;
    }
    identity_.emplace_back("maps of " + replicates[r].group + ", " + replicates[r].name,
                           std::to_string(files.back().size()) + " files, " + std::to_string(bytes) + " bytes");
    if (files.back().empty()) continue;
    const auto [known, is_new] = taken.emplace(files.back().front(), name_of(replicates[r]));
    if (!is_new)
      throw InputError(option("maps") + ": " + known->second + " and " + name_of(replicates[r]) +
                       " would have the same maps, '" + pattern + "'; {replicate} stands for a replicate's name");
  }
  if (with == nullptr) return;
  if (without != nullptr)
    throw InputError(name_of(*without) + " has no maps, and " + name_of(*with) + " has; give all of them by " +
                     option("maps") + ", or none");
  files_ = std::move(files);
  unit_ = read_file(files_.front().front()).unit;
}

Grid GivenMaps::read_file(const std::string& path) const {
  GridOptions options;
  options.array = request_.array;
  options.unit = request_.unit;
  return read_grid_file(path, options).grid;
}

Grid GivenMaps::read(std::size_t replicate, std::size_t place) const {
  Grid map = read_file(files_.at(replicate).at(place));
  if (map.unit == unit_) return map;
  if (map.unit == PotentialUnit::kUnknown || unit_ == PotentialUnit::kUnknown)
    throw InputError(map.name + ": the map's unit is " + to_string(map.unit) + ", and that of the first map " +
                     to_string(unit_) + "; name the unit of all of them by " + option("map-unit"));
  const auto factor = static_cast<float>(conversion_factor(map.unit, unit_, temperature_K_));
  for (float& value : map.values) value *= factor;
  map.unit = unit_;
  return map;
}

}  // namespace espdiff
