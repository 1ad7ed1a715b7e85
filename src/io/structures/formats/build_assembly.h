// build_assembly.h: biological assemblies, by gemmi.
#pragma once

#include <cstddef>
#include <gemmi/cifdoc.hpp>
#include <gemmi/model.hpp>
#include <string>
#include <string_view>

namespace espdiff {

/// Checks what gemmi takes unseen from _pdbx_struct_assembly_gen.oper_expression: a range such as (1-60) becomes a list
/// of so many names, and of a product such as (1-60)(61-88) it would take the first factor alone.
/// @returns the number of operations of the assembly that is built
/// @throws InputError (more than 10,000 operations in the file; a product in the assembly that is built)
std::size_t check_operations(const std::string& path, gemmi::cif::Block& block, const std::string& assembly);

/// The same of REMARK 350 in PDB files: gemmi leaves out an operation that lacks a row, and reads words as zero.
/// @throws InputError (rows of the assembly that is built are incomplete, or out of order, or not of numbers)
std::size_t check_biomt(const std::string& path, std::string_view remarks, const std::string& assembly);

/// Replaces the model by a biological assembly. The first copy of a chain keeps its name, others get free letters.
/// @param n_operations that the file names
/// @throws InputError (no such assembly; operations that are not described, or no rotations; no atoms, more than
///         kMostAtoms, or atoms that are too far apart), FormatError, MemoryError
void build_assembly(const std::string& path, const gemmi::Structure& structure, const std::string& name,
                    std::size_t n_operations, gemmi::Model& model);

}  // namespace espdiff
