// medoid.h: the frame in the middle of an ensemble.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/progress.h"
#include "base/types.h"

namespace espdiff {

/// How many frames are compared with each other at most.
constexpr std::size_t kMostMedoidFrames = 200;

/// The frame of the least mean RMSD to the others, after superposition of the atoms that all of them share with the
/// first one. With more than kMostMedoidFrames frames, of as many that are evenly spread. Hydrogens do not count.
/// @param read a frame of all; its atoms must pair with the first one's, as pair_atoms() does. One without atoms, which
///             could not be read, is left out
/// @returns the frame's number; of equal ones the first
/// @throws as `read` and pair_atoms(); InputError (fewer than three common atoms)
std::size_t find_medoid(std::size_t n_frames, const std::function<Molecule(std::size_t)>& read,
                        const Progress& progress);

}  // namespace espdiff
