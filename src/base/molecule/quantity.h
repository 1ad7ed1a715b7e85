// quantity.h: a quantity that lives on a surface: its name, its unit, and whether its sign means something.
#pragma once

#include <optional>
#include <string>

namespace espdiff {

/// What the values of a field are.
struct Quantity {
  std::string name;        ///< of columns and arrays: "hydrophobicity"
  std::string label;       ///< for people: "Hydrophobicity (Kyte and Doolittle)"
  std::string unit;        ///< "kcal/mol"; empty for a mere number, or where nobody says it
  bool is_signed = false;  ///< whether 0 parts two kinds of values, as it does for charges and not for B factors
};

/// A field that is to be compared: its name in results, and what it is made of.
struct FieldRequest {
  std::string name;  ///< unique; letters, digits, `_`, `-` and `.`
  std::string what;  ///< KIND or KIND:ARGUMENT
};

/// A field whose patches are asked for: connected areas above one threshold, below another, or both.
struct PatchesRequest {
  std::string field;  ///< "potential", or the name of a FieldRequest
  std::optional<double> above, below;
};

}  // namespace espdiff
