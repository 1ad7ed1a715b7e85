// states.h: every frame against every other one through the template, and principal components.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "ensemble/result/state_sums.h"

namespace espdiff {

class EnsembleFile;
struct EnsembleResult;

/// How many frames are compared with each other at most: the tables grow with the square of it.
constexpr std::size_t kMostStates = 5000;
constexpr std::size_t kComponents = 3;

/// All frames against each other, each pair over the vertices that both have.
struct StateTable {
  std::vector<std::size_t> frames;  ///< their numbers in the file
  StateSums sums;
  double area_fraction = 0;  ///< of the template's area that every frame has, on which the components rest

  /// Principal components of the potential over frames.
  struct Component {
    double share = 0;            ///< of the variance
    std::vector<double> scores;  ///< [frame] in standard deviations
    std::vector<double> mode;    ///< [vertex] change of the potential for one standard deviation; NaN where a frame
                                 ///< has no value. The largest magnitude is positive
  };
  std::vector<Component> components;

  std::size_t size() const { return frames.size(); }
};

/// Compares the frames that have values and are not cut off as equilibration. Values are read in blocks; memory grows
/// with the square of the number of frames. The same bits at any number of threads.
/// @throws InputError (more than kMostStates frames; no vertex that every frame has)
StateTable compare_states(const EnsembleFile& file, const EnsembleResult& result);

/// OUT.states.csv: a row for each pair of frames.
void write_state_pairs(std::ostream& out, const EnsembleFile& file, const StateTable& states);
/// OUT.components.csv: a row for each frame.
void write_components(std::ostream& out, const EnsembleFile& file, const StateTable& states);

}  // namespace espdiff
