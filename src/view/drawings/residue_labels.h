// residue_labels.h: labels of the residues with the largest potential difference.
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "base/types.h"
#include "scene/surface_file.h"

class vtkProp;
class vtkRenderer;

namespace espdiff {

/// A residue of the source on the mapped surface.
struct ResidueMark {
  int residue = -1;        ///< index into the source's residues
  double mean_difference;  ///< mean |difference| over its vertices
  Vec3d place{};           ///< its vertex nearest to their mean
  Vec3d outward{};         ///< unit
};

/// The residues with the largest mean |difference| over their vertices (at least 20 with a value), in descending order;
/// at most `n`, at least 9 A apart, so that the labels are readable.
std::vector<ResidueMark> most_different_residues(const SurfaceFile& surface, int n);

/// "LYS 12", with the chain before the number if the molecule has several: "LYS A12".
std::string residue_name(const Molecule& molecule, int residue);

/// Text that faces the viewer, off the surface, and a line to its position.
std::vector<vtkSmartPointer<vtkProp>> make_label(const ResidueMark& mark, const std::string& text, double text_pixels);

/// Whether a surface lies between a mark and the viewer, or the mark is on its far side.
bool is_hidden(const std::vector<Triangle>& triangles, const std::vector<Vec3d>& positions, const ResidueMark& mark,
               Vec3d toward_viewer);

/// Moves the text of make_label() to the front of a renderer's view, where no surface cuts it. In parallel projection
/// it stays where it is in the picture.
void lift_label(const std::vector<vtkSmartPointer<vtkProp>>& label, const ResidueMark& mark, vtkRenderer* renderer);

}  // namespace espdiff
