// frame_models.cpp: gives the places of a frame to the atoms of another file.
#include "io/structures/frame_models.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "io/molecules/select_atoms.h"

namespace espdiff {

FrameModels::FrameModels(std::unique_ptr<CoordinateFile> file, std::shared_ptr<const Molecule> atoms)
    : file_(std::move(file)), atoms_(std::move(atoms)) {}

Molecule FrameModels::read(const StructureOptions& options) const {
  if (atoms_ == nullptr)
    throw InputError(file_->path() + ": has the coordinates of " + std::to_string(n_atoms()) +
                     " atoms without their names; give the topology that it was made with (" +
                     option("topology", "FILE") + " of an Amber prmtop or a PSF), or a PDB or PQR instead of it");
  return read_with(*atoms_, options);
}

Molecule FrameModels::read_with(const Molecule& atoms, const StructureOptions& options) const {
  const CoordinateFrame& read = frame(options.model);
  if (read.positions.size() != atoms.size())
    throw InputError(file_->path() + ": has " + std::to_string(read.positions.size()) + " atoms, and " + atoms.name +
                     " has " + std::to_string(atoms.size()) +
                     "; give the topology that the coordinates were made with");
  if (!options.assembly.empty())
    throw InputError(file_->path() + ": has coordinates, which describe no assemblies; leave " + option("assembly") +
                     " out");
  Molecule molecule = atoms;
  for (std::size_t i = 0; i < molecule.size(); ++i) molecule.positions[i] = static_cast<Vec3d>(read.positions[i]);
  molecule.name = file_->path();
  if (file_->n_frames() > 1) molecule.name += ", frame " + std::to_string(options.model - 1);
  return keep_kinds(molecule, options);
}

const CoordinateFrame& FrameModels::frame(int model) const {
  if (model < 1 || model > file_->n_frames())
    throw InputError(file_->path() + ": there is no frame " + std::to_string(model - 1) + "; it has " +
                     std::to_string(file_->n_frames()) + ", from 0");
  const CoordinateFrame& read = file_->frame(model - 1);
  for (std::size_t i = 0; i < read.positions.size(); ++i) check_position(read.positions[i], i, model - 1);
  return read;
}

/// A frame that was damaged is an error of its own; the others are good. Not finite is not below the limit.
void FrameModels::check_position(const Vec3f& p, std::size_t atom, int number) const {
  constexpr float kFarthest_A = 1e6F;
  const auto is_possible = [](float x) { return std::fabs(x) <= kFarthest_A; };
  if (is_possible(p.x) && is_possible(p.y) && is_possible(p.z)) return;
  throw FormatError(file_->path(), 0,
                    "frame " + std::to_string(number) + ": atom " + std::to_string(atom) +
                        formatted(" is at (%g, %g, %g) A", static_cast<double>(p.x), static_cast<double>(p.y),
                                  static_cast<double>(p.z)) +
                        ", and coordinates are numbers within 10^6 A; write the frame again, or leave it out");
}

}  // namespace espdiff
