// molfile_vti.h: the volumes that VMD sees in a VTI file.
#pragma once

#include <string>
#include <vector>

#include "volume_store.h"

namespace espdiff {

/// All scalar point arrays of a VTI file, each with its array's name as dataname.
/// @throws what read_vti() throws; InputError when there is none
std::vector<StoredVolume> read_vti_volumes(const std::string& path);

}  // namespace espdiff
