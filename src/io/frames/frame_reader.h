// frame_reader.h: a reader of topologies and trajectories that takes the place of VMD's plugins where they are absent.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "base/types.h"
#include "io/structures/coordinate_file.h"

namespace espdiff {

/// A reader that the surrounding program has; the Python package gives MDAnalysis.
struct FrameReader {
  std::string name;    ///< for doctor: "MDAnalysis 2.7.0"
  std::string remedy;  ///< how to get it, as the end of a message
  /// The atoms of a topology, all at the origin, as read_molfile_atoms().
  std::function<Molecule(const std::string& path)> read_atoms{};
  /// A trajectory of so many atoms. @throws IoError, InputError (another number of atoms), FormatError
  std::function<std::unique_ptr<CoordinateFile>(const std::string& path, std::size_t n_atoms)>
      open{};  ///< none: it is not there
};

/// Null without one; the program's, from its start to its end.
const FrameReader* frame_reader();
/// How to get one, as the end of a message; empty where the program knows none.
const std::string& frame_reader_remedy();
void set_frame_reader(FrameReader reader);

}  // namespace espdiff
