// chain_links.cpp: bonds by a search in cells, then what is left by numbers.
#include "align/chain_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace espdiff {
namespace {

constexpr double kLongestBond_A = 2;

/// An atom at which a chain continues.
struct ChainEnd {
  std::size_t residue;
  Vec3d place;
};

using EndCell = std::array<int, 3>;

EndCell end_cell(const Vec3d& p) {
  return {static_cast<int>(std::floor(p.x / kLongestBond_A)), static_cast<int>(std::floor(p.y / kLongestBond_A)),
          static_cast<int>(std::floor(p.z / kLongestBond_A))};
}

/// Links candidates, shortest first: (distance, residue, the residue after it).
void link_shortest(std::vector<std::tuple<double, std::size_t, std::size_t>> candidates, ChainLinks& links) {
  std::sort(candidates.begin(), candidates.end());
  for (const auto& [distance, from, to] : candidates) {
    if (links.next[from] >= 0 || links.previous[to] >= 0) continue;
    links.next[from] = static_cast<std::int32_t>(to);
    links.previous[to] = static_cast<std::int32_t>(from);
  }
}

void link_bonded(const ResidueView& view, ChainLinks& links) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (const auto& [end, end_again, begin] : {std::array{"C", "C", "N"}, std::array{"O3'", "O3*", "P"}}) {
    std::vector<ChainEnd> ends;
    std::map<EndCell, std::vector<ChainEnd>> begins;
    for (std::size_t i = 0; i < view.molecule->size(); ++i) {
      const Atom& atom = view.molecule->atoms[i];
      const ChainEnd here{static_cast<std::size_t>(atom.residue), view.molecule->positions[i]};
      if (atom.name == end || atom.name == end_again) ends.push_back(here);
      if (atom.name == begin) begins[end_cell(here.place)].push_back(here);
    }
    for (const ChainEnd& e : ends) {
      const EndCell c = end_cell(e.place);
      for (int k = 0; k < 9; ++k) {
        // Cells along z follow each other.
        const EndCell first{c[0] + k % 3 - 1, c[1] + k / 3 - 1, c[2] - 1}, last{first[0], first[1], c[2] + 1};
        for (auto cell = begins.lower_bound(first); cell != begins.end() && cell->first <= last; ++cell) {
          for (const ChainEnd& b : cell->second) {
            const double distance = norm(b.place - e.place);
            if (b.residue != e.residue && distance < kLongestBond_A)
              candidates.emplace_back(distance, e.residue, b.residue);
          }
        }
      }
    }
  }
  link_shortest(std::move(candidates), links);
}

Vec3d place_in_chain(const ResidueView& view, std::size_t residue) {
  const std::ptrdiff_t trace = trace_atom(view, residue);
  const std::size_t atom = trace >= 0 ? static_cast<std::size_t>(trace) : view.atoms[residue].front();
  return view.molecule->positions[atom];
}

/// Links the ends that are left to the lowest higher number.
void link_by_number(const ResidueView& view, ChainLinks& links) {
  using Number = std::pair<std::int32_t, char>;
  struct Ends {
    std::vector<std::size_t> last;
    std::map<Number, std::vector<std::size_t>> first;
  };
  std::map<std::pair<std::string, ResidueKind>, Ends> chains;
  std::vector<std::size_t> head(links.next.size());  // of each last residue: the first of its stretch
  for (std::size_t r = 0; r < links.next.size(); ++r) {
    if (!is_polymer(view.kinds[r]) || view.atoms[r].empty()) continue;
    const Residue& residue = view.molecule->residues[r];
    Ends& ends = chains[{residue.chain, view.kinds[r]}];
    if (links.next[r] < 0) ends.last.push_back(r);
    if (links.previous[r] >= 0) continue;
    ends.first[{residue.number, residue.insertion_code}].push_back(r);
    std::size_t last = r;
    while (links.next[last] >= 0) last = static_cast<std::size_t>(links.next[last]);
    head[last] = r;
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (const auto& [name, ends] : chains) {
    for (const std::size_t r : ends.last) {
      const Residue& residue = view.molecule->residues[r];
      const auto after = ends.first.upper_bound({residue.number, residue.insertion_code});
      if (after == ends.first.end()) continue;
      for (const std::size_t b : after->second) {
        if (b != head[r]) candidates.emplace_back(norm(place_in_chain(view, b) - place_in_chain(view, r)), r, b);
      }
    }
  }
  link_shortest(std::move(candidates), links);
}

/// Rings, which have no first residue, come last.
void list_chains(ChainLinks& links) {
  std::vector<bool> listed(links.next.size(), false);
  const auto list_from = [&](std::size_t first) {
    links.chains.emplace_back();
    for (std::size_t r = first; !listed[r]; r = static_cast<std::size_t>(links.next[r])) {
      listed[r] = true;
      links.chains.back().push_back(r);
      if (links.next[r] < 0) break;
    }
  };
  for (std::size_t r = 0; r < listed.size(); ++r) {
    if (links.previous[r] < 0) list_from(r);
  }
  for (std::size_t r = 0; r < listed.size(); ++r) {
    if (!listed[r]) list_from(r);
  }
}

}  // namespace

bool is_polymer(ResidueKind kind) { return kind == ResidueKind::kAminoAcid || kind == ResidueKind::kNucleotide; }

std::ptrdiff_t trace_atom(const ResidueView& view, std::size_t residue) {
  if (!is_polymer(view.kinds[residue])) return -1;
  const char* const name = view.kinds[residue] == ResidueKind::kAminoAcid ? "CA" : "P";
  for (const std::size_t i : view.atoms[residue]) {
    if (view.molecule->atoms[i].name == name) return static_cast<std::ptrdiff_t>(i);
  }
  return -1;
}

ChainLinks chain_links(const ResidueView& view) {
  ChainLinks links{std::vector<std::int32_t>(view.kinds.size(), -1), std::vector<std::int32_t>(view.kinds.size(), -1)};
  link_bonded(view, links);
  link_by_number(view, links);
  list_chains(links);
  return links;
}

}  // namespace espdiff
