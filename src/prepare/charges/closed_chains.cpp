// closed_chains.cpp: rings of residues by their bonds.
#include "prepare/charges/closed_chains.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "align/chain_links.h"
#include "prepare/charges/preparation.h"

namespace espdiff {
namespace {

/// Whether the residues follow each other in the file, under one chain's name.
bool is_one_chain(const Molecule& molecule, const ClosedChain& chain) {
  return std::is_sorted(chain.begin(), chain.end()) && std::all_of(chain.begin(), chain.end(), [&](std::size_t r) {
           return molecule.residues[r].chain == molecule.residues[chain.front()].chain;
         });
}

void append_atoms(const Molecule& from, const std::vector<std::size_t>& atoms, std::int32_t residue, Molecule& to) {
  for (const std::size_t i : atoms) {
    to.atoms.push_back(from.atoms[i]);
    to.atoms.back().residue = residue;
    to.positions.push_back(from.positions[i]);
    to.radii.push_back(from.radii[i]);
    to.charges.push_back(from.charges[i]);
  }
}

}  // namespace

std::vector<ClosedChain> closed_chains(const Molecule& molecule) {
  constexpr std::size_t kFewest = 4;
  const ChainLinks links = chain_links(ResidueView(molecule));
  std::vector<ClosedChain> closed;
  for (ClosedChain chain : links.chains) {
    if (chain.size() < kFewest || links.next[chain.back()] != static_cast<std::int32_t>(chain.front())) continue;
    std::rotate(chain.begin(), std::min_element(chain.begin(), chain.end()), chain.end());
    if (is_one_chain(molecule, chain)) closed.push_back(std::move(chain));
  }
  return closed;
}

std::vector<std::size_t> from_the_middle(const std::vector<ClosedChain>& chains, std::size_t n_residues) {
  std::vector<std::size_t> order(n_residues);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const ClosedChain& chain : chains) {
    for (std::size_t i = 0; i < chain.size(); ++i) order[chain[i]] = chain[(i + chain.size() / 2) % chain.size()];
  }
  return order;
}

Molecule in_order(const Molecule& molecule, const std::vector<std::size_t>& order) {
  Molecule ordered = molecule;
  std::vector<std::int32_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    ordered.residues[i] = molecule.residues[order[i]];
    place[order[i]] = static_cast<std::int32_t>(i);
  }
  for (Atom& atom : ordered.atoms) atom.residue = place[static_cast<std::size_t>(atom.residue)];
  return ordered;
}

Molecule without_ends(const Molecule& prepared, const Molecule& other, const Molecule& before,
                      const std::vector<ClosedChain>& chains) {
  const auto of_prepared = atoms_of_residues(prepared), of_other = atoms_of_residues(other);
  std::map<ResidueKey, std::size_t> in_other;
  for (std::size_t r = 0; r < other.residues.size(); ++r) in_other.emplace(key_of(other.residues[r]), r);
  std::map<ResidueKey, std::size_t> taken;
  for (const ClosedChain& chain : chains) {
    const std::size_t n = chain.size(), quarter = n / 4;
    for (std::size_t i = 0; i < n; ++i) {
      const auto found = in_other.find(key_of(before.residues[chain[i]]));
      if ((i < quarter || i >= n - quarter) && found != in_other.end()) taken.insert(*found);
    }
  }
  Molecule whole = prepared;
  for (auto* values : {&whole.radii, &whole.charges}) values->clear();
  whole.atoms.clear();
  whole.positions.clear();
  for (std::size_t r = 0; r < prepared.residues.size(); ++r) {
    const auto found = taken.find(key_of(prepared.residues[r]));
    const bool is_taken = found != taken.end();
    append_atoms(is_taken ? other : prepared, is_taken ? of_other[found->second] : of_prepared[r],
                 static_cast<std::int32_t>(r), whole);
  }
  return whole;
}

}  // namespace espdiff
