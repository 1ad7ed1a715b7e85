// given_maps.h: the potentials of an ensemble's frames where other programs computed them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "ensemble/frames/ensemble_plan.h"

namespace espdiff {

/// What names the maps.
struct GivenMapRequest {
  std::map<std::string, std::string> of_group;  ///< group: a pattern, see map_file()
  std::string unit;                             ///< of files that do not give it; empty for none
  std::string array;                            ///< of VTI files with several
};

/// A file for each frame, read when the frame is.
class GivenMaps {
 public:
  GivenMaps() = default;
  /// Finds every file, and reads the first one, whose unit all maps are converted to. Their content is not hashed: with
  /// many frames that would read all of them twice.
  /// @param patterns [replicate] of its own, from a list; empty for the group's
  /// @param frames   [replicate][] numbers of the chosen frames, from 0
  /// @throws InputError (a pattern; a group without maps where others have some; replicates that share maps; a missing
  ///         file), as read_grid_file()
  GivenMaps(const GivenMapRequest& request, const std::vector<EnsembleReplicate>& replicates,
            const std::vector<std::string>& patterns, const std::vector<std::vector<int>>& frames,
            double temperature_K);

  /// Whether there are any.
  bool given() const { return !files_.empty(); }
  PotentialUnit unit() const { return unit_; }
  /// [replicate][chosen frame]
  const std::vector<std::vector<std::string>>& files() const { return files_; }
  /// Of each replicate, what identifies its maps in the plan: "maps of wild, w1", "100 files, 123456 bytes".
  const std::vector<std::pair<std::string, std::string>>& identity() const { return identity_; }
  /// @throws as read_grid_file(); InputError (another unit, of which one is unknown)
  Grid read(std::size_t replicate, std::size_t place) const;

 private:
  Grid read_file(const std::string& path) const;

  GivenMapRequest request_;
  double temperature_K_ = 0;
  PotentialUnit unit_ = PotentialUnit::kUnknown;
  std::vector<std::vector<std::string>> files_;
  std::vector<std::pair<std::string, std::string>> identity_;
};

}  // namespace espdiff
