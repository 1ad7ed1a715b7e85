// residue_values.h: what a comparison says of each residue, by name, and as a PDB file that other programs colour by.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/quantity.h"
#include "base/types.h"

namespace espdiff {

class AtomicFile;
struct CompareResult;

/// What a residue adds to the first reading whose causes were asked for.
constexpr const char* kContribution = "contribution";

/// The quantities of a residue: `share`, its part of the sum of |difference| times area over all residues (0 to 1),
/// `contribution`, and the names of the metrics that it has.
std::vector<std::string> residue_quantities();

/// @param fields that are compared, whose quantities there are besides: hydrophobicity_mean_source
/// @throws InputError with those there are
void require_residue_quantity(const std::string& name, const std::vector<FieldRequest>& fields = {});
/// mean_abs_difference, or without potentials mean_displacement_A.
std::string usual_residue_quantity(const CompareResult& result);

/// [residue] of the source; NaN where it has no surface that is counted.
/// @throws InputError (unknown name, with those there are; one of potentials where there are none; a contribution
/// without causes)
std::vector<double> residue_values(const CompareResult& result, const std::string& quantity);
/// "kT/e", "A", or empty.
std::string residue_unit(const CompareResult& result, const std::string& quantity);

/// Writes the source with the quantity of each atom's residue as B factor (write_pdb()).
/// @throws as residue_values(), write_pdb(), IoError
/// The first form leaves it to the caller to commit.
void write_residue_pdb(AtomicFile& file, const Molecule& source, const CompareResult& result,
                       const std::string& quantity);
void write_residue_pdb(const std::string& path, const Molecule& source, const CompareResult& result,
                       const std::string& quantity);

}  // namespace espdiff
