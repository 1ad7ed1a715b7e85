// choose_motions.h: the default of `--domains`: a mapping that slips is tried once more with local motions, and the
// better one of the two is kept.
#pragma once

#include "compare/stages/mapped_step.h"

namespace espdiff {

/// Whether a mapping is refused by its slip, so that local motions may map better.
bool slips(const MappedStep& step, const StatesToMap& states);

/// Whether it would be in usual steps, too: the slip of a trial (kTrialSteps) is farther beyond the limit of the whole
/// area than its steps can change.
bool slips_clearly(const MappedStep& trial, const StatesToMap& states);

/// Whether the mapping by the superposition of the whole slips most likely: more than 1.2 % of the paired atoms part
/// from their surroundings, which is to end farther than 9 A from where the mean way of the residues around theirs
/// takes them. Rigid domains do not part from theirs, however far they go. Of 347 ordered pairs, nearly all of
/// ubiquitin, it holds for 240 of the 246 that slip, and for 18 of the others.
bool will_slip(const StatesToMap& states, const CommonFrame& frame);

/// The steps of a mapping that slips most likely, in usual ones. Of the same pairs its slip differs from the
/// usual one's by 0.7 % of the area at most, and its share on its own residue by 0.6 %. Near the limits usual steps
/// decide.
constexpr double kTrialSteps = 4;

/// The share of both surfaces' area that is matched and on its own residue, by which two refused mappings are compared.
/// Unlike the slip, it does not depend on the motions that the mapping followed.
/// @param source_area, target_area of the whole surfaces
double own_residue_share(const Certificate& certificate, double source_area, double target_area);

/// Keeps `local` if it is within every limit of fit and slip, or if it has the larger own_residue_share(); otherwise
/// `straight`. Potentials, regions and the round trip play no part: a pair has the same mapping with and without them.
/// Sets the kept report's `other`.
/// @param straight by the superposition of the whole; it slips
/// @param local    by local motions
MappedStep better_of(MappedStep straight, MappedStep local, const StatesToMap& states);

/// Whether better_of() keeps `local` instead of a mapping in usual steps, of which `trial` is one in longer steps: the
/// shares are farther apart than the steps can change.
bool keeps_local_clearly(const MappedStep& trial, const MappedStep& local, const StatesToMap& states);

/// Keeps `straight` where the second mapping failed, and says so.
MappedStep without_second(MappedStep straight, const Message& error);

}  // namespace espdiff
