// pair_files.h: the files of a comparison, read again: for pages and for other programs' formats.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "io/files/read_csv.h"
#include "io/vtk/read_vtp.h"

namespace espdiff {

/// What OUT.json, OUT.vtp and OUT.residues.csv hold.
struct PairFiles {
  std::string prefix;             ///< OUT
  nlohmann::ordered_json record;  ///< OUT.json
  VtpContent surface;             ///< OUT.vtp: the mapped surface, in the target's frame
  CsvTable residues;              ///< OUT.residues.csv
  std::string unit;               ///< of potentials, such as "kT/e"; empty without potentials
};

/// A result's record of this version of its format; one without a version is older than versions, and passes.
/// @throws FormatError (another version)
void require_format_version(const nlohmann::ordered_json& record, const std::string& path);

/// A record's options as one line, "align all, domains as-needed ...", without those that are empty.
std::string options_of(const nlohmann::ordered_json& record);

/// The content of OUT.json.
/// @throws IoError, FormatError (a missing or damaged file, or one of something else), MemoryError
nlohmann::ordered_json read_comparison_record(const std::string& path);

/// @param prefix OUT
/// @throws IoError, FormatError (missing or damaged files, a surface without the potentials that were compared, another
/// version's result, files of different comparisons)
PairFiles read_pair_files(const std::string& prefix);

/// A number of each vertex that surfaces are coloured by.
struct SurfaceQuantity {
  const VtpNumbers* values;
  std::string label, unit;
  bool is_signed;  ///< values of both signs; the scale is diverging
};

/// Every point array of one component that says something about the comparison: the usual ones first. Refers to
/// `files`.
std::vector<SurfaceQuantity> surface_quantities(const PairFiles& files);

/// [vertex] indices into the residues of the source, or -1.
/// @throws FormatError (the file has no such array, or points of a residue without a row in OUT.residues.csv)
std::vector<std::int32_t> residues_of_vertices(const PairFiles& files);

/// [vertex] positions on the source's surface, superposed on the target's.
/// @throws FormatError (the file has no such array)
std::vector<Vec3d> superposed_source(const PairFiles& files);

/// The trusted triangles, and the others.
struct CountedTriangles {
  std::vector<Triangle> counted, rest;
};
CountedTriangles counted_triangles(const VtpContent& surface);

/// A column of OUT.residues.csv, "mean_slip [A]".
struct ResidueColumn {
  std::size_t index;              ///< in the table
  std::string name, unit, label;  ///< "mean_slip", "A", "Mean slip of the mapping"
};
std::vector<ResidueColumn> residue_columns(const CsvTable& residues);

/// The name of an input's file without its folder, as the user gave it where the state was prepared; the role itself if
/// there is no such input.
std::string name_of_input(const PairFiles& files, const std::string& role);

/// "mutant.pqr against wild.pqr"
std::string title_of(const PairFiles& files);

/// The verdict in one line, in the words of the record, its reasons, and the parts that are not trusted.
struct Verdict {
  bool trustworthy;
  std::string text;
  std::vector<std::string> reasons, parts, warnings;
};
Verdict verdict_of(const PairFiles& files);

/// Names and texts: command, program, inputs with their SHA-256, options, how to cite.
std::vector<std::pair<std::string, std::string>> provenance_of(const PairFiles& files);

}  // namespace espdiff
