// pair_interface.h: the interface of two complexes, as a field of the comparison of their first partners.
#pragma once

#include <optional>

#include "base/progress.h"
#include "complementarity/complementarity.h"
#include "options/options.h"
#include "study/state.h"

namespace espdiff {

class Engine;

/// Takes both complexes apart: the first partners are compared, the second ones add their potentials.
class PairInterface {
 public:
  /// Leaves the first partner in each state. @param options name an interface
  /// @throws InputError (partners, as atoms_of())
  PairInterface(const CompareOptions& options, ComparedState& source, ComparedState& target);

  /// The state as the maps of its first partner are made: charges of other atoms that it was given do not count.
  static StatePtr without_others(const StatePtr& given);

  /// Makes the potentials of all partners, and from them the field of each state. The states refer to this object.
  /// @throws InputError (a state without a computed potential; as InterfaceOfComplex)
  void make_fields(Engine& engine, const State& source, const State& target, const PotentialPlan& plan,
                   const Progress& progress);
  void add_to(CompareResult& result) const;

 private:
  struct Side {
    ComparedState* state;
    LoadedState complex;
    std::optional<InterfaceOfComplex> interface;
  };

  const CompareOptions& options_;
  InterfaceRequest request_;
  std::vector<Side> sides_;
};

}  // namespace espdiff
