// surroundings.cpp: trimmed superpositions of neighbouring residues.
#include "input_checks/surroundings.h"

#include <algorithm>
#include <cmath>

#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "base/error.h"

namespace espdiff {
namespace {

constexpr double kSurroundings_A = 13;
constexpr std::size_t kLeastSurroundings = 8, kBesideInChain = 4;
constexpr double kBetterPart = 0.6, kMostMisfit_A = 1.5;
constexpr int kTrims = 3;

/// The residue and up to four on either side of it, along its chain.
std::vector<std::size_t> stretch_around(const ChainLinks& links, std::size_t residue) {
  std::vector<std::size_t> stretch{residue};
  for (const auto* way : {&links.next, &links.previous}) {
    auto r = static_cast<std::int32_t>(residue);
    for (std::size_t k = 0; k < kBesideInChain; ++k) {
      r = (*way)[static_cast<std::size_t>(r)];
      if (r < 0) break;
      stretch.push_back(static_cast<std::size_t>(r));
    }
  }
  return stretch;
}

}  // namespace

Surroundings::Cell Surroundings::cell_of(const Vec3d& p) {
  return {static_cast<int>(std::floor(p.x / kSurroundings_A)), static_cast<int>(std::floor(p.y / kSurroundings_A)),
          static_cast<int>(std::floor(p.z / kSurroundings_A))};
}

Surroundings::Surroundings(const ResidueView& source, const ResidueView& target,
                           const std::vector<std::int32_t>& target_of) {
  for (std::size_t r = 0; r < target_of.size(); ++r) {
    if (target_of[r] < 0) continue;
    const std::ptrdiff_t s = trace_atom(source, r), t = trace_atom(target, static_cast<std::size_t>(target_of[r]));
    if (s < 0 || t < 0) continue;
    cells_[cell_of(source.molecule->positions[static_cast<std::size_t>(s)])].push_back(source_.size());
    source_.push_back(source.molecule->positions[static_cast<std::size_t>(s)]);
    target_.push_back(target.molecule->positions[static_cast<std::size_t>(t)]);
    residue_.push_back(r);
  }
}

std::optional<RigidTransform> Surroundings::motion_around(const Vec3d& point,
                                                          const std::vector<std::size_t>& skipped) const {
  std::vector<std::pair<std::size_t, std::size_t>> near;
  const Cell c = cell_of(point);
  for (int k = 0; k < 27; ++k) {
    const auto cell = cells_.find({c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1});
    if (cell == cells_.end()) continue;
    for (const std::size_t i : cell->second) {
      if (norm(source_[i] - point) > kSurroundings_A) continue;
      if (std::find(skipped.begin(), skipped.end(), residue_[i]) == skipped.end()) near.emplace_back(i, i);
    }
  }
  const auto kept = static_cast<std::size_t>(kBetterPart * static_cast<double>(near.size()));
  if (near.size() < kLeastSurroundings) return std::nullopt;
  try {
    Superposition fit = superpose(source_, target_, near);
    std::vector<std::pair<double, std::size_t>> by_misfit;
    for (int trim = 0; trim < kTrims; ++trim) {
      by_misfit.clear();
      for (const auto& [i, same] : near) by_misfit.emplace_back(norm(fit.transform.apply(source_[i]) - target_[i]), i);
      std::sort(by_misfit.begin(), by_misfit.end());
      std::vector<std::pair<std::size_t, std::size_t>> better;
      for (std::size_t k = 0; k < kept; ++k) better.emplace_back(by_misfit[k].second, by_misfit[k].second);
      fit = superpose(source_, target_, better);
    }
    if (fit.rmsd_A > kMostMisfit_A) return std::nullopt;
    return fit.transform;
  } catch (const GeometryError&) {  // all on a line
    return std::nullopt;
  }
}

PairedMolecules::PairedMolecules(const Molecule& source_molecule, const Molecule& target_molecule,
                                 const AtomPairing& pairing)
    : source(source_molecule),
      target(target_molecule),
      target_of(paired_residues(source_molecule, target_molecule, pairing)),
      source_of(source_residues(target_of, target_molecule.residues.size())),
      source_links(chain_links(source)),
      target_links(chain_links(target)),
      surroundings(source, target, target_of),
      motions(target_of.size()) {
  const auto n = static_cast<std::ptrdiff_t>(target_of.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::ptrdiff_t residue = 0; residue < n; ++residue) {
    const auto r = static_cast<std::size_t>(residue);
    const std::ptrdiff_t trace = trace_atom(source, r);
    if (trace < 0 || target_of[r] < 0) continue;
    motions[r] = surroundings.motion_around(source_molecule.positions[static_cast<std::size_t>(trace)],
                                            stretch_around(source_links, r));
  }
}

}  // namespace espdiff
