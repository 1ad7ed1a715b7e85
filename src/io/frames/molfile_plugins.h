// molfile_plugins.h: VMD's file readers (molfile plugins), found and loaded.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace espdiff {

namespace molfile {
template <int Version>
struct FileFunctions;
}

/// A reader of VMD's for one file type. Lives as long as the program.
struct MolfileReader {
  std::string type;                  ///< VMD's name of the file type, such as "dcd"
  std::vector<std::string> endings;  ///< of file names, in lower case
  const molfile::FileFunctions<18>* functions = nullptr;
};

/// The folder of VMD's molfile plugins: the given one, otherwise that of $VMDDIR, of the program `vmd` on PATH, or of
/// VMD's usual places; empty if there is none.
std::string find_molfile_folder(const std::string& given = {});

/// The readers of structures and coordinates in a folder; loaded once for each folder.
/// @throws InputError (the folder has no plugins of an interface known here)
const std::vector<MolfileReader>& molfile_readers(const std::string& folder);

/// VMD's reader for a file, by the ending of its name; null if there is none.
const MolfileReader* find_molfile_reader(const std::string& folder, const std::string& path);

/// Whether a file's name ends as those of topologies and trajectories do that only VMD's readers, or MDAnalysis', read;
/// Amber's restarts and NetCDF files are read here.
bool needs_molfile_reader(const std::string& path);

/// Of options that name the folder.
constexpr const char* kMolfileFolderHelp =
    "Folder of VMD's molfile plugins, which read trajectories and topologies (that of $VMDDIR, or of the `vmd` on "
    "PATH)";
/// How to get readers, for messages.
extern const char* const kMolfileRemedy;

}  // namespace espdiff
