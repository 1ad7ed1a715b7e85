// work.h: estimates a computation before it is begun.
#pragma once

#include "base/message.h"

namespace espdiff {

/// Refuses what would take more than a day of one core, at two hundred million steps a second; a step is about a charge
/// and a point, or a vertex and an atom near it.
/// @param n_steps estimated; not a number passes
/// @param what    begins the message, with what the steps follow from
/// @param remedy  what to do instead
/// @throws InputError with the steps, the time and the limit
void require_work(double n_steps, const Message& what, const Message& remedy);

}  // namespace espdiff
