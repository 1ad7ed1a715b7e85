// pair_residues.cpp: pairs chains by their sequences, then all other residues by name and number.
#include "align/pair_residues.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "align/align_sequences.h"
#include "align/assign_chains.h"
#include "align/chain_links.h"
#include "align/pair_by_place.h"
#include "base/error.h"
#include "base/progress.h"

namespace espdiff {
namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// A shorter leftover is an insertion, not a chain that may pair.
constexpr std::size_t kMinLeftover = 10;
/// Fraction of the lower self score that related sequences reach; 25 % identical residues give about 0.13.
constexpr double kMinScoreShare = 0.1;
/// Scale of BLOSUM62 in nats: random sequences of lengths n and m reach about ln(n m) / lambda (Karlin and Altschul,
/// Proc. Natl. Acad. Sci. USA 87, 2264 (1990)).
constexpr double kLambda = 0.318;
/// Bonus for the same chain name, as a fraction of the lower self score: a few missing residues must not swap the
/// chains of a dimer.
constexpr double kSameNameShare = 0.1;

/// A chain, or the rest of one: residues with their codes, in file order.
struct Chain {
  std::string name;
  ResidueKind kind = ResidueKind::kAminoAcid;
  std::vector<std::size_t> residues;
  Sequence sequence;
  std::vector<std::int32_t> numbers;

  void append(std::size_t residue, ResidueCode code, std::int32_t number) {
    residues.push_back(residue);
    sequence.push_back(code);
    numbers.push_back(number);
  }
};

/// Splits a molecule's amino acids and nucleotides into chains. Without chain names in the file, a decreasing residue
/// number starts a new chain.
std::vector<Chain> chains_of(const ResidueView& view, SequenceEncoder& encoder) {
  std::vector<Chain> chains;
  std::map<std::pair<std::string, ResidueKind>, std::size_t> open;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    const Residue& residue = view.molecule->residues[r];
    const ResidueKind kind = view.kinds[r];
    if (kind != ResidueKind::kAminoAcid && kind != ResidueKind::kNucleotide) continue;
    const auto [entry, is_new] = open.try_emplace({residue.chain, kind}, chains.size());
    const bool restarts = !is_new && residue.chain.empty() && residue.number < chains[entry->second].numbers.back();
    if (is_new || restarts) {
      entry->second = chains.size();
      chains.push_back({residue.chain, kind, {}, {}, {}});
    }
    chains[entry->second].append(r, encoder.encode(residue.name), residue.number);
  }
  return chains;
}

/// Alignment scores, computed once per pair of sequences: in a large assembly most chains are copies.
class ScoreTable {
 public:
  int score(const Sequence& a, const Sequence& b) {
    if (a == b) return self_score(a);
    const auto [entry, is_new] = scores_.try_emplace({id(a), id(b)}, 0);
    if (is_new) entry->second = alignment_score(a, b);
    return entry->second;
  }

 private:
  std::size_t id(const Sequence& sequence) { return ids_.emplace(sequence, ids_.size()).first->second; }

  std::map<Sequence, std::size_t> ids_;
  std::map<std::pair<std::size_t, std::size_t>, int> scores_;
};

struct Candidate {
  double rank;
  std::size_t source, target;

  bool operator<(const Candidate& other) const {
    return std::tie(other.rank, source, target) < std::tie(rank, other.source, other.target);
  }
};

std::optional<Candidate> consider(const std::vector<Chain>& source, std::size_t i, const std::vector<Chain>& target,
                                  std::size_t j, ScoreTable& scores) {
  const Chain &a = source[i], &b = target[j];
  if (a.kind != b.kind) return std::nullopt;
  const double lower_self = std::min(self_score(a.sequence), self_score(b.sequence));
  const double score = scores.score(a.sequence, b.sequence);
  const double chance =
      std::log(static_cast<double>(a.sequence.size()) * static_cast<double>(b.sequence.size())) / kLambda;
  if (score <= chance || score < kMinScoreShare * lower_self) return std::nullopt;
  return Candidate{score + (a.name == b.name ? kSameNameShare * lower_self : 0.0), i, j};
}

