// frame_models.h: the frames of a trajectory, or Amber's coordinates, as the models of a structure.
#pragma once

#include <memory>

#include "io/structures/coordinate_file.h"
#include "io/structures/structure_format.h"

namespace espdiff {

/// One frame is in memory.
class FrameModels : public StructureModels {
 public:
  /// @param atoms all atoms, in the file's order; null where they come with read_with()
  FrameModels(std::unique_ptr<CoordinateFile> file, std::shared_ptr<const Molecule> atoms);

  int n_models() const override { return file_->n_frames(); }
  std::optional<UnitCell> unit_cell(int model) const override { return frame(model).cell; }
  bool needs_atoms() const override { return atoms_ == nullptr; }
  std::size_t n_atoms() const override { return frame(1).positions.size(); }
  Molecule read(const StructureOptions& options) const override;
  Molecule read_with(const Molecule& atoms, const StructureOptions& options) const override;

 private:
  const CoordinateFrame& frame(int model) const;
  void check_position(const Vec3f& p, std::size_t atom, int number) const;

  std::unique_ptr<CoordinateFile> file_;
  std::shared_ptr<const Molecule> atoms_;
};

}  // namespace espdiff
