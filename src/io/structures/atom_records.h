// atom_records.h: the ATOM and HETATM lines of PDB and PQR files, model by model.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace espdiff {

/// One ATOM or HETATM line, without its end.
struct AtomLine {
  std::string_view text;  ///< points into the file's text
  long number = 0;        ///< in the file, from 1
  bool has_end = true;    ///< false: the file ends here, without a line end; it may have been cut

  bool is_hetatm() const { return text[0] == 'H' || text[0] == 'h'; }
};

using AtomModel = std::vector<AtomLine>;

/// Splits a file into models: at MODEL and ENDMDL records, or, without these, where atoms follow an END (as VMD writes
/// trajectories), if all parts have the same number of atoms.
/// @throws FormatError (atoms beside the models of a file with MODEL records, unequal parts around END),
///         InputError (no ATOM or HETATM record at all), MemoryError
std::vector<AtomModel> split_models(std::string_view text, const std::string& path);

/// Model `number` (from 1). @throws InputError when the file has no such model
const AtomModel& pick_model(const std::vector<AtomModel>& models, int number, const std::string& path);

/// Whether the lines are PQR (free format that ends in charge and radius) rather than PDB (fixed columns with occupancy
/// and B factor), by a vote of the lines. Lines that could be either are PQR when a charge is negative; the last resort
/// is the file's name (.pqr).
bool looks_like_pqr(const AtomModel& model, const std::string& path);

}  // namespace espdiff
