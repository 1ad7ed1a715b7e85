// file_kind.h: tells file formats apart by their content, so that a wrong file is called by its name.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace espdiff {

enum class FileKind {
  kUnknownText,
  kUnknownBinary,
  kAtomRecords,  ///< PDB or PQR: which of them, see looks_like_pqr()
  kMmcif,        ///< any CIF
  kGro,
  kAmberRestart,  ///< in text: a title, the number of atoms, and numbers in columns of twelve
  kMmjson,
  kBinaryCif,
  kMmtf,
  kMol2,
  kSdf,  ///< MDL's molfiles
  kPsf,
  kPrmtop,
  kTpr,  ///< GROMACS' run input
  kGromacsTopology,
  kDcd,
  kNetcdf,
  kHdf5,
  kDx,
  kCube,
  kVti,
  kVtkXml,  ///< VTK XML, but no image data
  kVtkLegacy,
  kCcp4
};

/// How many bytes recognise() needs to see at most; more do no harm.
constexpr std::size_t kRecogniseBytes = 65536;

/// The format of a file that begins with `head`.
FileKind recognise(std::string_view head);

/// As recognise(), by the file's first bytes as they stand; kUnknownText for what is no regular file, such as a pipe,
/// whose bytes can be read once.
FileKind kind_of_file(const std::string& path);

/// What GROMACS' users do instead of giving a run input or topology, as the end of a message.
inline constexpr const char* kGromacsRemedy =
    "`gmx editconf -f RUN.tpr -mead STATE.pqr` writes a PQR with the charges of a run input; give that";

/// With its article, for "this looks like ...": "an OpenDX map".
std::string describe(FileKind kind);

}  // namespace espdiff
