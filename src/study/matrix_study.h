// matrix_study.h: the whole of a matrix in one call: states, potentials, radii, pairs, files. Command line, Tcl and
// Python start here.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "matrix/matrix_run.h"
#include "options/options.h"
#include "study/state.h"

namespace espdiff {

/// What is asked for.
struct MatrixStudy {
  struct Item {
    StatePtr state;
    std::string label, group;
  };

  std::vector<Item> variants;
  CompareOptions options;
  PotentialRequest potential;
  bool each_by_itself = false, refuses_shapes = false;          ///< see StatesRequest
  MatrixRun run;                                                ///< all but `potential` and `radii_note`
  std::string template_text;                                    ///< empty: each pair by itself
  std::size_t n_exact = 6;                                      ///< pairs compared by themselves beside a template
  std::vector<std::pair<std::string, std::string>> settings{};  ///< that were given, for the template's mappings
  StructureOptions structure{};                                 ///< how a template's file is read
};

/// Reads all variants, plans their potentials together and their radii by pairs, and runs the matrix.
/// @throws as StateReader, set_parts(), unite_map_units(), run_matrix(), run_template_matrix(); InputError (a template
/// in
///         a build without HDF5, whose files keep its potentials)
MatrixReport run_matrix(const MatrixStudy& study, Engine& engine, const Progress& progress);

/// Whether files are parts of a matrix through a template; never in a build without HDF5.
bool are_template_parts(const std::vector<std::string>& paths);

/// Merges the parts of a matrix of either kind. @throws as merge_matrix() and merge_template_matrix()
MatrixReport merge_parts(const std::vector<std::string>& paths, const MatrixRun& run);

}  // namespace espdiff
