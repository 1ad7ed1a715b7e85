// potential_series.cpp: computes the potentials of a molecule's frames in one common frame, and averages them.
#include "potential/potential_series.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "align/geometry/superpose.h"
#include "align/geometry/unwrap.h"
#include "align/pair_atoms.h"
#include "base/error.h"
#include "base/molecule/water.h"
#include "engine/engine.h"
#include "mapping/map_recipe.h"

namespace espdiff {
namespace {

void check_options(const PotentialOptions& o) {
  if (o.pme.compatible && o.align != AlignAtoms::kNone)
    throw InputError("`compatible` with superposition: PMEPot has none; leave one out");
  if (o.pme.compatible && o.method != PotentialMethod::kPme)
    throw InputError("`compatible` with another potential than pme: it is about PMEPot; leave one out");
  if (o.cell && o.pad_A) throw InputError("a cell and a padding were given; leave one out");
}

RigidTransform onto(const std::vector<Vec3d>& moving, const std::vector<Vec3d>& fixed) {
  std::vector<std::pair<std::size_t, std::size_t>> same;
  for (std::size_t i = 0; i < moving.size(); ++i) same.emplace_back(i, i);
  return superpose(moving, fixed, same).transform;
}

}  // namespace

/// The first frame, which later frames are superposed on.
struct PotentialSeries::FirstFrame {
  std::size_t n_atoms = 0;
  std::vector<std::size_t> atoms;  ///< of the superposition; none without
  std::vector<Vec3d> positions;    ///< [one of these] whole
  PmeCell cell;
  Lattice lattice;
  GridPtr last;  ///< of pb: the last frame's, from which the next one's iteration starts
};

PotentialSeries::PotentialSeries(Engine& engine, PotentialOptions options)
    : engine_(engine),
      options_(std::move(options)),
      // PMEPot has one cell for all frames.
      one_lattice_(options_.align == AlignAtoms::kNone && (options_.cell.has_value() || options_.pme.compatible)),
      average_(options_.frames_per_block) {
  check_options(options_);
}

PotentialSeries::~PotentialSeries() = default;

/// Whole, where the cell's border may have cut the molecule.
std::vector<Vec3d> PotentialSeries::superposed_atoms(const Molecule& frame,
                                                     const std::optional<UnitCell>& own_cell) const {
  std::vector<Vec3d> atoms;
  for (const std::size_t i : first_->atoms) atoms.push_back(frame.positions[i]);
  const bool is_periodic = options_.cell || (own_cell && !options_.pad_A);
  if (atoms.empty() || !is_periodic) return atoms;
  return unwrapped(atoms, choose_cell(options_, frame.positions, own_cell).edges, first_->positions);
}

Grid PotentialSeries::compute(const std::vector<Vec3d>& positions, const Molecule& frame, const PmeCell& cell,
                              const Progress& progress) const {
  const bool is_first = first_->lattice.size[0] == 0;
  if (options_.method == PotentialMethod::kCoulomb) {
    if (is_first) first_->lattice = lattice_over(cell, choose_grid_size(cell, options_.grid, false));
    return engine_.download(
        engine_.coulomb_potential(positions, frame.charges, first_->lattice, options_.coulomb, progress));
  }
  if (options_.method == PotentialMethod::kPoissonBoltzmann) {
    if (frame.radii.size() != positions.size())
      throw InputError(frame.name + ": Poisson-Boltzmann needs the atoms' radii; give a PQR file");
    if (is_first)
      first_->lattice = poisson_boltzmann_lattice(positions, frame.radii, options_.pb_spacing_A, options_.pb_padding_A);
    first_->last = engine_.poisson_boltzmann(positions, frame.radii, frame.charges, first_->lattice, options_.pb, {},
                                             first_->last, progress, nullptr);
    return engine_.download(first_->last);
  }
  PmeOptions pme = options_.pme;
  pme.size = choose_grid_size(cell, options_.grid, pme.compatible);
  pme.smooth_samples = !one_lattice_ && !is_first;
  const GridPtr map = engine_.pme_potential(positions, frame.charges, cell, pme, {}, progress);
  if (pme.smooth_samples) return engine_.download(engine_.resample(map, first_->lattice));
  Grid grid = engine_.download(map);
  first_->lattice = grid.lattice;
  return grid;
}

Grid PotentialSeries::next_map(const Molecule& frame, const std::optional<UnitCell>& own_cell,
                               const Progress& progress) {
  require_charges(frame);
  if (!first_) {
    auto first = std::make_unique<FirstFrame>();
    first->n_atoms = frame.size();
    if (options_.align != AlignAtoms::kNone) {
      AtomPairing same;
      for (std::size_t i = 0; i < frame.size(); ++i) {
        const Residue& residue = frame.residues[static_cast<std::size_t>(frame.atoms[i].residue)];
        if (!is_water_name(residue.name)) same.pairs.emplace_back(i, i);
      }
      for (const auto& pair : select_pairs(same, frame, options_.align)) first->atoms.push_back(pair.first);
    }
    first_ = std::move(first);
    first_->positions = superposed_atoms(frame, own_cell);
    first_->cell = choose_cell(options_, frame.positions, own_cell);
    if (options_.around_aligned && !first_->positions.empty()) first_->cell.centre = middle_of(first_->positions);
  } else if (frame.size() != first_->n_atoms) {
    throw InputError(frame.name + ": a frame of " + std::to_string(frame.size()) + " atoms after one of " +
                     std::to_string(first_->n_atoms) + "; frames must be of one molecule");
  }
  RigidTransform to_first;
  std::vector<Vec3d> turned;
  if (options_.align != AlignAtoms::kNone) {
    to_first = onto(superposed_atoms(frame, own_cell), first_->positions);
    turned = frame.positions;
    for (Vec3d& p : turned) p = to_first.apply(p);
  }
  const std::vector<Vec3d>& positions = options_.align != AlignAtoms::kNone ? turned : frame.positions;
  PmeCell cell = first_->cell;
  const bool is_periodic = options_.cell || (own_cell && !options_.pad_A);
  if (!one_lattice_) {
    // A periodic cell turns with its atoms; a box around them is made anew along the first frame's axes.
    cell = choose_cell(options_, is_periodic ? frame.positions : positions, own_cell);
    if (is_periodic) {
      cell.centre = to_first.apply(cell.centre);
      for (Vec3d& edge : cell.edges) edge = to_first.rotate(edge);
      if (options_.around_aligned) cell.centre = first_->cell.centre;  // a periodic potential does not depend on it
    }
  }
  Grid map = compute(positions, frame, cell, progress);
  // The samples of another cell are not periodic on this lattice.
  map.periodic = options_.method == PotentialMethod::kPme && same_lattice(map.lattice, first_->lattice) &&
                 (one_lattice_ || average_.n_frames() == 0);
  map.name = frame.name + (options_.method == PotentialMethod::kPme       ? " (PME)"
                           : options_.method == PotentialMethod::kCoulomb ? " (Coulomb)"
                                                                          : " (Poisson-Boltzmann)");
  return map;
}

Grid PotentialSeries::step(const Molecule& frame, const std::optional<UnitCell>& own_cell, const Progress& progress) {
  Grid map = next_map(frame, own_cell, progress);
  average_.add(map);
  return map;
}

void PotentialSeries::add(const Molecule& frame, const std::optional<UnitCell>& own_cell, const Progress& progress) {
  average_.add(next_map(frame, own_cell, progress));
}

Grid potential_map(Engine& engine, const Molecule& molecule, const PotentialOptions& options,
                   const Progress& progress) {
  PotentialSeries series(engine, options);
  return series.step(molecule, std::nullopt, progress);
}

}  // namespace espdiff
