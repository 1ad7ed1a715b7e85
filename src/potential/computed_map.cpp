// computed_map.cpp: charges, cell and grid of a potential that is computed for a comparison.
#include "potential/computed_map.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "engine/engine.h"
#include "io/sha256.h"

namespace espdiff {
namespace {

const char* origin_of_cell(const PotentialOptions& options, bool has_own) {
  if (options.cell) return "given";
  return has_own && !options.pad_A ? "its own" : "padded";
}

template <typename T>
void add(Sha256& hash, const std::vector<T>& values) {
  hash.update(values.data(), values.size() * sizeof(T));
}

}  // namespace

std::string usual_grid(bool compatible) { return compatible ? "0.5" : "1"; }

ComputedMap::ComputedMap(Molecule charges, const std::optional<UnitCell>& own_cell, const PotentialOptions& options) {
  if (options.method != PotentialMethod::kPme)
    throw InputError("a comparison computes potentials by pme; `espdiff potential` writes those of other methods");
  if (options.cell && options.pad_A) throw InputError("a cell and a padding were given; leave one out");
  require_charges(charges);
  recipe_.charges_from = charges.name;
  recipe_.n_charges = static_cast<std::size_t>(
      std::count_if(charges.charges.begin(), charges.charges.end(), [](float q) { return q != 0; }));
  for (const float q : charges.charges) recipe_.net_charge += static_cast<double>(q);
  recipe_.cell_from = origin_of_cell(options, own_cell.has_value());
  recipe_.cell = choose_cell(options, charges.positions, own_cell);
  recipe_.pme = options.pme;
  recipe_.pme.size = choose_grid_size(recipe_.cell, options.grid, options.pme.compatible);
  recipe_.pme.smooth_samples = !options.pme.compatible;
  charges_ = std::make_shared<const Molecule>(std::move(charges));
}

std::string ComputedMap::fingerprint() const {
  Sha256 hash;
  add(hash, charges_->positions);
  add(hash, charges_->charges);
  const PmeOptions& o = recipe_.pme;
  hash.update(&recipe_.cell, sizeof recipe_.cell);
  hash.update(o.size.data(), sizeof o.size);
  const double numbers[] = {o.ewald_factor, static_cast<double>(o.order), o.temperature_K,
                            o.precision == Precision::kDouble ? 1.0 : 0.0, o.compatible ? 1.0 : 0.0};
  hash.update(numbers, sizeof numbers);
  return hash.finish();
}

MapMaker ComputedMap::maker() const {
  return [charges = charges_, cell = recipe_.cell, pme = recipe_.pme](Engine& engine, const RigidTransform& to_map,
                                                                      const Progress& progress) {
    return engine.pme_potential(charges->positions, charges->charges, cell, pme, to_map, progress);
  };
}

}  // namespace espdiff
