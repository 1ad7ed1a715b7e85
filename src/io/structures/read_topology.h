// read_topology.h: charges from topology files: PSF (CHARMM, NAMD) and prmtop (Amber).
#pragma once

#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// The atoms of a topology, in its order.
struct Topology {
  std::string path, sha256;
  std::vector<std::string> names;  ///< of atoms
  std::vector<float> charges;      ///< elementary charges
  std::vector<float> radii;        ///< Angstrom: prmtop's intrinsic Born radii; empty for a PSF
};

/// Reads a PSF (also EXT, XPLOR, NAMD) or a prmtop, distinguished by content. Charges of a prmtop are divided
/// by 18.2223.
/// @throws IoError, InputError (neither of them), FormatError (with line: sections missing, cut or malformed)
Topology read_topology(const std::string& path);

/// The atoms of a PSF or prmtop, all at the origin, with residues and charges; radii are a prmtop's, otherwise by
/// element. A prmtop's residues have numbers from 1, and are chains A, B, ... where no bonds join its peptides or
/// nucleic acids.
/// @throws as read_topology()
Molecule read_topology_atoms(const std::string& path);

/// Gives a molecule the charges (and radii, if any) of a topology that lists the same atoms in the same order.
/// @param everything all atoms of the file
/// @throws InputError (other numbers of atoms, another atom name, with the first of them)
void take_topology(Molecule& everything, const Topology& topology);

}  // namespace espdiff
