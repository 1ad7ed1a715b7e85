// template_values.h: the cells of a matrix from one file of states in the vertices of a template.
#pragma once

#include <cstddef>
#include <vector>

#include "matrix/matrix_summary.h"

namespace espdiff {

class EnsembleFile;

/// Ordered pairs of n variants, chosen at random: the same ones each time, and a larger sample begins with a smaller
/// one. All pairs where `n_exact` is at least their number.
std::vector<MatrixPair> exact_sample(std::size_t n_variants, std::size_t n_exact);

/// The sample's cells out of others, source by source. @throws InputError (a pair is missing)
std::vector<MatrixCell> sampled(const MatrixPlan& plan, std::size_t n_exact, const std::vector<MatrixCell>& cells);

/// The matrix of a complete file that run_template_matrix() made: each pair over the vertices that are trusted onto
/// both states, with the weights of the template's surface. The two directions of a pair have the same values. A cell
/// is trustworthy if the template's mapping onto both states is, and the share of these vertices reaches the required
/// one.
/// @param fields complete files of the plan's fields, in its order
/// @param exact  the sampled() pairs
/// @throws InputError (states are missing; a patch of the plan has no place on the template)
Matrix matrix_through_template(const EnsembleFile& file, const std::vector<EnsembleFile>& fields,
                               std::vector<MatrixCell> exact);

}  // namespace espdiff
