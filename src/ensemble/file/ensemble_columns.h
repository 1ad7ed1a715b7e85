// ensemble_columns.h: an ensemble file's values as columns of replicates.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "statistics/columns.h"

namespace espdiff {

class EnsembleFile;

/// How the start of each replicate is cut off.
struct Equilibration {
  enum class Kind { kNone, kAutomatic, kFrames } kind = Kind::kNone;
  std::size_t n_frames = 0;  ///< of kFrames
};
/// "none", "auto", or a number of frames. @throws InputError
Equilibration parse_equilibration(const std::string& text);
/// The text that parse_equilibration() reads.
std::string to_string(const Equilibration& how);

/// [replicate] frames to cut off. Automatic: the later of those that leave most effective samples of the RMSD to the
/// template and of the mean potential; see detect_equilibration().
/// @throws InputError (fewer than two frames are left)
std::vector<std::size_t> equilibrated_starts(const EnsembleFile& file, const Equilibration& how);

/// Columns of the file from the given frame of each replicate on. The file outlives them.
class EnsembleColumns : public Columns {
 public:
  EnsembleColumns(const EnsembleFile& file, std::vector<std::size_t> starts);
  std::size_t n_columns() const override;
  std::size_t n_replicates() const override { return starts_.size(); }
  std::size_t n_frames(std::size_t replicate) const override;
  void read(std::size_t replicate, std::size_t begin, std::size_t end, std::vector<float>& values) const override;

 private:
  const EnsembleFile& file_;
  std::vector<std::size_t> starts_;  // [replicate] frames cut off
  std::vector<std::size_t> first_;   // [replicate] of all frames
};

}  // namespace espdiff
