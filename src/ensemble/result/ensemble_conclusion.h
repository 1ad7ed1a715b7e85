// ensemble_conclusion.h: the answer of an ensemble in one sentence.
#pragma once

#include <string>

namespace espdiff {

struct EnsembleResult;

/// The answer in one sentence: whether the states differ, or why that cannot be concluded. Names of cause and remedy
/// are in it, so that it stands alone. @param unit of the potential
std::string conclusion_of(const EnsembleResult& result, const std::string& unit);

}  // namespace espdiff
