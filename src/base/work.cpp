// work.cpp: steps as hours.
#include "base/work.h"

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {

void require_work(double n_steps, const Message& what, const Message& remedy) {
  constexpr double kStepsPerSecond = 2e8, kSecondsPerHour = 3600, kMostHours = 24;
  const double hours = n_steps / kStepsPerSecond / kSecondsPerHour;
  if (!(hours > kMostHours)) return;
  throw InputError(what + formatted(": about %.0e steps, ", n_steps) +
                   (hours < 1e4 ? formatted("%.0f hours", hours) : formatted("%.0f years", hours / 24 / 365.25)) +
                   formatted(" of one core (limit %.0f hours); ", kMostHours) + remedy);
}

}  // namespace espdiff
