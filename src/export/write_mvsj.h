// write_mvsj.h: a comparison as a MolViewSpec scene, which Mol* shows.
#pragma once

#include <ostream>

#include "export/exported_result.h"

namespace espdiff {

/// MolViewSpec 1 (JSON), one state that needs no other file: the source as a cartoon, coloured by the residues' values
/// with a tooltip on each, and the surface as a mesh. A triangle has the colour of its corners' mean value, in 64 steps
/// of the scale; the tooltip says the value. The time stamp, which the format asks for, is a constant: the same
/// comparison gives the same bytes.
void write_mvsj(std::ostream& out, const ExportedResult& result, const ExportedMolecule& molecule);

}  // namespace espdiff
