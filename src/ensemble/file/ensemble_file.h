// ensemble_file.h: the columns of an ensemble in one HDF5 file, which survives its writer's death.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compare/template_mapping.h"
#include "ensemble/frames/ensemble_plan.h"

namespace espdiff {

/// A frame's numbers besides its values.
struct EnsembleFrame {
  double rmsd_A = 0, unmatched_template = 0, unmatched_frame = 0, distance_A = 0, same_residue_area_fraction = 0;
  double mean_potential = 0;  ///< over the template's area
  bool trustworthy = false;
  std::string note;  ///< why it is not trustworthy, or the error of a frame that could not be mapped; cut at 200 bytes
};

/// An HDF5 file in the VTKHDF layout (PolyData with steps), which ParaView, VTK and h5py read: the template's surface,
/// `potential`, and where it is `trusted` (1, otherwise 0), both [frame][vertex], chunked by frame. The group `espdiff`
/// has the plan and the frames' numbers.
///
/// All space is laid out when the file is made, metadata first; it is sparse until it is written. After that no
/// metadata changes: a frame is written to its place, and its checksum after it. So the bytes of a finished file do not
/// depend on interruptions, order or shards; a frame that was cut off, or damaged later, lacks its checksum and is
/// computed again. One process at a time writes a file (flock).
class EnsembleFile {
 public:
  /// Makes a file beside its place and reads it back; then it gets its name. Replaces an older one that no run writes.
  /// @param fill writes frames before that; none: frames are written later, in place
  /// @throws IoError (cannot be written, or another run is writing it), and as `fill`
  static void create(const std::string& path, const EnsemblePlan& plan, const TemplateSurface& surface,
                     const std::function<void(EnsembleFile&)>& fill = {});
  /// Opens a file and checks every frame. A file that was cut off is extended again.
  /// @throws IoError (missing, unreadable, another process writes it), FormatError (not an ensemble file; damaged
  /// beyond the frames)
  EnsembleFile(const std::string& path, bool for_writing);
  EnsembleFile(EnsembleFile&&) noexcept;
  ~EnsembleFile();

  const std::string& path() const;
  const EnsemblePlan& plan() const;
  const TemplateSurface& surface() const;
  std::size_t n_vertices() const;

  /// Whether the frame is there, and whole.
  bool has(std::size_t frame) const;
  std::size_t n_done() const;
  /// Whether it says where the mapping onto its frames is trusted; files of earlier versions do not.
  bool has_trust() const;
  /// Frames that were begun or damaged: they have a checksum, which is wrong.
  std::size_t n_damaged() const;
  /// @param values [vertex]  @param trusted [vertex] nonzero where the mapping is trusted; empty: everywhere
  /// @throws IoError (disk full), FormatError (a potential beyond 10^9)
  void write(std::size_t frame, const std::vector<float>& values, const EnsembleFrame& numbers,
             const std::vector<std::uint8_t>& trusted = {});
  /// @throws IoError
  EnsembleFrame numbers(std::size_t frame) const;
  /// Values of the vertices from `begin` to `end`; NaN where the mapping onto the frame is not trusted. @throws IoError
  void read_values(std::size_t frame, std::size_t begin, std::size_t end, float* values) const;
  /// The same, trusted or not. @throws IoError
  void read_all_values(std::size_t frame, std::size_t begin, std::size_t end, float* values) const;
  /// Closes the file. @throws IoError (what was written has not arrived)
  void finish();
  /// From now on the file's frames are these, in this order, under another plan; it cannot be written any more.
  /// @param frames [frame of the plan] of the file, each at most once
  void choose(EnsemblePlan plan, std::vector<std::size_t> frames);
  /// The place of a frame among those of the run that wrote the file; another number only after choose().
  std::size_t place_in_run(std::size_t frame) const;
  /// Copies a whole frame of another file of the same plan, bit for bit.
  void copy(std::size_t frame, const EnsembleFile& from);

 private:
  EnsembleFile();

  struct Contents;
  std::unique_ptr<Contents> contents_;
};

/// Whether the file is there, and one that HDF5 wrote.
bool is_hdf5_file(const std::string& path);

}  // namespace espdiff
