// rigid_domains.cpp: rigid domains: chains, named residues, or a greedy search for rigid blocks.
#include "align/geometry/rigid_domains.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "align/geometry/superpose.h"
#include "base/error.h"

namespace espdiff {
namespace {

using AtomPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// A residue fits a rigid motion that moves it to within this distance of its partner.
constexpr double kTolerance_A = 2.0;
/// Minimum size of a domain.
constexpr std::size_t kLeastInDomain = 20;
/// Length of the stretches that seed the search, and the maximum number of seeds.
constexpr std::size_t kSeed = 10, kMostSeeds = 400;
constexpr int kRounds = 10;
/// Shorter runs within another domain are treated as noise.
constexpr std::size_t kLeastRun = 5;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct Range {
  std::string chain;
  bool any_chain = true;
  long first = 0, last = 0;
};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError(option("domains") + ": '" + text + "' " + why +
                   "; give as-needed, none, local, chains, auto, or residues such as A:1-29,68-117/A:30-67");
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Reads a whole number at *at and moves *at behind it.
bool read_number(const char*& at, long& value) {
  char* end = nullptr;
  if (std::isdigit(static_cast<unsigned char>(*at)) == 0 && *at != '-') return false;
  value = std::strtol(at, &end, 10);
  if (end == at) return false;
  at = end;
  return true;
}

Range parse_range(const std::string& part, const std::string& text) {
  Range range;
  std::string numbers = part;
  const std::size_t colon = part.find(':');
  if (colon != std::string::npos) {
    range.chain = part.substr(0, colon);
    range.any_chain = false;
    numbers = part.substr(colon + 1);
  }
  const char* at = numbers.c_str();
  bool good = read_number(at, range.first);
  range.last = range.first;
  if (good && *at == '-') good = read_number(++at, range.last);
  if (!good || *at != '\0') refuse(text, "has an unreadable range of residues, '" + part + "'");
  if (range.last < range.first) refuse(text, "has a range that ends before it starts, '" + part + "'");
  return range;
}

bool has_no_domains(const std::string& text) {
  return text == kNoDomains || text == kLocalMotions || text == kLocalAsNeeded;
}

/// [domain][range]; empty if the text is one of the keywords.
std::vector<std::vector<Range>> parse(const std::string& text) {
  if (has_no_domains(text) || text == "chains" || text == "auto") return {};
  std::vector<std::vector<Range>> domains;
  for (const std::string& domain : split(text, '/')) {
    domains.emplace_back();
    for (const std::string& part : split(domain, ',')) {
      Range range = parse_range(part, text);
      if (range.any_chain && !domains.back().empty()) {
        range.chain = domains.back().back().chain;
        range.any_chain = domains.back().back().any_chain;
      }
      domains.back().push_back(range);
    }
  }
  return domains;
}

/// [source residue] the pairs of its atoms.
std::vector<AtomPairs> pairs_of_residues(const Molecule& source, const AtomPairs& pairs) {
  std::vector<AtomPairs> of(source.residues.size());
  for (const auto& pair : pairs) of[static_cast<std::size_t>(source.atoms[pair.first].residue)].push_back(pair);
  return of;
}

struct Search {
  const Molecule& source;
  const Molecule& target;
  std::vector<AtomPairs> pairs;  // [source residue]

  /// The pair that represents a residue: its first C-alpha or P, otherwise its first pair.
  std::pair<std::size_t, std::size_t> representative(std::size_t residue) const {
    for (const auto& pair : pairs[residue]) {
      const std::string& name = source.atoms[pair.first].name;
      if (name == "CA" || name == "P") return pair;
    }
    return pairs[residue].front();
  }

  AtomPairs representatives(const std::vector<std::size_t>& residues) const {
    AtomPairs all;
    for (const std::size_t r : residues) all.push_back(representative(r));
    return all;
  }

  double miss(const RigidTransform& motion, std::size_t residue) const {
    const auto [s, t] = representative(residue);
    return norm(motion.apply(source.positions[s]) - target.positions[t]);
  }

  /// The free residues that move with the stretch; empty if its motion is undetermined.
  std::vector<std::size_t> grow(std::vector<std::size_t> block, const std::vector<std::size_t>& free) const {
    for (int round = 0; round < kRounds; ++round) {
      RigidTransform motion;
      try {
        motion = superpose(source.positions, target.positions, representatives(block)).transform;
      } catch (const GeometryError&) {
        return {};
      }
      std::vector<std::size_t> next;
      std::copy_if(free.begin(), free.end(), std::back_inserter(next),
                   [&](std::size_t r) { return miss(motion, r) < kTolerance_A; });
      if (next.size() < 3) return {};
      if (next == block) break;
      block = std::move(next);
    }
    return block;
  }

  std::vector<std::size_t> largest_block(const std::vector<std::size_t>& free) const {
    std::vector<std::size_t> best;
    const std::size_t stride = std::max<std::size_t>(3, free.size() / kMostSeeds);
    for (std::size_t begin = 0; begin + kSeed <= free.size(); begin += stride) {
      const auto first = free.begin() + static_cast<std::ptrdiff_t>(begin);
      const std::vector<std::size_t> seed(first, first + static_cast<std::ptrdiff_t>(kSeed));
      if (source.residues[seed.front()].chain != source.residues[seed.back()].chain) continue;
      std::vector<std::size_t> block = grow(seed, free);
      if (block.size() > best.size()) best = std::move(block);
    }
    return best;
  }

