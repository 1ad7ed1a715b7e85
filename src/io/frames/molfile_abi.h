// molfile_abi.h: the layouts that VMD's molfile plugin interface gives to plugins, atoms, frames and volumes, by
// version.
#pragma once

#include <cstddef>

namespace espdiff::molfile {

inline constexpr int kSuccess = 0;
inline constexpr int kError = -1;
inline constexpr int kNoAtoms = 0;        ///< returned by open_file_read for files with volumes only
inline constexpr int kUnknownAtoms = -1;  ///< the same, for files of coordinates that do not say how many
inline constexpr int kEndOfFile = -1;
inline constexpr const char* kPluginType = "mol file reader";  ///< writers are of this type, too

/// The versions known here, newest first. VMD takes plugins of its own version only, and has one: 18 is that of 1.9.4,
/// with which all of this was tried. 17 has no `read_timestep_pagealign_size`; 16 (2012) also has no `_ex` functions
/// and no has_scalar, has_gradient, has_variance.
inline constexpr int kVersions[] = {18, 17, 16};

/// The head of every plugin. VMD keeps pointers to it and to all strings.
struct PluginHead {
  int abiversion = 0;
  const char* type = kPluginType;
  const char* name = nullptr;        ///< file type, as after `mol new ... type`
  const char* prettyname = nullptr;  ///< in menus
  const char* author = nullptr;
  int majorv = 0;
  int minorv = 0;
  int is_reentrant = 0;
};

/// Returns kSuccess if VMD accepts the plugin or has one of this name and version; kError if it refuses the version.
using RegisterCallback = int (*)(void* registrar, PluginHead* plugin);

/// One atom of read_structure(); texts end with a zero.
struct AtomRecord {
  char name[16], type[16], resname[8];
  int resid;
  char segid[8], chain[2], altloc[2], insertion[2];
  float occupancy, bfactor, mass, charge, radius;
  int atomicnumber;
};
/// Which optional members read_structure() has set.
enum AtomFlags { kHasInsertion = 0x1, kHasCharge = 0x10, kHasRadius = 0x20 };

/// One frame. Lengths in Angstrom, angles in degrees.
struct Timestep {
  float* coords = nullptr;  ///< x y z of each atom, to be filled
  float* velocities = nullptr;
  float a = 0, b = 0, c = 0, alpha = 90, beta = 90, gamma = 90;
  double physical_time = 0;
};

/// One volume. Axes are whole edges: direction times (number of points - 1) times spacing; values x fastest.
template <int Version>
struct Volume {
  char dataname[256];  ///< not ended by a zero when VMD writes a name that fills it
  float origin[3];     ///< the first grid point
  float xaxis[3], yaxis[3], zaxis[3];
  int xsize, ysize, zsize;  ///< grid points
  int has_scalar, has_gradient, has_variance;
  int has_color;

  void mark_as_scalar() { has_scalar = 1; }
};

template <>
struct Volume<16> {
  char dataname[256];
  float origin[3];
  float xaxis[3], yaxis[3], zaxis[3];
  int xsize, ysize, zsize;
  int has_color;

  void mark_as_scalar() {}  // it can be nothing else
};

// The functions of a plugin, in VMD's order; unused ones are null.

template <int Version>
struct FileFunctions {
  const char* filename_extension = "";
  void* (*open_file_read)(const char* path, const char* type, int* n_atoms) = nullptr;
  int (*read_structure)(void* handle, int* flags, AtomRecord* atoms) = nullptr;
  void* read_bonds = nullptr;
  int (*read_next_timestep)(void* handle, int n_atoms, Timestep* frame) = nullptr;
  void (*close_file_read)(void* handle) = nullptr;
  void* (*open_file_write)(const char* path, const char* type, int n_atoms) = nullptr;
  void* write_structure = nullptr;  // VMD crashes on one that fails, or that it calls for a volume without atoms
  void* write_timestep = nullptr;
  void (*close_file_write)(void* handle) = nullptr;
  int (*read_volumetric_metadata)(void* handle, int* n_sets, Volume<Version>** metadata) = nullptr;
  int (*read_volumetric_data)(void* handle, int set, float* values, float* colours) = nullptr;
};

template <int Version>
struct OtherFunctions {
  void* read_rawgraphics = nullptr;
  void* read_molecule_metadata = nullptr;
  void* write_bonds = nullptr;
  int (*write_volumetric_data)(void* handle, Volume<Version>* metadata, float* values, float* colours) = nullptr;
};

struct AngleFunctions {
  void* read_angles = nullptr;
  void* write_angles = nullptr;
  void* read_qm_metadata = nullptr;
  void* read_qm_rundata = nullptr;
};

struct TimestepFunctions {
  void* read_timestep = nullptr;
  void* read_timestep_metadata = nullptr;
  void* read_qm_timestep_metadata = nullptr;
  /// Set by VMD where its console is a window; null: print to the terminal.
  int (*print_to_console)(int level, const char* text) = nullptr;
};

template <int Version>
struct Plugin {
  static_assert(Version == 18, "a version of the interface that is not known here");
  PluginHead head;
  FileFunctions<18> file;
  void* read_volumetric_data_ex = nullptr;
  OtherFunctions<18> other;
  void* write_volumetric_data_ex = nullptr;
  AngleFunctions angles;
  void* read_timestep_pagealign_size = nullptr;
  TimestepFunctions timesteps;
};

template <>
struct Plugin<17> {
  PluginHead head;
  FileFunctions<17> file;
  void* read_volumetric_data_ex = nullptr;
  OtherFunctions<17> other;
  void* write_volumetric_data_ex = nullptr;
  AngleFunctions angles;
  TimestepFunctions timesteps;
};

template <>
struct Plugin<16> {
  PluginHead head;
  FileFunctions<16> file;
  OtherFunctions<16> other;
  AngleFunctions angles;
  TimestepFunctions timesteps;
};

// 64-bit systems only: the offsets below are those of a C compiler for VMD's declarations.
inline constexpr std::size_t kPointer = 8;
static_assert(sizeof(void*) == kPointer, "VMD's 32-bit builds are not supported");
static_assert(sizeof(AtomRecord) == 84 && offsetof(AtomRecord, occupancy) == 60 && sizeof(Timestep) == 48);
static_assert(sizeof(PluginHead) == 7 * kPointer && offsetof(PluginHead, majorv) == 5 * kPointer);
static_assert(sizeof(FileFunctions<18>) == 12 * kPointer && sizeof(OtherFunctions<18>) == 4 * kPointer);
static_assert(offsetof(Plugin<18>, file.read_volumetric_data) == 18 * kPointer);
static_assert(offsetof(Plugin<18>, other.write_volumetric_data) == 23 * kPointer);
static_assert(offsetof(Plugin<17>, other.write_volumetric_data) == 23 * kPointer);
static_assert(offsetof(Plugin<16>, other.write_volumetric_data) == 22 * kPointer);
static_assert(offsetof(Plugin<18>, timesteps.print_to_console) == 33 * kPointer && sizeof(Plugin<18>) == 34 * kPointer);
static_assert(sizeof(Plugin<17>) == 33 * kPointer && sizeof(Plugin<16>) == 31 * kPointer);
static_assert(sizeof(Volume<18>) == 332 && sizeof(Volume<17>) == 332 && sizeof(Volume<16>) == 320);
static_assert(offsetof(Volume<18>, xsize) == 304 && offsetof(Volume<18>, has_color) == 328);

}  // namespace espdiff::molfile
