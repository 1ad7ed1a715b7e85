// run_record.h: the inputs of a comparison from OUT.json, as far as pictures and other files of a result need them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/types.h"
#include "base/vector.h"

namespace espdiff {

/// An input as recorded by the comparison.
struct RecordedInput {
  std::string path;    ///< empty if there was none, or it was computed in process
  std::string sha256;  ///< of the content
  /// Of a structure: the models and atoms of the file that were compared. Older records do not say.
  StructureOptions read_with;
};

struct RunRecord {
  bool found = false;  ///< false: there is no such file, and nothing below means anything
  std::string path;    ///< of OUT.json
  RecordedInput source, target, source_map, target_map;
  std::string potential;       ///< the kind that was computed, such as "vacuum (Coulomb)"; empty for given maps
  double offset_A = 0;         ///< how far outside the surfaces potentials were read
  bool maps_computed = false;  ///< the potentials were computed in process; there are no map files
  RigidTransform source_to_target;
  double temperature_K = 300;
  bool trustworthy = true;
  std::vector<std::string> reasons;          ///< why it is not
  std::vector<std::string> untrusted_parts;  ///< the parts of the surface that are not, largest first
  std::string verdict;                       ///< in words: the certificate's own, or TRUSTWORTHY, NOT TRUSTWORTHY
  std::string source_name, target_name;      ///< the structures' files without folders, as they were given
  std::string method;
  std::map<std::string, std::vector<int>> parts;  ///< residues of "region" and of "patch NAME": indices of the source's
};

/// Reads the OUT.json beside an OUT.vtp. Input paths that are relative are taken from the folder where the comparison
/// ran; when the recorded content is not there, from the folder of OUT.json.
/// @throws FormatError when the file is damaged or is no record of a comparison
RunRecord read_run_record(const std::string& vtp_path);

/// Reads a structure as it was compared.
/// @param with_water ligands and water too, whatever was compared
/// @param remedy     what to do if it cannot be had, such as "; compare again"
/// @throws InputError (no record, the file is gone or has changed), and as read_structure()
Molecule read_compared(const RunRecord& record, const RecordedInput& input, bool with_water, const std::string& remedy);

}  // namespace espdiff
