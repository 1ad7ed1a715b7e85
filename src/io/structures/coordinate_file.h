// coordinate_file.h: the frames of a trajectory, one at a time, whoever reads them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/molecule/unit_cell.h"
#include "base/types.h"

namespace espdiff {

/// One frame of a trajectory.
struct CoordinateFrame {
  std::vector<Vec3f> positions;  ///< [atom] Angstrom; StructureFile refuses those that cannot be
  std::optional<UnitCell> cell;  ///< none where the file has none, or edges of 1 A and less
};

/// A file of coordinates, whose frames are read in any order.
class CoordinateFile {
 public:
  virtual ~CoordinateFile() = default;
  virtual const std::string& path() const = 0;
  virtual int n_frames() const = 0;
  /// A frame, which stays until another one is asked for.
  /// @param number from 0. @throws FormatError (the frame is damaged)
  virtual const CoordinateFrame& frame(int number) = 0;
};

}  // namespace espdiff
