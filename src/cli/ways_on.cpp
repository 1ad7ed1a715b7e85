// ways_on.cpp: the changes of a comparison that are tried.
#include "cli/ways_on.h"

#include <algorithm>
#include <set>

#include "compare/result.h"

namespace espdiff::cli {
namespace {

/// Selections of pairs of compared chains.
WayOn chains_alone(const std::vector<ComparedChains>& chains) {
  std::string of_source, of_target;
  for (const ComparedChains& pair : chains) {
    of_source += (of_source.empty() ? "" : ",") + pair.source;
    of_target += (of_target.empty() ? "" : ",") + pair.target;
  }
  WayOn way;
  way.what = "chain " + of_source + " alone";
  if (of_source == of_target) {
    way.options = {{"select", "//" + of_source}};
  } else {
    way.what = "chain " + of_source + " with chain " + of_target + " alone";
    way.options = {{"source-select", "//" + of_source}, {"target-select", "//" + of_target}};
  }
  return way;
}

std::size_t n_chains(const Molecule& molecule) {
  std::set<std::string> names;
  for (const Residue& residue : molecule.residues) names.insert(residue.chain);
  return names.size();
}

bool is_named(const ComparedChains& chains) { return !chains.source.empty() && !chains.target.empty(); }

}  // namespace

std::vector<WayOn> ways_on(const CompareResult& result, const Molecule& source, const Molecule& target,
                           const std::vector<std::string>& given, bool prepared) {
  const auto has = [&](const char* name) { return std::find(given.begin(), given.end(), name) != given.end(); };
  const bool has_side = std::any_of(given.begin(), given.end(), [](const std::string& name) {
    return name.rfind("source-", 0) == 0 || name.rfind("target-", 0) == 0;
  });
  // A region, a patch and causes are of the source.
  const bool has_place = has("region") || has("region-within") || has("patch") || has("causes");
  std::vector<WayOn> ways;
  const bool may_select = !has("select") && !has_side && !has("assembly") && !result.chains.empty() &&
                          std::all_of(result.chains.begin(), result.chains.end(), is_named);
  if (may_select && std::max(n_chains(source), n_chains(target)) > result.chains.size())
    ways.push_back(chains_alone(result.chains));
  if (may_select && result.chains.size() > 1) ways.push_back(chains_alone({result.chains.front()}));
  if (!has_side && !has_place) ways.push_back({"source and target exchanged", true, {}});
  if (has("domains") && result.domains_used != "local")
    ways.push_back({"motions chosen by need", false, {{"domains", "as-needed"}}});
  if (prepared && result.has_potential && !has("same-protonation"))
    ways.push_back({"one protonation for both", false, {{"same-protonation", "", true}}});
  return ways;
}

}  // namespace espdiff::cli
