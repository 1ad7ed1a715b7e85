// write_script.h: scripts that load an exported surface and its residues into another program.
#pragma once

#include <ostream>
#include <string>

#include "export/exported_result.h"

namespace espdiff {

/// What a script loads: files in its own folder.
struct ScriptFiles {
  std::string mesh;       ///< OUT.ply or OUT.glb, without folder
  std::string structure;  ///< OUT.residues.pdb or OUT.residues.cif, without folder; may be empty
};

/// Writes a script of exports/ with its placeholders filled in: `@NAME@` as a string of Python (and JSON), or for
/// ChimeraX as its commands read a word.
/// @param script "chimerax.cxc", "pymol.py" or "blender.py"
/// @throws InputError (a name of a file that is not UTF-8, or that ChimeraX's commands cannot hold)
void write_script(std::ostream& out, const std::string& script, const ExportedResult& result, const ScriptFiles& files);

}  // namespace espdiff
