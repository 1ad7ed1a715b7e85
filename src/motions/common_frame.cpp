// common_frame.cpp: superposes the whole molecules, then their domains.
#include "motions/common_frame.h"

#include <limits>

#include "align/geometry/chain_motions.h"
#include "align/geometry/rigid_domains.h"
#include "align/geometry/superpose.h"
#include "align/pair_atoms.h"
#include "base/error.h"
#include "base/message.h"
#include "motions/local_motions.h"
#include "options/options.h"

namespace espdiff {
namespace {

CommonFrame superposed(const Molecule& source, const Molecule& target, AlignAtoms atoms, Alignment& result) {
  CommonFrame frame;
  frame.from_source = principal_frame(source.positions);
  if (atoms == AlignAtoms::kNone) {
    // As given: the RMSD over the pairs, if any.
    try {
      result.pairing = pair_atoms(source, target);
      result.rmsd_A = rmsd(source.positions, target.positions, result.pairing.pairs);
    } catch (const InputError&) {
      result.pairing.method = "none";
      result.rmsd_A = std::numeric_limits<double>::quiet_NaN();
    }
    frame.from_target = frame.from_source;
    return frame;
  }
  result.pairing = pair_atoms(source, target);
  const auto pairs = select_pairs(result.pairing, source, atoms);
  const Superposition superposition = superpose(source.positions, target.positions, pairs);
  result.source_to_target = superposition.transform;
  result.rmsd_A = superposition.rmsd_A;
  result.n_superposed_atoms = pairs.size();
  frame.from_target = compose(frame.from_source, inverse(superposition.transform));
  return frame;
}

}  // namespace

AlignedStates align(const Molecule& source, const Molecule& target, const CompareOptions& options) {
  AlignedStates aligned;
  Alignment& result = aligned.alignment;
  CommonFrame& frame = aligned.frame = superposed(source, target, options.align, result);
  result.chain_motions = chain_motions(source, target, result.pairing);
  frame.follows = options.domains == kLocalAsNeeded ? kNoDomains : options.domains;
  if (frame.follows == kNoDomains) return aligned;
  const auto pairs =
      options.align == AlignAtoms::kNone ? result.pairing.pairs : select_pairs(result.pairing, source, options.align);
  if (pairs.empty()) throw InputError("domains need paired atoms, and none pair; give domains none");
  if (frame.follows == kLocalMotions) {
    if (options.method != Method::kMorph)
      throw InputError(option("domains", kLocalMotions) + ": only the morph follows the motions of residues; use " +
                       option("method", "morph") + ", or " + option("domains", "auto"));
    frame.followed = local_motions(source, target, result.pairing, frame.from_source, frame.from_target);
    return aligned;
  }
  result.domains = find_domains(options.domains, source, target, pairs);
  frame.domains = domain_motions(result.domains, source, frame.from_source, frame.from_target);
  frame.followed = frame.domains;
  return aligned;
}

}  // namespace espdiff
