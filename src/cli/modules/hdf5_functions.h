// hdf5_functions.h: what the program calls of its module with HDF5.
#pragma once

#include <string>
#include <vector>

#include "ensemble/file/hdf5_writer.h"

namespace espdiff {

struct Hdf5Functions {
  const char* version;
  std::vector<WrittenDataset> (*write_by_hdf5)(const std::string& place, const std::string& path,
                                               const EnsembleHead& head);
};

}  // namespace espdiff
