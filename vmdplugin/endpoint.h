// endpoint.h: one side of a comparison as Tcl describes it: a file, or atoms and coordinates that VMD holds.
#pragma once

#include <tcl.h>

#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
#include "io/read_structure.h"
#include "pipeline/write_compare.h"

namespace espdiff::vmdplugin {

/// A molecule and its map. What is in files is read by load(), on the worker's thread.
struct Endpoint {
  std::string structure_path;  ///< empty: the molecule came from memory
  StructureOptions structure;
  std::string map_path;  ///< empty: no map, or one from memory
  std::string map_array, map_unit;
  std::optional<Molecule> molecule;
  std::optional<Grid> map;
  std::vector<InputFile> inputs;  ///< provenance; roles begin with the endpoint's ("source", "source_map")
  std::string role;
};

/// Reads the description; the keys are those of the Tcl layer's contract:
///   file PATH ?model N? ?map MAP?
///   atoms LIST coordinates BYTES ?indices LIST? name TEXT radii_origin R charges_origin C ?input TEXT? ?cell LIST?
///   ?map MAP?
/// with MAP: file PATH ?array NAME? ?unit U?, or memory NAME ?unit U?. A volume in memory is taken: it is gone after.
/// @param role "source", "target" or "molecule"
/// @throws InputError (wrong keys, numbers that do not fit each other, no atoms, radii that add no density)
Endpoint parse_endpoint(Tcl_Obj* description, const std::string& role);

/// Reads the files that are not read yet, and notes their fingerprints.
/// @throws what read_structure and read_grid throw
void load(Endpoint& endpoint);

CompareInput input_of(const Endpoint& endpoint);

}  // namespace espdiff::vmdplugin
