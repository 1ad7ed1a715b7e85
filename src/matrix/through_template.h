// through_template.h: what a matrix through one template rests on: how each state maps, and pairs of their own beside
// it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "matrix/matrix.h"

namespace espdiff {

/// A state as the template sees it; see TemplateFrame.
struct TemplateState {
  double rmsd_A = 0, unmatched_template = 0, unmatched_state = 0, distance_A = 0, same_residue_area_fraction = 0;
  bool trustworthy = false;
  std::string reason;  ///< why it is not trustworthy
  std::string error;   ///< why it has no values
};

/// A matrix's values come from one mapping of a template's surface onto each state.
struct ThroughTemplate {
  std::string name, sha256;  ///< in words, and of its atoms
  std::size_t n_vertices = 0;
  double area_A2 = 0;
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the mappings; those of the plan are of exact pairs
  std::vector<TemplateState> states;                          ///< [variant]
  double mean_area_fraction = 0, least_area_fraction = 0;     ///< of the template, trusted onto both states of a pair
  std::vector<MatrixCell> exact;                              ///< pairs that were compared by themselves as well
};

/// Whether a metric comes from the values of two states in the same vertices alone: differences and similarities, and
/// the trusted areas, of which both are the share of the template that is trusted onto both states.
bool is_given_by_template(const Metric& metric);

struct Matrix;

/// How far one metric of the exact pairs is from the same pairs through the template.
struct TemplateAgreement {
  std::size_t metric = 0, n = 0;
  double exact_mean = 0, template_mean = 0;
  double mean_difference = 0, largest_difference = 0;  ///< magnitudes
  MatrixPair farthest{};                               ///< the pair with the largest difference
  double correlation = 0;                              ///< NaN with fewer than three pairs
};

/// Of each metric that the template gives and some exact pair has. @pre the matrix is through a template
std::vector<TemplateAgreement> agreement(const Matrix& matrix);

}  // namespace espdiff
