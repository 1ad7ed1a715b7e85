// dcd_frames.h: frames of a trajectory from PSF and DCD files; test input for the benchmarks only, not a reader of
// espdiff.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff_bench {

/// Atoms, residues and charges of a CHARMM, X-PLOR or NAMD PSF file. Radii by element; the element follows from the
/// mass (H, C, N, O, P, S), otherwise from the name. Positions are all zero.
/// @throws IoError, FormatError
espdiff::Molecule read_psf(const std::string& path);

/// The molecule with the positions of one frame, in Angstrom.
///
/// Reads little-endian DCD files with 4-byte record marks, with or without unit cell and fourth coordinate. The file's
/// length gives the number of frames, because the header's is often wrong.
/// @param frame from 0
/// @throws IoError; FormatError for other formats, another number of atoms, or a truncated frame; InputError for a
/// frame that does not exist
espdiff::Molecule read_frame(const espdiff::Molecule& psf, const std::string& dcd_path, std::size_t frame);

}  // namespace espdiff_bench
