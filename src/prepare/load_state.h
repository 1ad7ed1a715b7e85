// load_state.h: one state of a comparison from a structure file: read, selected, and given charges.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/molecule/input_options.h"
#include "base/molecule/structure_options.h"
#include "base/molecule/unit_cell.h"
#include "base/progress.h"
#include "base/types.h"
#include "prepare/charges/preparation.h"

namespace espdiff {

class StructureFile;

/// Which state of a comparison a file holds; variants of a matrix and single molecules are kOnly.
enum class StateRole { kOnly, kSource, kTarget };

/// "source", "target", "molecule"
const char* to_string(StateRole role);

/// A file that a state took charges from.
struct ChargeFile {
  std::string use;  ///< "topology", "charges_from", "ligand"
  std::string path, sha256;
};

/// What a result says about how a state was made.
struct StateOrigin {
  std::optional<Preparation> preparation;  ///< where PDB2PQR made the charges
  std::vector<ChargeFile> charge_files;
  std::size_t n_border_bonds = 0;  ///< that crossed the border of the file's periodic cell, see make_whole()
};

/// A state that was read: its atoms selected, and with charges where they could be had.
struct LoadedState : StateOrigin {
  Molecule molecule;  ///< has the surface; its charges count for pb and coulomb
  /// For pme in the file's cell: with water and ions. Empty unless the file or a topology has charges.
  Molecule everything;
  std::optional<UnitCell> cell;
  Molecule whole;              ///< the file's atoms without water, before the selection; regions refer to it
  std::size_t n_left_out = 0;  ///< atoms that leave_out dropped
  bool is_changed = false;     ///< the molecule is not what the file alone gives
};

/// How a state is loaded besides its file.
struct StateRequest {
  StructureOptions structure;
  StateRole role = StateRole::kOnly;
  bool wants_charges = true;         ///< structures without charges get some
  bool may_prepare = true;           ///< also from PDB2PQR
  const Molecule* source = nullptr;  ///< the loaded source, for a target with its protonation states
  bool only_checks = false;          ///< charges are not made; what could get none is refused, as far as names tell
  /// The other state, which is loaded later; its residues without charges are in the error of this one's.
  std::function<void()> check_partner{};
};

/// A PSF or prmtop that lies beside a file, has its name and lists as many atoms; empty for none.
std::string topology_beside(const StructureFile& file, const StructureOptions& structure);

/// The atoms of a file before anyone has named a topology: where it needs_atoms(), those of the one beside it,
/// otherwise atoms without names. @throws as StructureFile::read()
Molecule read_as_it_is(const StructureFile& file, const StructureOptions& structure);

/// Reads a state: builds the assembly, takes charges from a topology, drops and selects atoms, then takes charges from
/// another state's PQR or has PDB2PQR make them. A molecule that has charges keeps them.
/// @param options those of a comparison; the role picks its own selection and topology
/// @throws as StructureFile::read(), select_some_atoms(), read_topology(), take_values(), prepare_molecule();
///         InputError (a topology with a selection that is empty, an assembly with a topology)
LoadedState load_state(const StructureFile& file, const StateRequest& request, const InputOptions& options,
                       const Progress& progress);

/// The same for a molecule that is there already, such as one of arrays: drops and selects its atoms, then gives it
/// charges.
/// @param state with molecule, cell, everything. @throws as load_state() behind reading; UnchargedError
void select_and_charge(LoadedState& state, const StateRequest& request, const InputOptions& options,
                       const Progress& progress);

/// Gives a molecule charges unless it has some: from another state's PQR, or by PDB2PQR.
/// @returns what PDB2PQR did, where it ran
std::optional<Preparation> charge_molecule(Molecule& molecule, const InputOptions& options, const StateRequest& request,
                                           std::vector<ChargeFile>& files, const Progress& progress);

/// Loads a frame of a series. A frame without charges takes the source's where it has the same atoms. If PDB2PQR
/// prepared the source, other frames are prepared like it, with its protonation states.
/// @param name of the frame, for messages  @param role whose selection and topology count
/// @throws as load_state(), take_values()
LoadedState load_frame(const StructureFile& file, const StructureOptions& structure, const std::string& name,
                       const Molecule& source, bool source_is_prepared, const InputOptions& options,
                       const Progress& progress, StateRole role = StateRole::kTarget);

/// The last step of load_frame(): charges for a frame that is read and selected; request.source is the source.
void charge_frame(LoadedState& state, const Molecule& source, bool source_is_prepared, const StateRequest& request,
                  const InputOptions& options, const Progress& progress);

/// For a molecule that comes from no file.
/// @param whose what the molecule is and what to do instead, for the message: "b is ...; choose ..."
/// @throws InputError when an option is given that says how a file is read or what of it is taken
void refuse_options_of_files(const InputOptions& options, StateRole role, const std::string& whose);

/// Whether options did what they are for.
/// @throws InputError when leave_out dropped no atom of any state, or a MOL2 file describes no residue of any
void check_left_out(const InputOptions& options, const std::vector<const LoadedState*>& states);

}  // namespace espdiff
