// pair_interface.cpp: complexes to first partners with the complementarity of both as a field.
#include "study/pair_interface.h"

#include <utility>

#include "align/pair_atoms.h"
#include "align/paired_residues.h"
#include "base/error.h"
#include "certificate/result.h"
#include "complementarity/complementarity_report.h"
#include "io/molecules/select_atoms.h"

namespace espdiff {

PairInterface::PairInterface(const CompareOptions& options, ComparedState& source, ComparedState& target)
    : options_(options) {
  request_ = parse_interface(options.interface);
  for (ComparedState* state : {&source, &target}) {
    LoadedState& loaded = state->loaded;
    const std::vector<bool> first = atoms_of(request_, loaded.molecule).first;
    sides_.push_back({state, loaded, std::nullopt});
    if (loaded.whole.size() == 0) loaded.whole = loaded.molecule;
    Molecule alone = keep_atoms(loaded.molecule, first);
    if (!state->parts.region.empty()) {
      std::vector<std::uint8_t> region(alone.residues.size(), 0);
      for (std::size_t i = 0, kept = 0; i < first.size(); ++i) {
        if (!first[i]) continue;
        const auto residue = static_cast<std::size_t>(loaded.molecule.atoms[i].residue);
        region[static_cast<std::size_t>(alone.atoms[kept++].residue)] = state->parts.region[residue];
      }
      state->parts.region = std::move(region);
    }
    loaded.molecule = std::move(alone);
    loaded.everything = {};
    loaded.is_changed = true;
  }
}

StatePtr PairInterface::without_others(const StatePtr& given) {
  if (!given->potential) return given;
  State alone = *given;
  alone.potential->charges = {};
  alone.potential->surroundings.solute.clear();
  return std::make_shared<const State>(std::move(alone));
}

void PairInterface::make_fields(Engine& engine, const State& source, const State& target, const PotentialPlan& plan,
                                const Progress& progress) {
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const State& given = s == 0 ? source : target;
    if (!given.potential && !plan.computes())
      throw InputError(option("interface", options_.interface) +
                       ": complementarity needs potentials of each partner, " +
                       (given.has_map()          ? "which given maps are not; leave the maps out"
                        : plan.because().empty() ? "leave out " + option("potential", "none")
                                                 : plan.because()));
    Side& side = sides_[s];
    side.interface.emplace(
        engine, side.complex, request_,
        [&](const LoadedState& charged) { return computed_map(given, plan, options_.temperature_K, charged); },
        options_, progress);
    side.state->fields.complementarity = std::make_shared<const StateField>(side.interface->field(0));
  }
}

void PairInterface::add_to(CompareResult& result) const {
  const Complementarity &source = sides_[0].interface->result(), &target = sides_[1].interface->result();
  ComplementarityResult both{request_, {&source, &target}, std::vector<InterfaceChange>(2)};
  for (std::size_t side = 0; side < 2; ++side) {
    const Molecule &from = source.sides[side].molecule, &to = target.sides[side].molecule;
    both.changes[side].partner_of =
        paired_residues(from, to, side == 0 ? result.alignment.pairing : pair_atoms(from, to));
  }
  result.interface = std::make_shared<const InterfaceComparison>(
      InterfaceComparison{request_.first, request_.second, source.numbers(), target.numbers(), interface_rows(both)});
}

}  // namespace espdiff