/// Moves the stretches of a chain before, between and after its paired positions to `leftovers`.
void keep_leftovers(const Chain& chain, const std::vector<std::size_t>& paired, std::vector<Chain>& leftovers) {
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= paired.size(); ++k) {
    const std::size_t end = k < paired.size() ? paired[k] : chain.residues.size();
    if (end - begin >= kMinLeftover) {
      Chain part{chain.name, chain.kind, {}, {}, {}};
      for (std::size_t p = begin; p < end; ++p) part.append(chain.residues[p], chain.sequence[p], chain.numbers[p]);
      leftovers.push_back(std::move(part));
    }
    begin = end + 1;
  }
}

/// Aligns the best-matching chains, best first. Unpaired chains and stretches remain in `source` and `target`.
/// @returns whether any residues were paired
bool pair_chains(std::vector<Chain>& source, std::vector<Chain>& target, ScoreTable& scores, IndexPairs& pairs) {
  std::vector<Candidate> candidates;
  const CancelRequest cancel;
  for (std::size_t i = 0; i < source.size(); ++i) {
    cancel.check();
    for (std::size_t j = 0; j < target.size(); ++j) {
      if (const auto candidate = consider(source, i, target, j, scores)) candidates.push_back(*candidate);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> source_taken(source.size(), false), target_taken(target.size(), false);
  std::vector<Chain> source_left, target_left;
  const std::size_t n_before = pairs.size();
  for (const Candidate& best : candidates) {
    if (source_taken[best.source] || target_taken[best.target]) continue;
    source_taken[best.source] = target_taken[best.target] = true;
    const Chain &a = source[best.source], &b = target[best.target];
    std::vector<std::size_t> paired_a, paired_b;
    for (const auto& [p, q] : align_sequences(a.sequence, b.sequence, a.numbers, b.numbers)) {
      pairs.emplace_back(a.residues[p], b.residues[q]);
      paired_a.push_back(p);
      paired_b.push_back(q);
    }
    keep_leftovers(a, paired_a, source_left);
    keep_leftovers(b, paired_b, target_left);
  }
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (!source_taken[i]) source_left.push_back(std::move(source[i]));
  }
  for (std::size_t j = 0; j < target.size(); ++j) {
    if (!target_taken[j]) target_left.push_back(std::move(target[j]));
  }
  source = std::move(source_left);
  target = std::move(target_left);
  return pairs.size() > n_before;
}

/// [source chain name] the target chain that most of its residues pair with.
std::map<std::string, std::string> corresponding_chains(const ResidueView& source, const ResidueView& target,
                                                        const IndexPairs& pairs) {
  std::map<std::string, std::map<std::string, std::size_t>> votes;
  for (const auto& [a, b] : pairs) ++votes[source.molecule->residues[a].chain][target.molecule->residues[b].chain];
  std::map<std::string, std::string> chains;
  for (const auto& [name, counts] : votes) {
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& x, const auto& y) { return x.second < y.second; });
    chains[name] = most->first;
  }
  return chains;
}

/// Unpaired residues of one name, by number.
using Waiting = std::set<std::pair<std::int32_t, std::size_t>>;

/// Takes the residue with the number closest to `number`, the lower one on ties.
std::optional<std::size_t> take_closest(Waiting& waiting, std::int32_t number) {
  if (waiting.empty()) return std::nullopt;
  auto closest = waiting.lower_bound({number, 0});
  if (closest == waiting.end()) {
    --closest;
  } else if (closest != waiting.begin()) {
    const auto below = std::prev(closest);
    const auto distance = [&](std::int32_t n) { return std::abs(static_cast<std::int64_t>(n) - number); };
    if (distance(below->first) <= distance(closest->first)) closest = below;
  }
  const std::size_t residue = closest->second;
  waiting.erase(closest);
  return residue;
}

