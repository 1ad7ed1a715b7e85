// cause_probes.h: charges that are asked about besides those that are there: of other placements, and of a scan.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "causes/causes.h"
#include "causes/side_chains.h"
#include "engine/potential_stage.h"

namespace espdiff {

struct CompareOptions;

/// What is asked of one state.
struct StateProbes {
  std::vector<ProbeCharge> charges;               ///< in the common frame: of the scan, then of the side chains
  std::vector<std::size_t> scanned;               ///< [probe of the scan] index into Causes::changes
  std::vector<SideChainPlacements> side_chains;   ///< each placement has a probe for each atom
  std::vector<std::vector<std::size_t>> drawn{};  ///< [draw][side chain] placement
};

/// The probes of one state that the options ask for.
/// @param may_move [change] nonzero for residues at the surface
/// @throws InputError for a molecule whose charges are not its own atoms'
StateProbes probes_of(const Molecule& molecule, const RigidTransform& to_common, const Causes& causes, bool of_target,
                      const std::vector<std::uint8_t>& may_move, const CompareOptions& options);

/// Adds the scan and the interval to the last reading of `causes`.
/// @param source_values, target_values [probe] what the probes add to the reading
/// @param is_exact whether the potential depends on nothing but the charges
void add_probed(Causes& causes, const StateProbes& source, const std::vector<double>& source_values,
                const StateProbes& target, const std::vector<double>& target_values, bool is_exact,
                const CompareOptions& options);

}  // namespace espdiff
