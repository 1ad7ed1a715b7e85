// computed_map.cpp: charges, cell and grid of a potential that is computed for a comparison.
#include "potential/computed_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "base/molecule/water.h"
#include "engine/engine.h"
#include "io/files/sha256.h"
#include "mapping/map_recipe.h"
#include "potential/potential.h"

namespace espdiff {
namespace {

/// Distance of bulk solvent from the solute, and the least fraction of the cell that it must fill.
constexpr double kBulkDistance_A = 10, kLeastBulkFraction = 0.01;

const char* origin_of_cell(const PotentialOptions& options, bool has_own) {
  if (options.cell) return "given";
  return has_own && !options.pad_A ? "its own" : "padded";
}

bool is_water(const Molecule& molecule, std::size_t atom) {
  return is_water_name(molecule.residues[static_cast<std::size_t>(molecule.atoms[atom].residue)].name);
}

template <typename T>
void add(Sha256& hash, const std::vector<T>& values) {
  hash.update(values.data(), values.size() * sizeof(T));
}

std::vector<Vec3d> moved(std::vector<Vec3d> positions, const RigidTransform& transform) {
  for (Vec3d& p : positions) p = transform.apply(p);
  return positions;
}

/// Moves the lattice so that its points are multiples of the spacing. Atoms at the same position in two molecules then
/// have the same place between grid points.
Lattice on_multiples(Lattice lattice) {
  for (int axis = 0; axis < 3; ++axis) {
    const double h = lattice.step[static_cast<std::size_t>(axis)][axis];
    lattice.origin[axis] = h * std::round(lattice.origin[axis] / h);
  }
  return lattice;
}

}  // namespace

struct ComputedMap::Charges {
  Molecule molecule;
  std::vector<Vec3d> solute;
  PotentialOptions options;
  MapRecipe recipe;  ///< what is known before the map is made

