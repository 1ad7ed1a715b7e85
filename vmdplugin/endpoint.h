// endpoint.h: one side of a comparison as Tcl describes it: a file, or atoms and coordinates that VMD holds.
#pragma once

#include <tcl.h>

#include <optional>
#include <string>
#include <vector>

#include "base/structure_options.h"
#include "base/types.h"
#include "compare/input.h"
#include "potential/computed_map.h"
#include "potential/potential.h"
#include "potential/potential_settings.h"
#include "prepare/load_state.h"
#include "report/provenance.h"
#include "tcl_values.h"

namespace espdiff {
struct CompareOptions;
}

namespace espdiff::vmdplugin {

/// What a map is to be computed of: all charges of a molecule, whatever part of it has the surface.
struct MapRequest {
  PotentialMethod method = PotentialMethod::kPme;
  GivenPotentialSettings given;
  std::optional<PmeCell> cell;  ///< given
  Molecule charges;             ///< positions, charges and radii only; empty: the endpoint's molecule has them
  ChargeSurroundings surroundings;
  std::string because;  ///< why this potential, where the user did not ask for it
};

/// All atoms of a structure file, with water and ions, and its cell.
struct Everything {
  Molecule molecule;
  std::optional<UnitCell> cell;
};

/// A molecule and its map. Files are read by load(), on the worker's thread.
struct Endpoint {
  std::string structure_path;  ///< empty: the molecule came from memory
  StructureOptions structure;
  std::string map_path;  ///< empty: no map, or one from memory
  std::string map_array, map_unit;
  std::optional<Molecule> molecule;
  std::optional<Grid> map;
  std::optional<MapRequest> map_request;
  std::optional<Everything> everything;     ///< if wants_everything()
  std::optional<ComputedMap> computed_map;  ///< of the request
  MapMaker averaged_map;                    ///< the mean over frames that was computed before
  std::vector<InputFile> inputs;            ///< provenance; roles begin with the endpoint's ("source", "source_map")
  std::string role;
  LoadedState state;   ///< what load() did; its molecules but `whole` are moved out
  SurfaceParts parts;  ///< of the molecule; the region where the description has one
  FieldInput fields;   ///< with VMD's values of the atoms
};

/// Reads the description; the keys are those of the Tcl layer's contract:
///   file PATH ?model N? ?map MAP?
///   atoms LIST coordinates BYTES ?indices LIST? name TEXT radii_origin R charges_origin C ?input TEXT? ?cell LIST?
///   ?region LIST? ?values {NAME LIST ...}? ?map MAP?
/// with the region's atoms as indices into the coordinates, values of all atoms in the coordinates, MAP: file PATH
/// ?array NAME? ?unit U?, or memory NAME ?unit U?, or
///   memory NAME mean_over N charges LIST cell LIST ?KEY VALUE ...?: a mean of PME over N frames, in kT/e, or
///   kind pme|pb|coulomb ?charges LIST? ?radii LIST? ?water B? ?box CELL? ?because TEXT? ?KEY VALUE ...?, the keys
///   those of potential_settings()
/// A volume in memory is removed from the store. `charges` are those of all atoms in the coordinates, 0 for unselected
/// ones; by default those of the molecule.
/// @param role "source", "target" or "molecule"
/// @throws InputError (wrong keys, numbers that do not fit each other, no atoms, radii that add no density)
Endpoint parse_endpoint(Tcl_Obj* description, const std::string& role);

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

/// Whether the requested map depends on all atoms of the structure file: pme takes water in a cell.
bool wants_everything(const Endpoint& endpoint);

/// Reads the files that are not read yet, and adds the fingerprints of all inputs.
/// @param options selections and charges of files; the temperature of the kT in a computed map's unit
/// @param source  loaded, for the target; null for others
/// @throws what load_state, read_grid and ComputedMap throw; InputError (a selection of files for VMD's atoms)
void load(Endpoint& endpoint, const CompareOptions& options, const Endpoint* source, const Progress& progress);

/// Takes patches, and a region unless the description has one.
void add_parts(Endpoint& endpoint, SurfaceParts parts);

CompareInput input_of(const Endpoint& endpoint);

}  // namespace espdiff::vmdplugin
