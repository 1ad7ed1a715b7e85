// real_pairs.h: the real pairs on which mappings are judged, with the known figures of each.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff_bench {

/// The row of the throwaway prototype's `deform` (density field, 1 A grid, radius scale 1) for one pair, from the table
/// "Where a throwaway prototype stood" of the project's figures to beat (BARS.md). For a group of pairs: medians.
struct PrototypeRow {
  double rmsd_A = 0;
  double n_vertices = 0;  ///< 0 if not given
  double corrupt_percent = 0;
  double coverage_max_A = 0;  ///< largest distance from the target's vertices to the mapped surface
};

using MoleculePair = std::pair<espdiff::Molecule, espdiff::Molecule>;

struct RealPair {
  std::string name;
  std::string group;               ///< pairs of one group are summarized in one row; empty for a single row
  std::vector<std::string> files;  ///< what load() reads
  std::function<MoleculePair()> load;
  std::optional<PrototypeRow> prototype;
};

/// What the prototype reached on the group "series19"; the second member is the worst of its 32 pairs.
std::pair<PrototypeRow, PrototypeRow> series19_prototype();

/// $ESPDIFF_DATA, else shared/data beside the checkout; empty when neither exists.
std::string data_folder();

/// Parts omitted from the table because they take long.
struct LongSeries {
  bool all_ubiquitin = false;  ///< all 342 ordered pairs of the 19 models instead of 32
  bool all_adk = false;        ///< adenylate kinase's frame 0 with each of the other 97 instead of three
};

/// All pairs, whether their files exist or not. Files are looked for in data_folder() and where Debian's apbs-data and
/// freesasa put them.
std::vector<RealPair> real_pairs(LongSeries series = {});

/// The first missing file of the pair; empty if all exist.
std::string missing_file(const RealPair& pair);

}  // namespace espdiff_bench