/// Pairs residues outside sequences: equal numbers in corresponding chains, then the closest number there, then
/// anywhere.
void pair_others(const ResidueView& source, const ResidueView& target, IndexPairs& pairs) {
  const auto chains = corresponding_chains(source, target, pairs);
  const auto chain_in_target = [&](const std::string& name) {
    const auto known = chains.find(name);
    return known == chains.end() ? name : known->second;
  };
  std::vector<std::size_t> open;
  for (std::size_t r = 0; r < source.kinds.size(); ++r) {
    if (source.kinds[r] == ResidueKind::kOther) open.push_back(r);
  }
  // Three rounds, from strict to lax; `key` groups the residues that compete with each other.
  for (const int round : {0, 1, 2}) {
    const auto key = [&](const Residue& residue, const std::string& chain) {
      return std::make_tuple(residue.name, round < 2 ? chain : std::string(), round < 1 ? residue.number : 0);
    };
    std::map<std::tuple<std::string, std::string, std::int32_t>, Waiting> waiting;
    std::set<std::size_t> taken;
    for (const auto& pair : pairs) taken.insert(pair.second);
    for (std::size_t r = 0; r < target.kinds.size(); ++r) {
      const Residue& residue = target.molecule->residues[r];
      if (target.kinds[r] != ResidueKind::kOther || taken.count(r) != 0) continue;
      waiting[key(residue, residue.chain)].emplace(residue.number, r);
    }
    std::vector<std::size_t> still_open;
    for (const std::size_t r : open) {
      const Residue& residue = source.molecule->residues[r];
      const auto same = waiting.find(key(residue, chain_in_target(residue.chain)));
      const auto found = same == waiting.end() ? std::nullopt : take_closest(same->second, residue.number);
      if (found) {
        pairs.emplace_back(r, *found);
      } else {
        still_open.push_back(r);
      }
    }
    open = std::move(still_open);
  }
}

/// About this many points stand for a chain.
constexpr std::size_t kChainPoints = 30;
/// Chains below kMinLeftover residues are assigned to each other where there are at most this many chains.
constexpr std::size_t kMostShort = 100;
/// Equal chains reach this share of the lower self score, and have this share of each other's length.
constexpr double kEqualScore = 0.9, kEqualLength = 0.8;
/// Names pair files in different orders if they pair this many times the residues that the alignment does.
constexpr double kMoreByNames = 1.1;

bool are_equal(const Chain& a, const Chain& b, ScoreTable& scores) {
  const auto shorter = static_cast<double>(std::min(a.residues.size(), b.residues.size())),
             longer = static_cast<double>(std::max(a.residues.size(), b.residues.size()));
  if (a.kind != b.kind || shorter < kEqualLength * longer) return false;
  const int lower_self = std::min(self_score(a.sequence), self_score(b.sequence));
  return scores.score(a.sequence, b.sequence) >= kEqualScore * lower_self;
}

Vec3d place_of(const ResidueView& view, std::size_t residue) {
  for (const std::size_t i : view.atoms[residue]) {
    const std::string& name = view.molecule->atoms[i].name;
    if (name == "CA" || name == "P") return view.molecule->positions[i];
  }
  return view.molecule->positions[view.atoms[residue].front()];
}

IndexPairs aligned_residues(const Chain& a, const Chain& b) {
  IndexPairs pairs;
  for (const auto& [p, q] : align_sequences(a.sequence, b.sequence, a.numbers, b.numbers))
    pairs.emplace_back(a.residues[p], b.residues[q]);
  return pairs;
}

/// Atoms of one name in a short chain's paired residues: its C-alpha atoms may be too few, or lie on a line.
ChainPoints points_of_atoms(const ResidueView& source, const ResidueView& target, const IndexPairs& residues) {
  ChainPoints points;
  for (const auto& [a, b] : residues) {
    std::map<std::string, std::size_t> of_target;
    for (const std::size_t i : target.atoms[b]) of_target.emplace(target.molecule->atoms[i].name, i);
    for (const std::size_t i : source.atoms[a]) {
      const auto same = of_target.find(source.molecule->atoms[i].name);
      if (same == of_target.end() || points.size() >= kChainPoints) continue;
      points.emplace_back(source.molecule->positions[i], target.molecule->positions[same->second]);
    }
  }
  return points;
}

/// Each chain is compared with each: ten thousand with as many are minutes, a hundred thousand hours and 240 GB.
void check_chains(const ResidueView& source, std::size_t n_source, const ResidueView& target, std::size_t n_target) {
  constexpr double kMostPairs = 1e8;
  if (static_cast<double>(n_source) * static_cast<double>(n_target) <= kMostPairs) return;
  throw InputError(source.molecule->name + " has " + std::to_string(n_source) + " chains and " + target.molecule->name +
                   " " + std::to_string(n_target) +
                   ", and each is compared with each (limit 1e8 pairs of chains); choose some by " + option("select") +
                   ", or give the residues of a chain one chain name and rising numbers");
}

