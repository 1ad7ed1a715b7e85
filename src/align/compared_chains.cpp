// compared_chains.cpp: chains by the residues that pair, and by their letters at equal numbers.
#include "align/compared_chains.h"

#include <algorithm>
#include <map>
#include <utility>

#include "align/residue_names.h"
#include "base/progress.h"

namespace espdiff {
namespace {

using Letters = std::map<std::pair<std::int32_t, char>, char>;  // by number and insertion code

struct NamedChain {
  std::string name;
  Letters letters;
};

/// Chains of amino acids or nucleotides, in the molecule's order.
std::vector<NamedChain> named_chains(const Molecule& molecule) {
  std::vector<NamedChain> chains;
  std::map<std::string, std::size_t> of_name;
  for (const Residue& residue : molecule.residues) {
    const char letter = residue_letter(residue.name);
    if (letter == '?') continue;
    const auto [known, is_new] = of_name.try_emplace(residue.chain, chains.size());
    if (is_new) chains.push_back({residue.chain, {}});
    chains[known->second].letters[{residue.number, residue.insertion_code}] = letter;
  }
  return chains;
}

bool are_copies(const Letters& a, const Letters& b) {
  constexpr std::size_t kLeast = 5;
  constexpr double kShare = 0.9;
  const std::size_t shorter = std::min(a.size(), b.size());
  if (shorter < kLeast) return false;
  std::size_t n_common = 0, n_equal = 0;
  for (const auto& [number, letter] : a) {
    const auto found = b.find(number);
    if (found == b.end()) continue;
    ++n_common;
    n_equal += found->second == letter ? 1 : 0;
  }
  return n_common == n_equal && static_cast<double>(n_common) >= kShare * static_cast<double>(shorter);
}

}  // namespace

std::vector<ComparedChains> compared_chains(const Molecule& source, const Molecule& target,
                                            const std::vector<std::int32_t>& target_of) {
  std::vector<std::string> order;
  std::map<std::string, std::map<std::string, std::size_t>> counts;
  for (std::size_t r = 0; r < target_of.size(); ++r) {
    if (target_of[r] < 0) continue;
    const std::string& name = source.residues[r].chain;
    if (counts.find(name) == counts.end()) order.push_back(name);
    ++counts[name][target.residues[static_cast<std::size_t>(target_of[r])].chain];
  }
  std::vector<ComparedChains> chains;
  for (const std::string& name : order) {
    const auto& of = counts[name];
    const auto most =
        std::max_element(of.begin(), of.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    chains.push_back({name, most->first, most->second});
  }
  return chains;
}

std::vector<std::vector<std::string>> repeated_chains(const Molecule& molecule) {
  const std::vector<NamedChain> chains = named_chains(molecule);
  std::vector<bool> taken(chains.size(), false);
  std::vector<std::vector<std::string>> groups;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    CancelRequest().check();
    if (taken[i]) continue;
    std::vector<std::string> group{chains[i].name};
    for (std::size_t j = i + 1; j < chains.size(); ++j) {
      if (taken[j] || !are_copies(chains[i].letters, chains[j].letters)) continue;
      taken[j] = true;
      group.push_back(chains[j].name);
    }
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

std::string in_words(const std::vector<ComparedChains>& chains) {
  const auto named = [](const std::string& name) { return name.empty() ? std::string("(no name)") : name; };
  std::string text;
  for (const ComparedChains& chain : chains)
    text += (text.empty() ? "" : ", ") + named(chain.source) + " with " + named(chain.target);
  return text;
}

}  // namespace espdiff
