// replicate_request.h: the replicates of an ensemble as a user names them: in groups of files, in a list, or by frames
// that come from no file.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace espdiff {

struct LoadedState;

/// One replicate: the models of its files, or the frames of its trajectories, in order; or frames that the caller has,
/// such as those of a molecule in VMD.
struct ReplicateRequest {
  std::string group;
  std::string name;                ///< empty: of the first file
  std::vector<std::string> files;  ///< structure files, or trajectories of the topology's atoms
  std::string topology;            ///< structure or topology whose atoms the trajectories have; empty for none

  /// Instead of files: a frame by its number, from 0.
  /// @param with_everything also needs `everything` and the cell, for potentials of all charges in it
  std::function<LoadedState(std::size_t frame, bool with_everything)> read;
  std::string origin;        ///< in words: "molecule 0 (adk), 99 frames"
  std::string sha256;        ///< of the frames
  std::size_t n_frames = 0;  ///< that `read` has
  std::string maps{};        ///< pattern of the frames' maps, see map_file(); empty for the group's, or none
};

/// Replicates of groups as the command line has them, NAME FILE...: each file is a replicate. Where files after the
/// first are trajectories, the first one is the structure or topology of their atoms, and no replicate. Files of one
/// name in different folders are distinguished by their folders.
/// @throws InputError (no group, a group without a name or without files)
std::vector<ReplicateRequest> replicates_of_groups(const std::vector<std::vector<std::string>>& groups);

/// Replicates of a table with the columns group, structure, and optionally replicate (rows of one replicate follow each
/// other), topology, charges and maps (a pattern). Paths are relative to the table.
/// @param charges receives the files of the groups
/// @throws as read_csv()
std::vector<ReplicateRequest> replicates_of_list(const std::string& path, std::map<std::string, std::string>& charges);

}  // namespace espdiff
