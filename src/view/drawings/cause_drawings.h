// cause_drawings.h: a molecule coloured by what its residues add to a reading's difference, and the reading's patch.
#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "base/types.h"
#include "plot/colour_map.h"
#include "scene/comparison_files.h"
#include "view/drawings/residue_labels.h"

namespace espdiff {

/// The molecule has the source's residues, in the frame of the surface.
struct CauseDrawing {
  const Molecule& molecule;
  const ReadingCauses& causes;
  const DivergingMap& colours;
  double text_pixels = 18;
};

/// The end of the colour scale: the largest contribution's size.
double largest_contribution(const ReadingCauses& causes);
/// "molecule: contributions to the difference of region, -0.36 to 0.36 kT/e"
std::string causes_in_words(const ReadingCauses& causes);

/// Cartoon, with the five largest as sticks, or sticks of all. Residues that the source lacks are left out.
std::vector<vtkSmartPointer<vtkProp>> make_causes(const CauseDrawing& drawing, MoleculeStyle style);

struct CauseLabel {
  ResidueMark mark;
  std::vector<vtkSmartPointer<vtkProp>> props;  ///< make_label()'s
};
/// "LYS 118 -0.36": of the five largest.
std::vector<CauseLabel> make_cause_labels(const CauseDrawing& drawing);

/// Indices of the source's residues whose surface a reading is of; empty for the whole.
std::vector<int> residues_of_reading(const RunRecord& record, const CauseDrawing& drawing);

/// The border of these residues' surface as lines; null without any.
vtkSmartPointer<vtkProp> make_outline(const SurfaceFile& surface, const std::vector<int>& residues, double width);

}  // namespace espdiff
