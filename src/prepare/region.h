// region.h: the part of the source that results are reported for as well.
#pragma once

#include <cstdint>
#include <vector>

#include "base/molecule/input_options.h"
#include "base/molecule/surface_parts.h"
#include "base/types.h"

namespace espdiff {

/// The residues of the source's region. A residue belongs to it with any selected atom, or any atom within the
/// distance. Atoms that the region is near to are sought in the source's file, before its selection; if it has none of
/// them, in the target's, whose region is then carried over by the pairing of residues.
/// @param whole_source, whole_target the files' atoms before the selection; of molecules in no file, the molecules
/// @returns [source residue] nonzero in the region; empty without a region
/// @throws InputError (a selection of no atoms, or a region without residues, with what there is)
std::vector<std::uint8_t> region_residues(const Molecule& source, const Molecule& whole_source, const Molecule& target,
                                          const Molecule& whole_target, const InputOptions& options);

/// The region and the patches of a source.
/// @throws InputError as region_residues(); a patch that selects no atom
SurfaceParts source_parts(const Molecule& source, const Molecule& whole_source, const Molecule& target,
                          const Molecule& whole_target, const InputOptions& options,
                          const std::vector<SurfacePatch>& known = {});

/// The patches alone: each patch's residues have any selected atom. Patches of earlier results are read.
/// @param known the same patches of another molecule: earlier results among them are not read again
/// @throws InputError (a selection of no atoms), as read_earlier_patch()
std::vector<SurfacePatch> patches_on(const Molecule& source, const std::vector<PatchRequest>& requests,
                                     const std::vector<SurfacePatch>& known = {});

/// Whether a molecule has atoms that the region is near to.
bool has_region_atoms(const Molecule& whole, const InputOptions& options);

/// The same within one molecule; of a molecule that is in no file `whole` is the molecule itself.
std::vector<std::uint8_t> region_within(const Molecule& molecule, const Molecule& whole,
                                        const std::vector<bool>& near_to, double distance_A);

}  // namespace espdiff
