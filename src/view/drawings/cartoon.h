// cartoon.h: a protein's backbone as ribbons: wide for helices, arrows for strands, thin tubes between.
#pragma once

#include <vtkSmartPointer.h>

#include <vector>

#include "base/types.h"
#include "plot/colour_map.h"

class vtkPolyData;

namespace espdiff {

/// Colours distinct from the red, blue and grey of a surrounding surface.
inline constexpr Rgb kHelixColour{214, 170, 74}, kStrandColour{72, 148, 122}, kCoilColour{168, 168, 164};

/// The ribbons as triangles with point normals and colours (unsigned bytes, active scalars); empty for a molecule
/// without backbone. M. Carson, J. Mol. Graph. 5, 103 (1987): the ribbon lies in the planes of the peptides. Here
/// Catmull-Rom splines pass through the C-alphas of helices and coils, and through their means along strands.
/// @param colours [residue]; empty: by fold
vtkSmartPointer<vtkPolyData> make_cartoon(const Molecule& molecule, const std::vector<Rgb>& colours = {});

}  // namespace espdiff