  MadeMap pme(Engine& engine, const RigidTransform& to_map, const Progress& progress) const;
  MadeMap coulomb(Engine& engine, const RigidTransform& to_map) const;
  MadeMap poisson_boltzmann(Engine& engine, const RigidTransform& to_map, const MapRequest& request,
                            const Progress& progress) const;
};

MadeMap ComputedMap::Charges::pme(Engine& engine, const RigidTransform& to_map, const Progress& progress) const {
  MadeMap made{nullptr, recipe};
  MapRecipe& r = made.recipe;
  const bool is_padded = r.cell_from == "padded";
  // A padded box is aligned with the common frame, not with the file's axes.
  const RigidTransform to_common = inverse(to_map);
  const std::vector<Vec3d> positions = is_padded ? moved(molecule.positions, to_common) : molecule.positions;
  if (is_padded) r.cell = choose_cell(options, positions, std::nullopt);
  r.pme.size = choose_grid_size(r.cell, options.grid, r.pme.compatible);
  made.map =
      engine.pme_potential(positions, molecule.charges, r.cell, r.pme, is_padded ? RigidTransform() : to_map, progress);
  r.zero = ZeroPlace::kCellMean;
  if (r.has_water && !r.pme.compatible && !solute.empty()) {
    BulkZero bulk;
    const GridPtr in_bulk =
        engine.zero_in_bulk(made.map, is_padded ? moved(solute, to_common) : solute, kBulkDistance_A, &bulk);
    r.bulk_fraction = bulk.fraction;
    if (bulk.fraction >= kLeastBulkFraction) {
      made.map = in_bulk;
      r.zero = ZeroPlace::kBulkSolvent;
      r.subtracted = bulk.mean_there;
    }
  }
  return made;
}

MadeMap ComputedMap::Charges::coulomb(Engine& engine, const RigidTransform& to_map) const {
  return {engine.isolated_charges(molecule.positions, molecule.charges, options.coulomb, to_map), recipe};
}

MadeMap ComputedMap::Charges::poisson_boltzmann(Engine& engine, const RigidTransform& to_map, const MapRequest& request,
                                                const Progress& progress) const {
  MadeMap made{nullptr, recipe};
  MapRecipe& r = made.recipe;
  const std::vector<Vec3d> positions = moved(molecule.positions, inverse(to_map));
  constexpr double kBeyondReading_A = 2;
  const double padding_A = std::max(options.pb_padding_A, request.reach_A + kBeyondReading_A);
  r.pb_lattice = on_multiples(poisson_boltzmann_lattice(positions, molecule.radii, options.pb_spacing_A, padding_A));
  PoissonBoltzmannOptions pb = r.pb;
  pb.keep_operator = request.for_readings;
  try {
    made.map = engine.poisson_boltzmann(positions, molecule.radii, molecule.charges, r.pb_lattice, pb, {},
                                        request.before, progress, &r.pb_report);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {  // the engine knows no names
    throw Error(error.error_class(), molecule.name + ": " + error.message());
  }
  return made;
}

ComputedMap::ComputedMap(Molecule charges, ChargeSurroundings surroundings, const PotentialOptions& options) {
  if (options.cell && options.pad_A) throw InputError("a cell and a padding were given; leave one out");
  require_charges(charges);
  auto all = std::make_shared<Charges>();
  all->options = options;
  all->solute = std::move(surroundings.solute);
  MapRecipe& r = all->recipe;
  r.method = options.method;
  r.because = options.because;
  r.charges_from = charges.name;
  r.n_charges = static_cast<std::size_t>(
      std::count_if(charges.charges.begin(), charges.charges.end(), [](float q) { return q != 0; }));
  for (const float q : charges.charges) r.net_charge += static_cast<double>(q);
  r.has_water = surroundings.has_water;
  for (std::size_t i = 0; i < charges.atoms.size(); ++i)
    r.has_water = r.has_water || (charges.charges[i] != 0 && is_water(charges, i));
  if (all->solute.empty()) {
    for (std::size_t i = 0; i < charges.atoms.size(); ++i) {
      if (!is_water(charges, i)) all->solute.push_back(charges.positions[i]);
    }
  }
  r.pme = options.pme;
  r.pme.smooth_samples = !options.pme.compatible;
  r.coulomb = options.coulomb;
  r.pb = options.pb;
  r.pb_spacing_A = options.pb_spacing_A;
  if (options.method == PotentialMethod::kPme) {
    r.cell_from = origin_of_cell(options, surroundings.cell.has_value());
    r.cell = choose_cell(options, charges.positions, surroundings.cell);  // a padded one is made again in pme()
    r.pme.size = choose_grid_size(r.cell, options.grid, options.pme.compatible);
    r.zero = ZeroPlace::kCellMean;
  }
  if (options.method == PotentialMethod::kPoissonBoltzmann) {
    if (r.has_water)
      throw InputError(charges.name +
                       ": water is among the atoms, and Poisson-Boltzmann has a continuum in its place; leave water "
                       "out, or take the potential pme");
    if (charges.radii.size() != charges.size())
      throw InputError(charges.name + ": Poisson-Boltzmann needs the atoms' radii; give a PQR file");
  }
  all->molecule = std::move(charges);
  charges_ = std::move(all);
}

const MapRecipe& ComputedMap::recipe() const { return charges_->recipe; }

std::string ComputedMap::fingerprint() const {
  Sha256 hash;
  const MapRecipe& r = charges_->recipe;
  add(hash, charges_->molecule.positions);
  add(hash, charges_->molecule.charges);
  std::vector<double> numbers{static_cast<double>(r.method), r.pme.temperature_K};
  if (r.method == PotentialMethod::kPme) {
    const PmeOptions& o = r.pme;
    hash.update(&r.cell, sizeof r.cell);
    hash.update(o.size.data(), sizeof o.size);
    add(hash, charges_->solute);
    numbers.insert(numbers.end(), {o.ewald_factor, static_cast<double>(o.order),
                                   o.precision == Precision::kDouble ? 1.0 : 0.0, o.compatible ? 1.0 : 0.0,
                                   o.part == PmePart::kFull ? 1.0 : 0.0, r.cell_from == "padded" ? 1.0 : 0.0});
  } else if (r.method == PotentialMethod::kCoulomb) {
    numbers.insert(numbers.end(), {r.coulomb.dielectric, r.coulomb.distance_dependent ? 1.0 : 0.0});
  } else {
    const PoissonBoltzmannOptions& o = r.pb;
    add(hash, charges_->molecule.radii);
    numbers.insert(
        numbers.end(),
        {o.solute_dielectric, o.solvent_dielectric, o.ionic_strength, o.ion_radius_A, o.probe_radius_A,
         o.gaussian_sigma, o.temperature_K, static_cast<double>(o.dielectric_boundary),
         static_cast<double>(o.far_boundary), static_cast<double>(o.smoothing), o.nonlinear ? 1.0 : 0.0, o.tolerance,
         static_cast<double>(o.max_cycles), charges_->options.pb_spacing_A, charges_->options.pb_padding_A});
  }
  hash.update(numbers.data(), numbers.size() * sizeof(double));
  return hash.finish();
}

MapMaker averaged_map(Grid mean, MapRecipe recipe) {
  recipe.made = true;
  recipe.zero = ZeroPlace::kCellMean;
  return [grid = std::make_shared<const Grid>(std::move(mean)), recipe = std::move(recipe)](
             Engine& engine, const RigidTransform& to_map, const MapRequest&, const Progress&) {
    return MadeMap{engine.upload_map(*grid, to_map), recipe, nullptr};
  };
}

MapMaker ComputedMap::maker() const {
  return [charges = charges_](Engine& engine, const RigidTransform& to_map, const MapRequest& request,
                              const Progress& progress) {
    MadeMap made = charges->recipe.method == PotentialMethod::kPme ? charges->pme(engine, to_map, progress)
                   : charges->recipe.method == PotentialMethod::kCoulomb
                       ? charges->coulomb(engine, to_map)
                       : charges->poisson_boltzmann(engine, to_map, request, progress);
    made.recipe.made = true;
    made.charges = std::shared_ptr<const Molecule>(charges, &charges->molecule);
    return made;
  };
}

}  // namespace espdiff
