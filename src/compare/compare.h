// compare.h: compares one pair of molecules: from atoms and maps to metrics and certificate.
#pragma once

#include "base/handles.h"
#include "base/progress.h"

namespace espdiff {

struct CompareInput;
struct CompareOptions;
struct CompareResult;

/// Compares two molecules: a series of one.
/// @throws InputError (no common atoms; a map on one side only; a map that does not cover the surface; units that
/// differ with one unknown), GeometryError, MemoryError, Cancelled
CompareResult compare(Engine& engine, const CompareInput& source, const CompareInput& target,
                      const CompareOptions& options, const Progress& progress);

}  // namespace espdiff
