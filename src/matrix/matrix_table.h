// matrix_table.h: a matrix as a table in words.
#pragma once

#include <cstddef>
#include <ostream>

namespace espdiff {

struct Matrix;

/// Prints range, asymmetry, nearest and farthest pair, groups, and pairs that are not trustworthy; at most 100 columns.
void print_matrix(std::ostream& out, const Matrix& matrix, std::size_t metric);

}  // namespace espdiff
