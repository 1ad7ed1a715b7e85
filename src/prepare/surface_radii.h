// surface_radii.h: the radii of the compared surfaces.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/input_options.h"
#include "base/types.h"

namespace espdiff {

/// Why the radii of two molecules give surfaces that differ everywhere: only one has some from a file, or their force
/// fields differ. Empty where they go together.
std::string radii_conflict(const Molecule& a, const Molecule& b);

/// Sets the radii by which surfaces are made. kAuto keeps the files' radii where all molecules have some of one origin
/// and, for 9 in 10 of the atoms that share residue and atom names, of one force field (equal within 0.01 A);
/// otherwise all take Bondi's by element. Potentials that were computed keep the radii they were given.
/// @returns a note where kAuto replaced radii, otherwise empty
/// @throws InputError (kFile, and a molecule has no radii from a file)
std::string set_surface_radii(const std::vector<Molecule*>& molecules, RadiiChoice choice);

/// Sets the radii of a frame that is compared with a source whose surface is made already.
/// @param source after set_surface_radii(); without atoms nothing is compared with it yet
/// @throws InputError (kAuto, and the frame's radii are not of the source's origin and force field)
void set_frame_radii(const Molecule& source, Molecule& frame, RadiiChoice choice);

}  // namespace espdiff
