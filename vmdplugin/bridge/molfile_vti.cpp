// molfile_vti.cpp: the volumes that VMD sees in a VTI file.
#include "molfile_vti.h"

#include "base/error.h"
#include "io/grids/read_vti.h"

namespace espdiff {

std::vector<StoredVolume> read_vti_volumes(const std::string& path) {
  const VtkXmlFile file(path, kImageData);
  const std::vector<std::string> names = list_vti_scalars(file);
  if (names.empty()) {
    throw InputError(path + ": has no point array with one number a point; VMD can show nothing else of a VTI file");
  }
  std::vector<StoredVolume> volumes;
  volumes.reserve(names.size());
  for (const std::string& name : names) {
    volumes.push_back({read_vti(file, GridOptions{name}), name});
  }
  return volumes;
}

}  // namespace espdiff
