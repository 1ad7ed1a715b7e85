// field_side.h: the state that a field is made for: its part in a comparison, its name, and values that came with it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace espdiff {

class GivenValues;
struct StateField;

/// What fields are made of besides a state's molecule. Names fill the places in the names of field's files.
struct FieldInput {
  std::string label{};                                  ///< of a variant: `{label}`
  std::string group{};                                  ///< of a variant: `{group}`
  std::string replicate{};                              ///< of a frame: `{replicate}`
  int frame = -1;                                       ///< its number, from 0: `%d`; -1: no frame
  std::shared_ptr<const GivenValues> given{};           ///< per-atom values of VMD or Python; null for none
  std::shared_ptr<const StateField> complementarity{};  ///< at an interface of the state's; null without one
  /// [field] made before, as make_state_fields() does; null: made when the state is compared.
  std::shared_ptr<const std::vector<StateField>> made{};
};

/// A state by its part in a comparison. A variant of a matrix is source and target; a frame of an ensemble is compared
/// with all others.
struct FieldSide {
  enum Role { kSource, kTarget, kVariant, kFrame };

  FieldSide(Role part, FieldInput of_state = {}) : role(part), input(std::move(of_state)) {}
  bool operator==(Role other) const { return role == other; }
  /// Whether it is one of many alike, rather than one side of a pair or of a series.
  bool is_one_of_many() const { return role == kVariant || role == kFrame; }

  Role role;
  FieldInput input;
};

/// "source", "target", "variant", "frame"
inline const char* to_string(const FieldSide& side) {
  switch (side.role) {
    case FieldSide::kSource: return "source";
    case FieldSide::kTarget: return "target";
    case FieldSide::kVariant: return "variant";
    case FieldSide::kFrame: break;
  }
  return "frame";
}

}  // namespace espdiff
