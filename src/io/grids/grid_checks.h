// grid_checks.h: what every grid reader must make sure of before it allocates and before it returns.
#pragma once

#include <cstddef>
#include <string>

#include "base/types.h"

namespace espdiff {

/// Grid counts from a file.
/// @throws FormatError at `line` when one is below 2 (nothing can be interpolated) or the product is above 2^31 - 1
std::array<int, 3> check_counts(const std::array<long long, 3>& counts, const std::string& path, long line);

/// @throws FormatError at `line` when origin or steps are not finite, or the steps lie in one plane
void check_axes(const Lattice& lattice, const std::string& path, long line);

/// A header that promises more values than its file can hold is wrong, and must not make us allocate.
/// `least_bytes` is the shortest that these values can be written.
/// @throws FormatError at `line`
void check_size_promise(std::size_t n_values, std::size_t least_bytes, std::size_t bytes_left, const std::string& path,
                        long line);

/// @throws MemoryError when the lattice's values cannot be allocated
void allocate_values(Grid& grid);

}  // namespace espdiff
