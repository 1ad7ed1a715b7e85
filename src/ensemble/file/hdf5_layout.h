// hdf5_layout.h: where an ensemble file keeps what; made by HDF5, then read and written in place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"
#include "ensemble/file/hdf5_writer.h"

namespace espdiff {

class OpenFile;

struct TemplateSurface;

/// Numbers of a frame, in the order of the file.
const std::vector<std::string>& frame_columns();

/// Byte offsets in the file.
struct EnsembleLayout {
  std::size_t n_frames = 0, n_vertices = 0;
  std::vector<std::uint64_t> values;   ///< [frame] of [vertex] 32-bit floats
  std::vector<std::uint64_t> trusted;  ///< [frame] of [vertex] bytes, 0 or 1; empty in files of earlier versions
  std::uint64_t numbers = 0;           ///< [frame][column] 64-bit floats
  std::uint64_t notes = 0;             ///< [frame][kNoteBytes] text, filled up with zeros
  std::uint64_t checksums = 0;         ///< [frame] 64 bits; 0: not written
};

/// Writes the file's metadata, plan and template, reserves the rest, and reads back what it wrote.
/// @param file  new and open, to read and write  @param place leads to it  @param path for messages
/// @throws IoError
void make_hdf5_file(OpenFile& file, const std::string& place, const std::string& path, const std::string& plan,
                    const TemplateSurface& surface, const std::string& unit, std::size_t n_frames);

/// What a file is made of.
struct EnsembleContents {
  std::string plan;
  EnsembleLayout layout;
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> residue;
};
/// @param file open for reading
/// @throws FormatError (not an ensemble file; damaged anywhere but in the frames)
EnsembleContents open_hdf5_file(const OpenFile& file, const std::string& path);
/// Only what stands before the frames; for a file that lacks its end.
/// @throws FormatError (not an ensemble file; its description or template is damaged or missing)
void check_ensemble_head(const OpenFile& file, const std::string& path);

/// The size that a file should have, by its first bytes; 0 if it is no HDF5 file that we wrote.
std::uint64_t intended_size(const std::string& path);

}  // namespace espdiff
