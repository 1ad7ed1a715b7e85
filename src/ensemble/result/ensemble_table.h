// ensemble_table.h: an ensemble's answer as a table.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace espdiff {

class EnsembleFile;
struct EnsembleResult;

/// The answer in at most 100 columns. @param said warnings that were printed already
void print_ensemble(std::ostream& out, const EnsembleFile& file, const EnsembleResult& result,
                    const std::vector<std::string>& said = {});

}  // namespace espdiff
