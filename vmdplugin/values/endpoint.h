// endpoint.h: one side of a comparison as Tcl describes it: a file, or atoms and coordinates that VMD holds.
#pragma once

#include <tcl.h>

#include <optional>
#include <string>
#include <vector>

#include "base/molecule/unit_cell.h"
#include "base/types.h"
#include "potential/potential_settings.h"
#include "study/state.h"
#include "tcl_values.h"

namespace espdiff::vmdplugin {

/// Reads the description; the keys are those of the Tcl layer's contract:
///   file PATH ?model N? ?map MAP?
///   atoms LIST coordinates BYTES ?indices LIST? name TEXT radii_origin R charges_origin C ?input TEXT? ?cell LIST?
///   ?region LIST? ?values {NAME LIST ...}? ?map MAP?
/// both with ?shapes_because TEXT?, the region's atoms as indices into the coordinates, values of fields of all atoms
/// in the coordinates, and MAP: file PATH ?array NAME? ?unit U?, or memory NAME ?unit U?, or
///   memory NAME mean_over N charges LIST cell LIST ?KEY VALUE ...?: a mean of PME over N frames, in kT/e, or
///   kind pme|pb|coulomb ?charges LIST? ?radii LIST? ?water B? ?box CELL? ?because TEXT? ?KEY VALUE ...?, the keys
///   those of potential_settings()
/// A volume in memory is removed from the store. `charges` are those of all atoms in the coordinates, 0 for unselected
/// ones; by default those of the molecule.
/// @param role "source", "target" or "molecule"
/// @throws InputError (wrong keys, numbers that do not fit each other, no atoms, radii that add no density)
State parse_endpoint(Tcl_Obj* description, const std::string& role);
StatePtr shared_endpoint(Tcl_Obj* description, const std::string& role);

/// Reads the keys of potentials' settings from a dict.
GivenPotentialSettings take_potential_settings(DictReader& reader);

/// A cell of six numbers, lengths and angles; empty if a length is at most 1 A, by which VMD marks a missing cell.
std::optional<UnitCell> parse_unit_cell(Tcl_Obj* numbers, const std::string& what);

/// Atoms with positions and charges only, for a potential: `coordinates` as `gettimestep` returns them.
/// @throws InputError (numbers that do not fit each other)
Molecule charged_atoms(Tcl_Obj* charges, Tcl_Obj* coordinates, const std::string& name);

/// Names and residues of atoms, one description each as in `atoms` above, at the positions given.
/// @throws InputError (numbers that do not fit each other)
Molecule named_atoms(const std::vector<Tcl_Obj*>& atoms, const std::vector<Vec3d>& positions, const std::string& name);

}  // namespace espdiff::vmdplugin
