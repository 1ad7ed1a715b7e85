// file_kind.cpp: the marks by which file formats are recognised.
#include "io/files/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "io/text/column_lines.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

bool starts_with(std::string_view text, std::string_view prefix) { return text.substr(0, prefix.size()) == prefix; }
bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// Formats that are not text; kUnknownText when it is none of them.
FileKind recognise_binary(std::string_view head) {
  constexpr std::size_t kCcp4MarkAt = 208;
  if (head.size() > kCcp4MarkAt + 4 && head.substr(kCcp4MarkAt, 4) == "MAP ") return FileKind::kCcp4;
  // A Fortran record of 84 bytes that starts with CORD; the record mark has 4 or 8 bytes, in either byte order.
  if (head.size() > 12 && (head.substr(4, 4) == "CORD" || head.substr(8, 4) == "CORD")) return FileKind::kDcd;
  if (starts_with(head, "CDF\x01") || starts_with(head, "CDF\x02")) return FileKind::kNetcdf;
  if (starts_with(head, "\x89HDF")) return FileKind::kHdf5;
  constexpr std::size_t kTprMarkAt = 8;  // behind two lengths
  if (head.size() > kTprMarkAt && head[0] == '\0' && starts_with(head.substr(kTprMarkAt), "VERSION "))
    return FileKind::kTpr;
  const std::string_view front = head.substr(0, 512);
  const bool is_message_pack = !front.empty() && (static_cast<unsigned char>(front[0]) & 0xf0U) == 0x80;
  const bool is_big_map = !front.empty() && static_cast<unsigned char>(front[0]) == 0xde;
  if (is_message_pack || is_big_map) {
    if (contains(front, "dataBlocks") || contains(front, "encoder")) return FileKind::kBinaryCif;
    if (contains(head, "mmtfVersion")) return FileKind::kMmtf;
  }
  return FileKind::kUnknownText;
}

/// Words that begin the records of PDB files, in full or up to where numbers are glued to them.
bool is_pdb_record(std::string_view line) {
  static constexpr std::array kRecords = {
      "HEADER", "OBSLTE", "TITLE ", "SPLIT ", "CAVEAT", "COMPND", "SOURCE", "KEYWDS", "EXPDTA", "NUMMDL", "MDLTYP",
      "AUTHOR", "REVDAT", "SPRSDE", "JRNL  ", "REMARK", "DBREF",  "SEQADV", "SEQRES", "MODRES", "HET   ", "HETNAM",
      "HELIX ", "SHEET ", "SSBOND", "LINK  ", "CRYST1", "ORIGX",  "SCALE",  "MTRIX",  "MODEL ", "ANISOU"};
  return std::any_of(kRecords.begin(), kRecords.end(), [&](const char* record) { return starts_with(line, record); });
}

bool is_atom_line(std::string_view line) {
  const std::string start = lower_case(line.substr(0, 6));
  return start == "hetatm" || (start.size() > 4 && starts_with(start, "atom") && (start[4] == ' ' || start[4] == '\t'));
}

/// Cube: two lines of comment, then atom count and origin, then three lines with a count and a vector each.
bool is_cube(std::string_view head) {
  const std::string unused_path;
  TextCursor cursor(head, unused_path);
  cursor.rest_of_line();
  cursor.rest_of_line();
  for (int i = 0; i < 4; ++i) {
    const auto words = split_words(cursor.rest_of_line());
    if (words.size() != 4 && !(i == 0 && words.size() == 5)) return false;
    long long count = 0;
    double number = 0;
    if (!parse_integer(words[0], count)) return false;
    for (std::size_t j = 1; j < 4; ++j) {
      if (!parse_number(words[j], number)) return false;
    }
  }
  return true;
}

/// GRO: a title, the number of atoms, then lines of residue number, two names and atom number in columns of five, and
/// coordinates with points.
bool is_gro(std::string_view head) {
  ColumnLines lines{head};
  lines.next();
  long long number = 0;
  if (!parse_integer(trimmed(lines.next()), number) || number < 1) return false;
  const std::string_view atom = lines.next();
  constexpr std::size_t kWidth = 5;
  return atom.size() > 4 * kWidth && parse_integer(trimmed(atom.substr(0, kWidth)), number) &&
         parse_integer(trimmed(atom.substr(3 * kWidth, kWidth)), number) && contains(atom.substr(4 * kWidth), ".");
}

/// Amber restart: a title, the number of atoms with at most time and temperature, then columns of twelve whose points
/// stand over each other.
bool is_amber_restart(std::string_view head) {
  constexpr std::size_t kWidth = 12, kPointAt = 4;
  ColumnLines lines{head};
  lines.next();
  const auto words = split_words(lines.next());
  long long n = 0;
  double number = 0;
  const auto is_number = [&](std::string_view word) { return parse_number(word, number); };
  if (words.empty() || words.size() > 3 || !parse_integer(words[0], n) || n < 1 ||
      !std::all_of(words.begin(), words.end(), is_number))
    return false;
  const std::string_view numbers = lines.next();
  for (std::size_t at = 0; at < 3 * kWidth; at += kWidth) {
    const std::string_view field = numbers.substr(std::min(at, numbers.size()), kWidth);
    if (field.size() != kWidth || field[kPointAt] != '.' || !is_number(trimmed(field))) return false;
  }
  return true;
}