  /// [source residue] its domain; kNone if none of its atoms pair.
  std::vector<std::size_t> domains() const {
    std::vector<std::size_t> domain(source.residues.size(), kNone), free;
    for (std::size_t r = 0; r < pairs.size(); ++r) {
      if (!pairs[r].empty()) free.push_back(r);
    }
    std::vector<RigidTransform> motions;
    while (free.size() >= kLeastInDomain) {
      const std::vector<std::size_t> block = largest_block(free);
      if (block.size() < kLeastInDomain) break;
      for (const std::size_t r : block) domain[r] = motions.size();
      motions.push_back(superpose(source.positions, target.positions, representatives(block)).transform);
      free.erase(std::remove_if(free.begin(), free.end(), [&](std::size_t r) { return domain[r] != kNone; }),
                 free.end());
    }
    if (motions.empty()) return domain;
    for (const std::size_t r : free) {
      domain[r] = 0;
      for (std::size_t k = 1; k < motions.size(); ++k) {
        if (miss(motions[k], r) < miss(motions[domain[r]], r)) domain[r] = k;
      }
    }
    return smoothed(domain);
  }

  /// Removes short runs that interrupt a domain.
  std::vector<std::size_t> smoothed(std::vector<std::size_t> domain) const {
    for (std::size_t begin = 0; begin < domain.size();) {
      std::size_t end = begin + 1;
      const auto& residues = source.residues;
      while (end < domain.size() && domain[end] == domain[begin] && residues[end].chain == residues[begin].chain) ++end;
      if (begin > 0 && end < domain.size() && end - begin < kLeastRun && domain[begin] != kNone &&
          domain[begin - 1] == domain[end] && residues[begin - 1].chain == residues[end].chain && domain[end] != kNone)
        std::fill(domain.begin() + static_cast<std::ptrdiff_t>(begin),
                  domain.begin() + static_cast<std::ptrdiff_t>(end), domain[end]);
      begin = end;
    }
    return domain;
  }
};

std::vector<std::size_t> by_chain(const Molecule& source) {
  std::map<std::string, std::size_t> number;
  std::vector<std::size_t> domain;
  for (const Residue& residue : source.residues)
    domain.push_back(number.emplace(residue.chain, number.size()).first->second);
  return domain;
}

std::vector<std::size_t> by_name(const Molecule& source, const std::string& text,
                                 const std::vector<std::vector<Range>>& ranges) {
  std::vector<std::size_t> domain(source.residues.size(), kNone);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    for (const Range& range : ranges[k]) {
      bool found = false;
      for (std::size_t r = 0; r < source.residues.size(); ++r) {
        const Residue& residue = source.residues[r];
        if (residue.number < range.first || residue.number > range.last) continue;
        if (!range.any_chain && residue.chain != range.chain) continue;
        if (domain[r] != kNone && domain[r] != k)
          refuse(text, "names residue " + residue.chain + ":" + std::to_string(residue.number) + " of " + source.name +
                           " in two domains");
        domain[r] = k;
        found = true;
      }
      if (!found)
        refuse(text, "names residues " + (range.any_chain ? "" : range.chain + ":") + std::to_string(range.first) +
                         "-" + std::to_string(range.last) + ", and " + source.name + " has none of them");
    }
  }
  return domain;
}

}  // namespace

void check_domains(const std::string& text) { parse(text); }

std::vector<RigidDomain> find_domains(const std::string& text, const Molecule& source, const Molecule& target,
                                      const AtomPairs& pairs) {
  const std::vector<std::vector<Range>> ranges = parse(text);
  if (has_no_domains(text)) return {};
  const Search search{source, target, pairs_of_residues(source, pairs)};
  const std::vector<std::size_t> number = text == "chains" ? by_chain(source)
                                          : text == "auto" ? search.domains()
                                                           : by_name(source, text, ranges);
  std::map<std::size_t, RigidDomain> domains;
  for (std::size_t r = 0; r < number.size(); ++r) {
    if (number[r] != kNone) domains[number[r]].residues.push_back(r);
  }
  std::vector<RigidDomain> all;
  for (auto& [k, domain] : domains) {
    AtomPairs own;
    for (const std::size_t r : domain.residues) own.insert(own.end(), search.pairs[r].begin(), search.pairs[r].end());
    try {
      const Superposition fit = superpose(source.positions, target.positions, own);
      domain.motion = fit.transform;
      domain.rmsd_A = fit.rmsd_A;
    } catch (const GeometryError&) {
      if (ranges.empty()) continue;
      refuse(text, "has a domain, " + residue_ranges(source, domain.residues) + ", in which only " +
                       std::to_string(own.size()) +
                       " atoms pair or all lie on a line, so that its motion is not known");
    }
    domain.n_atoms = own.size();
    all.push_back(std::move(domain));
  }
  return all;
}

std::string residue_ranges(const Molecule& molecule, const std::vector<std::size_t>& residues) {
  std::string text, chain;
  for (std::size_t i = 0; i < residues.size();) {
    const Residue& first = molecule.residues[residues[i]];
    std::size_t end = i + 1;
    while (end < residues.size() && molecule.residues[residues[end]].chain == first.chain &&
           molecule.residues[residues[end]].number - molecule.residues[residues[end - 1]].number <= 1 &&
           molecule.residues[residues[end]].number >= molecule.residues[residues[end - 1]].number)
      ++end;
    const Residue& last = molecule.residues[residues[end - 1]];
    if (!text.empty()) text += ",";
    if ((text.empty() || first.chain != chain) && !first.chain.empty()) text += first.chain + ":";
    chain = first.chain;
    text += std::to_string(first.number);
    if (last.number != first.number) text += "-" + std::to_string(last.number);
    i = end;
  }
  return text;
}

}  // namespace espdiff
