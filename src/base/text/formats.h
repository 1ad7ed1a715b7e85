// formats.h: names and version of the JSON files that results are; docs/schemas has what is in them.
#pragma once

namespace espdiff {

constexpr const char* kComparisonFormat = "espdiff comparison";
constexpr const char* kMatrixFormat = "espdiff matrix";
constexpr const char* kEnsembleFormat = "espdiff ensemble";
/// Grows when a key changes its meaning, moves or disappears; new keys may come without.
constexpr int kFormatVersion = 1;

}  // namespace espdiff