/// The chains of both molecules, which of them are equal, and which of the other molecule each pairs with.
struct EqualChains {
  std::vector<Chain> source, target;
  ChainAssignment assignment{};

  EqualChains(const ResidueView& source_view, const ResidueView& target_view, ScoreTable& scores,
              const IndexPairs& pairs) {
    SequenceEncoder encoder;
    source = chains_of(source_view, encoder);
    target = chains_of(target_view, encoder);
    check_chains(source_view, source.size(), target_view, target.size());
    assignment.points.resize(source.size(), std::vector<ChainPoints>(target.size()));
    assignment.target_of.assign(source.size(), -1);
    if (source.size() < 2 || target.size() < 2) return;
    const bool all = source.size() <= kMostShort && target.size() <= kMostShort;
    std::map<std::size_t, std::size_t> chain_of_target, partner(pairs.begin(), pairs.end());
    for (std::size_t j = 0; j < target.size(); ++j) {
      for (const std::size_t r : target[j].residues) chain_of_target[r] = j;
    }
    for (std::size_t i = 0; i < source.size(); ++i) {
      CancelRequest().check();
      std::map<std::size_t, std::size_t> votes;
      for (const std::size_t r : source[i].residues) {
        if (partner.count(r) != 0) ++votes[chain_of_target[partner[r]]];
      }
      std::size_t most = 0;
      for (std::size_t j = 0; j < target.size(); ++j) {
        if (!all && source[i].residues.size() < kMinLeftover) continue;
        if (!are_equal(source[i], target[j], scores)) continue;
        assignment.points[i][j] = points(source_view, source[i], target_view, target[j]);
        if (votes[j] <= most) continue;
        most = votes[j];
        assignment.target_of[i] = static_cast<std::ptrdiff_t>(j);
      }
    }
  }

  /// Whether any chain has a choice.
  bool any_choice() const {
    return std::any_of(assignment.points.begin(), assignment.points.end(), [](const auto& row) {
      return std::count_if(row.begin(), row.end(), [](const ChainPoints& points) { return !points.empty(); }) > 1;
    });
  }

  static ChainPoints points(const ResidueView& source_view, const Chain& a, const ResidueView& target_view,
                            const Chain& b) {
    ChainPoints all;
    const IndexPairs pairs = aligned_residues(a, b);
    if (pairs.size() < kMinLeftover) return points_of_atoms(source_view, target_view, pairs);
    const std::size_t stride = std::max<std::size_t>(1, pairs.size() / kChainPoints);
    for (std::size_t k = 0; k < pairs.size(); k += stride) {
      if (source_view.atoms[pairs[k].first].empty() || target_view.atoms[pairs[k].second].empty()) continue;
      all.emplace_back(place_of(source_view, pairs[k].first), place_of(target_view, pairs[k].second));
    }
    return all;
  }
};

/// Exchanges the pairs of equal chains whose arrangement fits another assignment.
void pair_by_arrangement(const ResidueView& source, const ResidueView& target, ScoreTable& scores,
                         ResiduePairing& pairing) {
  const EqualChains chains(source, target, scores, pairing.pairs);
  if (!chains.any_choice()) return;
  const std::vector<std::ptrdiff_t> best = assign_chains(chains.assignment);
  if (best == chains.assignment.target_of) return;
  std::set<std::size_t> source_done, target_done;
  IndexPairs pairs;
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const Chain &a = chains.source[i], &b = chains.target[static_cast<std::size_t>(best[i])];
    source_done.insert(a.residues.begin(), a.residues.end());
    target_done.insert(b.residues.begin(), b.residues.end());
    const IndexPairs own = aligned_residues(a, b);
    pairs.insert(pairs.end(), own.begin(), own.end());
    if (best[i] != chains.assignment.target_of[i]) pairing.exchanged_chains.emplace_back(a.name, b.name);
  }
  for (const auto& pair : pairing.pairs) {
    if (source_done.count(pair.first) == 0 && target_done.count(pair.second) == 0) pairs.push_back(pair);
  }
  pairing.pairs = std::move(pairs);
}