/// MDL's molfile: three lines of title, then counts that end with the version.
bool is_sdf(std::string_view head) {
  ColumnLines lines{head};
  for (int i = 0; i < 3; ++i) lines.next();
  const std::string_view counts = trimmed(lines.next());
  constexpr std::size_t kWidth = 5;
  const std::string_view version = counts.substr(counts.size() - std::min(counts.size(), kWidth));
  return version == "V2000" || version == "V3000";
}

/// By the first line that says something.
FileKind recognise_first_line(std::string_view line) {
  const std::string lower = lower_case(line);
  if (starts_with(line, "PSF")) return FileKind::kPsf;
  if (starts_with(line, "%VERSION")) return FileKind::kPrmtop;
  if (starts_with(lower, "data_")) return FileKind::kMmcif;
  if (starts_with(line, "{")) return FileKind::kMmjson;
  if (starts_with(line, "@<TRIPOS>")) return FileKind::kMol2;
  if (starts_with(lower, "object") && contains(" \t", lower.substr(6, 1)) && lower.size() > 6)
    return FileKind::kDx;  // its other words may stand on the next lines
  if (is_atom_line(line) || is_pdb_record(line)) return FileKind::kAtomRecords;
  return FileKind::kUnknownText;
}

}  // namespace

FileKind recognise(std::string_view head) {
  const FileKind binary = recognise_binary(head);
  if (binary != FileKind::kUnknownText) return binary;
  if (starts_with(head, "# vtk DataFile")) return FileKind::kVtkLegacy;
  const std::size_t vtk = head.find("<VTKFile");
  if (vtk != std::string_view::npos) {
    const std::string_view tag = head.substr(vtk, head.find('>', vtk) - vtk);
    return contains(tag, "\"ImageData\"") || contains(tag, "'ImageData'") ? FileKind::kVti : FileKind::kVtkXml;
  }
  // Only now: a VTI file may have raw values behind its text.
  if (contains(head, std::string_view("\0", 1))) return FileKind::kUnknownBinary;
  if (starts_with(head, "\xef\xbb\xbf")) return recognise(head.substr(3));  // byte order mark
  if (is_cube(head)) return FileKind::kCube;                                // before its title is taken for something
  if (is_gro(head)) return FileKind::kGro;
  if (is_amber_restart(head)) return FileKind::kAmberRestart;
  if (is_sdf(head)) return FileKind::kSdf;
  const std::string unused_path;
  TextCursor cursor(head, unused_path);
  bool first = true;
  while (!cursor.at_end()) {
    const std::string_view line = cursor.rest_of_line();
    if (starts_with(line, "#")) continue;
    const FileKind kind = recognise_first_line(line);
    if (first && kind != FileKind::kUnknownText) return kind;
    if (starts_with(line, "[ ") && trimmed(line).back() == ']') return FileKind::kGromacsTopology;
    // A title or the like may stand above the atoms.
    if (is_atom_line(line)) return FileKind::kAtomRecords;
    first = false;
  }
  return FileKind::kUnknownText;
}

FileKind kind_of_file(const std::string& path) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(path, missing)) return FileKind::kUnknownText;
  std::string head(kRecogniseBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return recognise(head);
}

std::string describe(FileKind kind) {
  switch (kind) {
    case FileKind::kAtomRecords: return "a PDB or PQR structure";
    case FileKind::kMmcif: return "an mmCIF file";
    case FileKind::kGro: return "a GROMACS GRO structure";
    case FileKind::kAmberRestart: return "an Amber restart";
    case FileKind::kMmjson: return "a JSON (mmJSON) file";
    case FileKind::kBinaryCif: return "a BinaryCIF structure";
    case FileKind::kMmtf: return "an MMTF structure";
    case FileKind::kMol2: return "a Tripos mol2 structure";
    case FileKind::kSdf: return "an SDF structure";
    case FileKind::kPsf: return "a PSF topology";
    case FileKind::kPrmtop: return "an Amber prmtop topology";
    case FileKind::kTpr: return "a GROMACS run input (TPR)";
    case FileKind::kGromacsTopology: return "a GROMACS topology";
    case FileKind::kDcd: return "a DCD trajectory";
    case FileKind::kNetcdf: return "a NetCDF file";
    case FileKind::kHdf5: return "an HDF5 file";
    case FileKind::kDx: return "an OpenDX map";
    case FileKind::kCube: return "a Gaussian cube map";
    case FileKind::kVti: return "a VTI map";
    case FileKind::kVtkXml: return "a VTK XML file other than image data";
    case FileKind::kVtkLegacy: return "a legacy VTK file";
    case FileKind::kCcp4: return "a CCP4/MRC map";
    case FileKind::kUnknownBinary: return "a binary file of unknown format";
    case FileKind::kUnknownText: return "a text file of unknown format";
  }
  return "a file of unknown format";
}

}  // namespace espdiff
