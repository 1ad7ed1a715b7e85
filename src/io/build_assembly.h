// build_assembly.h: biological assemblies, by gemmi.
#pragma once

#include <gemmi/cifdoc.hpp>
#include <gemmi/model.hpp>
#include <string>

namespace espdiff {

/// Checks what gemmi takes unseen from _pdbx_struct_assembly_gen.oper_expression: a range such as (1-60) becomes a list
/// of so many names, and of a product such as (1-60)(61-88) it would take the first factor alone.
/// @throws InputError (more than 10,000 operations in the file; a product in the assembly that is built)
void check_operations(const std::string& path, gemmi::cif::Block& block, const std::string& assembly);

/// Replaces the model by a biological assembly. The first copy of a chain keeps its name, others get free letters.
/// @throws InputError (no such assembly; more than kMostAtoms atoms in it), FormatError, MemoryError
void build_assembly(const std::string& path, const gemmi::Structure& structure, const std::string& name,
                    gemmi::Model& model);

}  // namespace espdiff
