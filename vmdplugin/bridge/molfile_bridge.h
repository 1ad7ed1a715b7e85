// molfile_bridge.h: espdiff's file types for VMD: volumes through memory both ways, and VTI files.
#pragma once

#include <string>
#include <vector>

#include "io/frames/molfile_abi.h"
#include "volume_store.h"

namespace espdiff {

// File types of VMD. For the first two a "file" is a name in the volume store; nothing is written to disk.
inline constexpr const char* kVolumeWriter = "espdiffvolume";  ///< `animate write espdiffvolume NAME ... volsets K MOL`
inline constexpr const char* kVolumeReader = "espdiffmap";     ///< `mol addfile NAME type espdiffmap`
inline constexpr const char* kVtiReader = "vti";               ///< in builds with VTK

/// Offers the file types to VMD, newest version of its plugin interface first, and stays with the version accepted.
/// VMD ignores the return values of writers, so callers must check whether the volume is in the store.
/// A volume written keeps its values bit for bit (NaN too), its grid (the origin is the first point), the unit that its
/// name says, as PMEPot's "PME potential (kT/e, T=300K)" does, and that name; one with fewer than 2 points along an
/// axis or without a volume is refused. Opening a name for writing removes what was under it. What fails is said on
/// VMD's console in one line that begins with "espdiff) ".
/// @returns molfile::kSuccess, or molfile::kError when no version was accepted
int register_plugins(void* registrar, molfile::RegisterCallback callback) noexcept;

/// The accepted version of VMD's plugin interface; 0 before that, and outside of VMD.
int accepted_abi();

}  // namespace espdiff