/// Residues of the polymer with the same chain, number and insertion code, where only one has them on each side, and
/// the same name, or a substituted one.
IndexPairs pair_by_names(const ResidueView& source, const ResidueView& target) {
  using Key = std::tuple<std::string, std::int32_t, char>;
  const auto keys = [](const ResidueView& view) {
    std::map<Key, std::vector<std::size_t>> all;
    for (std::size_t r = 0; r < view.kinds.size(); ++r) {
      const Residue& residue = view.molecule->residues[r];
      if (is_polymer(view.kinds[r])) all[{residue.chain, residue.number, residue.insertion_code}].push_back(r);
    }
    return all;
  };
  const auto of_source = keys(source), of_target = keys(target);
  IndexPairs pairs, substituted;
  for (const auto& [key, residues] : of_source) {
    const auto same = of_target.find(key);
    if (same == of_target.end() || residues.size() > 1 || same->second.size() > 1) continue;
    const std::size_t a = residues.front(), b = same->second.front();
    const bool equal = same_residue_name(source.molecule->residues[a].name, target.molecule->residues[b].name);
    if (equal || source.kinds[a] == target.kinds[b]) (equal ? pairs : substituted).emplace_back(a, b);
  }
  // Where most names agree, the numbers are those of one numbering.
  if (pairs.size() > substituted.size()) pairs.insert(pairs.end(), substituted.begin(), substituted.end());
  return pairs;
}

std::size_t n_same_names(const ResidueView& source, const ResidueView& target, const IndexPairs& pairs) {
  return static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return same_residue_name(source.molecule->residues[pair.first].name, target.molecule->residues[pair.second].name);
  }));
}

/// Whether both molecules have chains of the same names, and list them in different orders.
bool names_are_permuted(const Molecule& source, const Molecule& target) {
  std::vector<std::string> a, b;
  for (std::size_t r = 0; r < source.residues.size(); ++r) {
    const std::string &of_source = source.residues[r].chain, &of_target = target.residues[r].chain;
    if (!a.empty() && a.back() == of_source && b.back() == of_target) continue;
    a.push_back(of_source);
    b.push_back(of_target);
  }
  if (a == b) return false;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

}  // namespace

ResiduePairing pair_residues(const ResidueView& source, const ResidueView& target, PairOthers others) {
  SequenceEncoder encoder;
  std::vector<Chain> source_chains = chains_of(source, encoder), target_chains = chains_of(target, encoder);
  check_chains(source, source_chains.size(), target, target_chains.size());
  ScoreTable scores;
  ResiduePairing pairing;
  while (pair_chains(source_chains, target_chains, scores, pairing.pairs)) {
  }
  IndexPairs by_names = pair_by_names(source, target);
  pairing.by_names = static_cast<double>(n_same_names(source, target, by_names)) >
                     kMoreByNames * static_cast<double>(n_same_names(source, target, pairing.pairs)) + kMinLeftover;
  if (pairing.by_names) {
    pairing.pairs = std::move(by_names);
  } else {
    pair_by_arrangement(source, target, scores, pairing);
  }
  const PolymerMotion motion(source, target, pairing.pairs);
  if (others == PairOthers::kByPlace && motion.known()) {
    const IndexPairs placed = pair_by_place(source, target, motion, pairing.moved);
    pairing.pairs.insert(pairing.pairs.end(), placed.begin(), placed.end());
  } else {
    pair_others(source, target, pairing.pairs);
  }
  std::sort(pairing.pairs.begin(), pairing.pairs.end());
  return pairing;
}

bool order_holds(const ResidueView& source, const ResidueView& target) {
  if (names_are_permuted(*source.molecule, *target.molecule)) return false;
  IndexPairs polymer, others;
  for (std::size_t r = 0; r < source.kinds.size(); ++r) {
    if (source.atoms[r].empty()) continue;
    (is_polymer(source.kinds[r]) ? polymer : others).emplace_back(r, r);
  }
  ScoreTable scores;
  const EqualChains chains(source, target, scores, polymer);
  if (chains.any_choice() && assign_chains(chains.assignment) != chains.assignment.target_of) return false;
  const PolymerMotion motion(source, target, polymer);
  return !motion.known() || in_place(source, target, motion, others);
}

}  // namespace espdiff
