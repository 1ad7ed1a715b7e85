// load_module.h: parts of the program that are loaded when they are needed, because their libraries are large.
#pragma once

#include <string>

namespace espdiff {

/// A part of the program in a file of its own, which lies in ../lib/espdiff beside the program's folder. It is compiled
/// together with the program, and what it throws is caught there.
struct ProgramModule {
  std::string file;       ///< "espdiff_vtk.so"
  std::string contents;   ///< what it has, and for what: "VTK, for pictures"
  std::string libraries;  ///< what it needs of the system: "VTK 9 (Debian: ...)"
};

/// Loads a module, once, and calls its function `espdiff_module`, which returns a pointer to a struct of functions that
/// begins with the version (kVersion).
/// @param problem receives why it cannot be used, with the remedy  @returns null then
const void* load_module(const ProgramModule& module, std::string& problem);

}  // namespace espdiff
