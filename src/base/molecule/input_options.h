// input_options.h: which atoms of two files are compared, where their charges come from, and which part is reported.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// Radii of the surface. kAuto: those of the files where all states have them from one force field, otherwise by
/// element.
enum class RadiiChoice { kAuto, kFile, kElement };

/// What may differ between source and target.
struct SideInput {
  std::string select;    ///< atoms that make the surface and the charges, in gemmi's syntax; empty for all
  std::string topology;  ///< PSF or prmtop with the charges of the file's atoms; empty for none
};

/// How charges are made for structures that have none (by PDB2PQR).
struct ChargeOptions {
  /// Lower case. auto: PARSE, or AMBER for both states where there are nucleotides, which PARSE has only some of.
  std::string force_field = "auto";
  double ph = 7;
  std::vector<std::string> ligands;  ///< MOL2 files
  bool ligands_auto = true;          ///< the other ligands get hydrogens and charges from Open Babel, if it is there
  bool same_protonation = false;     ///< residues of the target take the states of the source's they pair with
  bool use_cache = true;
};

/// A part of the source's surface that is chosen before the result is seen. Its numbers are named after it.
struct PatchRequest {
  std::string name;       ///< unique; letters, digits, `_`, `-` and `.`
  std::string selection;  ///< in gemmi's syntax; or FILE.json:NUMBER, a patch of an earlier ensemble
};

/// Everything about the input of a comparison besides file names and models.
struct InputOptions {
  SideInput both, source, target;
  std::string leave_out;     ///< atoms to drop from both states, in gemmi's syntax
  std::string assembly;      ///< name of the biological assembly to build; empty for the file's atoms
  std::string charges_from;  ///< PQR file of another state, whose charges and radii states without take
  RadiiChoice radii = RadiiChoice::kAuto;
  ChargeOptions charges;
  std::string region;          ///< atoms of the source whose residues are reported as well; empty for none
  double region_within_A = 0;  ///< instead: the source's residues with an atom this near to `region_of`
  std::string region_of;       ///< atoms of the source's file, or else of the target's
  std::vector<PatchRequest> patches;

  bool has_region() const { return !region.empty() || !region_of.empty(); }
};

}  // namespace espdiff
