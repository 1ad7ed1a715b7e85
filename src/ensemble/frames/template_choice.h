// template_choice.h: what a structure is as a template, for ensembles and for matrices.
#pragma once

#include <string>

#include "base/progress.h"
#include "base/types.h"

namespace espdiff {

struct InputOptions;
struct LoadedState;
struct StructureOptions;

/// A number of a frame or variant: digits only.
bool is_number(const std::string& text);

/// A structure file as a template; it needs no charges. @throws as StructureFile and load_state()
LoadedState read_template(const std::string& path, const StructureOptions& structure, const InputOptions& options,
                          const Progress& progress);

/// Of the atoms that make its surface: names, residues, positions, radii.
std::string sha256_of_template(const Molecule& molecule);

}  // namespace espdiff
