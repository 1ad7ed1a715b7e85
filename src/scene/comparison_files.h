// comparison_files.h: all files of one comparison that a picture may need.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/structures/run_record.h"
#include "scene/map_pair.h"
#include "scene/scene.h"
#include "scene/surface_file.h"

namespace espdiff {

/// The causes of one reading, of OUT.causes.csv.
struct ReadingCauses {
  std::string reading, unit;
  std::vector<Residue> residues;    ///< largest contribution first
  std::vector<double> differences;  ///< what each adds to the difference
};

struct ComparisonFiles {
  SurfaceFile surface;
  RunRecord record;
  MapPair maps;
  /// As they were compared, in the target's frame; present if the scene draws or names residues.
  std::optional<Molecule> source_molecule, target_molecule;
  /// The same with water; present if the scene shows the surroundings.
  std::optional<Molecule> source_surroundings, target_surroundings;
  std::optional<ReadingCauses> causes;  ///< of the scene's reading
};

/// Reads OUT.vtp, the OUT.json beside it and, if the scene needs them, the maps that it names.
/// @throws as read_surface_file() and read_run_record(); InputError if the scene draws the source's shape and OUT.json
/// is missing, or colours by an array that the file lacks
ComparisonFiles read_comparison(const std::string& vtp_path, const Scene& scene);

/// Reads the files that a changed scene needs in addition; maps are not read again.
/// @throws as read_comparison()
void read_missing_files(ComparisonFiles& files, const Scene& scene);

/// Residues of the source in the part that a scene looks at; none without one.
/// @throws InputError listing the parts of the result
std::vector<int> focused_residues(const RunRecord& record, const Scene& scene);
/// Those whose border is drawn: of the focus, otherwise of the region.
std::vector<int> outlined_residues(const RunRecord& record, const Scene& scene);

/// Every file that a comparison is read from; pictures must not replace them.
std::vector<std::string> files_of(const ComparisonFiles& files);

/// Whether a scene's pixels show potentials, which are better looked up in the maps.
bool shows_potentials(const Scene& scene);

}  // namespace espdiff
