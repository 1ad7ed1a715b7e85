// write_compare.h: a comparison's results as files and as a table for people.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/types.h"
#include "io/vtk/write_vtp.h"

namespace espdiff {

class AtomicFile;
struct CompareOptions;
struct CompareResult;
struct Provenance;

/// Of the tables that options ask for: ".causes.csv", ".scan.csv", ".side-chains.csv", ".field_patches.csv",
/// ".interface.csv".
std::vector<std::string> further_endings(const CompareOptions& options);

/// A file written beside the results that is the input of a role from then on; the original input stays listed under
/// ROLE_file.
struct KeptFile {
  std::string role;
  std::string ending;  ///< behind the prefix: ".source.pqr"
  std::string content;
};

/// The content of OUT.vtp. Refers to the result, which must outlast it.
class SurfaceArrays {
 public:
  SurfaceArrays(const Molecule& source, const CompareResult& result, const std::string& version);
  ~SurfaceArrays();
  SurfaceArrays(const SurfaceArrays&) = delete;
  SurfaceArrays& operator=(const SurfaceArrays&) = delete;

  VtpSurface file;

 private:
  struct Derived;
  std::unique_ptr<Derived> derived_;
};

/// Writes OUT.json (compare_json()), OUT.vtp and OUT.residues.csv; all three appear, or none and older ones stay as
/// they are.
///
/// OUT.vtp: the mapped surface in the target's frame. Point arrays source_position, displacement, path_length, normal,
/// residue_number (of the source residue; 0 where there is none) and residue_index (row of the table, from 0; -1 where
/// there is none); with potentials also potential_source, potential_target, potential_difference (target - source) and
/// sign_change. Outside a map potentials are NaN and sign_change is 0. Cell arrays corrupt, unmatched. Field data:
/// units. OUT.residues.csv: one row a source residue, in file order; empty fields where a residue has no valid surface.
/// @param output_prefix OUT; its folder must exist
/// @param source, target the molecules that `result` compares
/// @param kept   further files, see kept_structure()
/// @param beside a complete file that gets its name together with them; may be null
/// @throws IoError (a file cannot be written)
void write_compare(const std::string& output_prefix, const Molecule& source, const Molecule& target,
                   const CompareResult& result, const CompareOptions& options, Provenance provenance,
                   const std::vector<KeptFile>& kept = {}, AtomicFile* beside = nullptr);

/// What a comparison was made of, to be written beside its results: molecules as they were compared (one model, one
/// frame, a selection), and the maps that are in no file (null for those that are, or were computed).
struct KeptInputs {
  const Grid* source_map = nullptr;
  const Grid* target_map = nullptr;
};
/// What write_compare_with_inputs() writes besides the results: ".source.pqr", ...
std::vector<std::string> kept_input_endings(const KeptInputs& kept);

/// As write_compare(), with OUT.source.pqr and OUT.target.pqr and, for maps from memory, OUT.source_map.vti and
/// OUT.target_map.vti, which OUT.json then names as its inputs, by names that lie beside it: the comparison can be
/// repeated from these files, and drawn with maps and molecules.
/// @returns all files written
/// @throws IoError; InputError (a map with values that are not finite)
std::vector<std::string> write_compare_with_inputs(const std::string& output_prefix, const Molecule& source,
                                                   const Molecule& target, const CompareResult& result,
                                                   const CompareOptions& options, Provenance provenance,
                                                   const KeptInputs& kept);

}  // namespace espdiff
