// ways_on.cpp: the changes of a comparison that are tried.
#include "cli/ways_on.h"

#include <algorithm>

#include "compare/result.h"

namespace espdiff::cli {
namespace {

/// Selections of the first pair of compared chains.
WayOn one_chain(const CompareResult& result) {
  const ComparedChains& first = result.chains.front();
  WayOn way;
  way.what = "chain " + first.source + " alone";
  if (first.source == first.target) {
    way.options = {{"select", "//" + first.source}};
  } else {
    way.what += " with chain " + first.target;
    way.options = {{"source-select", "//" + first.source}, {"target-select", "//" + first.target}};
  }
  return way;
}

bool is_named(const ComparedChains& chains) { return !chains.source.empty() && !chains.target.empty(); }

}  // namespace

std::vector<WayOn> ways_on(const CompareResult& result, const std::vector<std::string>& given, bool prepared) {
  const auto has = [&](const char* name) { return std::find(given.begin(), given.end(), name) != given.end(); };
  const bool has_side = std::any_of(given.begin(), given.end(), [](const std::string& name) {
    return name.rfind("source-", 0) == 0 || name.rfind("target-", 0) == 0;
  });
  // A region, a patch and causes are of the source.
  const bool has_place = has("region") || has("region-within") || has("patch") || has("causes");
  std::vector<WayOn> ways;
  if (result.chains.size() > 1 && is_named(result.chains.front()) && !has("select") && !has_side && !has("assembly"))
    ways.push_back(one_chain(result));
  if (!has_side && !has_place) ways.push_back({"source and target exchanged", true, {}});
  if (has("domains") && result.domains_used != "local")
    ways.push_back({"motions chosen by need", false, {{"domains", "as-needed"}}});
  if (prepared && result.has_potential && !has("same-protonation"))
    ways.push_back({"one protonation for both", false, {{"same-protonation", "", true}}});
  return ways;
}

}  // namespace espdiff::cli
