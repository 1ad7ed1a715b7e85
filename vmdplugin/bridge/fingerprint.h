// fingerprint.h: hashes of molecules and maps from memory, for a result's provenance.
#pragma once

#include <string>

namespace espdiff {

struct Grid;
struct Molecule;

/// SHA-256 of positions, radii and charges.
std::string fingerprint(const Molecule& molecule);
/// SHA-256 of lattice and values. Equal maps have equal hashes: members are hashed, not the bytes between them.
std::string fingerprint(const Grid& map);

}  // namespace espdiff
