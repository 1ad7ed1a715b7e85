// input_files.cpp: by member; a patch of an earlier ensemble is in two files.
#include "prepare/input_files.h"

#include "prepare/read_earlier_patch.h"

namespace espdiff {

std::vector<std::string> input_files(const InputOptions& options) {
  std::vector<std::string> files = options.charges.ligands;
  files.insert(files.end(), {options.both.topology, options.source.topology, options.target.topology,
                             options.charges_from});
  for (const PatchRequest& patch : options.patches) {
    if (const auto earlier = earlier_patch_name(patch.selection))
      files.insert(files.end(), {earlier->path, surface_beside(*earlier)});
  }
  return files;
}

}  // namespace espdiff
