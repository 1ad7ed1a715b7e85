// ways_on.cpp: the changes of a comparison that are tried.
#include "cli/words/ways_on.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "base/molecule/water.h"
#include "certificate/result.h"

namespace espdiff::cli {
namespace {

/// Chains that are compared alone.
struct ChosenChains {
  std::set<std::string> names;
  std::string list;  ///< "A,B"

  void add(const std::string& name) {
    names.insert(name);
    list += (list.empty() ? "" : ",") + name;
  }

  double n_atoms(const Molecule& molecule) const {
    return static_cast<double>(std::count_if(molecule.atoms.begin(), molecule.atoms.end(), [&](const Atom& atom) {
      return names.count(molecule.residues[static_cast<std::size_t>(atom.residue)].chain) > 0;
    }));
  }
};

/// Selections of pairs of compared chains.
WayOn chains_alone(const std::vector<ComparedChains>& chains, const Molecule& source, const Molecule& target) {
  ChosenChains of_source, of_target;
  for (const ComparedChains& pair : chains) {
    of_source.add(pair.source);
    of_target.add(pair.target);
  }
  WayOn way;
  way.size =
      (of_source.n_atoms(source) + of_target.n_atoms(target)) / static_cast<double>(source.size() + target.size());
  way.what = "chain " + of_source.list + " alone";
  if (of_source.list == of_target.list) {
    way.options = {{"select", "//" + of_source.list}};
  } else {
    way.what = "chain " + of_source.list + " with chain " + of_target.list + " alone";
    way.options = {{"source-select", "//" + of_source.list}, {"target-select", "//" + of_target.list}};
  }
  return way;
}

std::size_t n_chains(const Molecule& molecule) {
  std::set<std::string> names;
  for (const Residue& residue : molecule.residues) names.insert(residue.chain);
  return names.size();
}

/// Names of a chain's residues by their numbers.
std::map<std::int32_t, std::string> residues_of(const Molecule& molecule, const std::string& chain) {
  std::map<std::int32_t, std::string> residues;
  for (const Residue& residue : molecule.residues) {
    if (residue.chain == chain) residues.emplace(residue.number, residue.name);
  }
  return residues;
}

/// " //A/77-111" for each run of residues that the other chain has not; shorter ones are the mapping's business.
std::string runs_missing_in(const std::map<std::int32_t, std::string>& other,
                            const std::map<std::int32_t, std::string>& residues, const std::string& chain) {
  constexpr std::int32_t kShortest = 5;
  std::string runs;
  for (auto first = residues.begin(); first != residues.end();) {
    auto last = first, next = std::next(first);
    while (other.count(first->first) == 0 && next != residues.end() && next->first == last->first + 1 &&
           other.count(next->first) == 0)
      last = next++;
    if (other.count(first->first) == 0 && last->first - first->first + 1 >= kShortest)
      runs += " //" + chain + "/" + std::to_string(first->first) + "-" + std::to_string(last->first);
    first = next;
  }
  return runs;
}

/// Selects what only one state has of the compared chains, such as a tail; empty where numbers do not tell.
std::string residues_of_one_state(const std::vector<ComparedChains>& chains, const Molecule& source,
                                  const Molecule& target) {
  std::string selection;
  for (const ComparedChains& pair : chains) {
    if (pair.source != pair.target) return {};
    const auto own = residues_of(source, pair.source), others = residues_of(target, pair.target);
    const auto n_shared = static_cast<std::size_t>(std::count_if(own.begin(), own.end(), [&](const auto& residue) {
      const auto found = others.find(residue.first);
      return found != others.end() && found->second == residue.second;
    }));
    if (2 * n_shared < std::min(own.size(), others.size())) return {};
    selection += runs_missing_in(others, own, pair.source) + runs_missing_in(own, others, pair.target);
  }
  return selection.empty() ? selection : selection.substr(1);
}

/// The force field, by its name in PDB2PQR, whose backbones have the molecule's charges; null where none has.
const char* force_field_of(const Molecule& molecule) {
  struct Backbone {
    const char* name;
    float oxygen;  ///< charge of the carbonyl oxygen, elementary charges
  };
  // Cornell et al. 1995 and its successors; MacKerell et al. 1998.
  constexpr Backbone kBackbones[] = {{"amber", -0.5679F}, {"charmm", -0.51F}};
  constexpr float kSame = 0.002F;
  if (molecule.charges.size() != molecule.size()) return nullptr;
  for (const Backbone& backbone : kBackbones) {
    std::size_t n = 0, n_same = 0;
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      const Atom& atom = molecule.atoms[i];
      if (atom.name != "O" || is_water_name(molecule.residues[static_cast<std::size_t>(atom.residue)].name)) continue;
      ++n;
      n_same += std::fabs(molecule.charges[i] - backbone.oxygen) < kSame ? 1 : 0;
    }
    if (2 * n_same > n) return backbone.name;
  }
  return nullptr;
}

bool is_named(const ComparedChains& chains) { return !chains.source.empty() && !chains.target.empty(); }

}  // namespace

std::vector<WayOn> ways_on(const CompareResult& result, const Molecule& source, const Molecule& target,
                           const std::vector<std::string>& given, PreparedStates prepared) {
  const auto has = [&](const char* name) { return std::find(given.begin(), given.end(), name) != given.end(); };
  const bool has_side = std::any_of(given.begin(), given.end(), [](const std::string& name) {
    return name.rfind("source-", 0) == 0 || name.rfind("target-", 0) == 0;
  });
  // A region, a patch and causes are of the source.
  const bool has_place = has("region") || has("region-within") || has("patch") || has("causes");
  std::vector<WayOn> ways;
  if (prepared.source != prepared.target && result.potential.compared && !has("force-field")) {
    const char* const force_field = force_field_of(prepared.source ? target : source);
    if (force_field != nullptr)
      ways.push_back({"the other file's force field for both", false, {{"force-field", force_field}}, 1});
  }
  const bool may_select = !has("select") && !has_side && !has("assembly") && !result.inputs.chains.empty() &&
                          std::all_of(result.inputs.chains.begin(), result.inputs.chains.end(), is_named);
  if (may_select && std::max(n_chains(source), n_chains(target)) > result.inputs.chains.size())
    ways.push_back(chains_alone(result.inputs.chains, source, target));
  if (result.inputs.chains.size() > 1 && !has("domains"))
    ways.push_back({"each chain superposed by itself", false, {{"domains", "chains"}}, 1});
  if (may_select && result.inputs.chains.size() > 1)
    ways.push_back(chains_alone({result.inputs.chains.front()}, source, target));
  const std::string extra = residues_of_one_state(result.inputs.chains, source, target);
  if (!extra.empty() && !has("leave-out") &&
      std::all_of(result.inputs.chains.begin(), result.inputs.chains.end(), is_named))
    ways.push_back({"without residues that only one state has", false, {{"leave-out", extra}}, 1});
  if (!has_side && !has_place) ways.push_back({"source and target exchanged", true, {}, 1});
  if (has("domains") && result.mapping.domains != "local")
    ways.push_back({"motions chosen by need", false, {{"domains", "as-needed"}}, 1});
  if (prepared.source && prepared.target && result.potential.compared && !has("same-protonation"))
    ways.push_back({"one protonation for both", false, {{"same-protonation", "", true}}, 1});
  return ways;
}

bool has_time_for(const WayOn& way, double once_s, double spent_s) {
  constexpr double kMinute = 60;
  return spent_s + way.size * once_s <= std::max(kMinute, once_s);
}

}  // namespace espdiff::cli
