// residue_labels.h: names of the residues whose potential differs most, beside their places on the surface.
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "base/types.h"
#include "view/surface_file.h"

class vtkProp;

namespace espdiff {

/// A residue of the source on the mapped surface.
struct ResidueMark {
  int residue = -1;        ///< index into the source's residues
  double mean_difference;  ///< mean |difference| over its vertices
  Vec3d place{};           ///< its vertex nearest to their mean
  Vec3d outward{};         ///< unit
};

/// The residues with the largest mean |difference| over their vertices (20 or more of them with a value), in falling
/// order; at most `n`, and none within 9 A of one before it, so that labels can be read.
std::vector<ResidueMark> most_different_residues(const SurfaceFile& surface, int n);

/// "LYS 12", with the chain before the number where the molecule has several: "LYS A12".
std::string residue_name(const Molecule& molecule, int residue);

/// Text that faces the viewer, off the surface, and a line to its place. Hidden where the surface is in between.
std::vector<vtkSmartPointer<vtkProp>> make_label(const ResidueMark& mark, const std::string& text, double text_pixels);

}  // namespace espdiff
