// averaged_endpoint.cpp: a potential that was averaged over frames, as an endpoint's map.
#include "averaged_endpoint.h"

#include <cmath>

#include "base/error.h"
#include "mapping/map_recipe.h"
#include "tcl_values.h"
#include "vmdplugin/bridge/fingerprint.h"
#include "vmdplugin/bridge/volume_store.h"

namespace espdiff::vmdplugin {

void take_averaged_map(DictReader& reader, const std::string& volume, const std::string& role, State& state) {
  const std::string what = role + " map";
  MapRecipe recipe;
  recipe.method = PotentialMethod::kPme;
  recipe.because = reader.text("because");
  recipe.charges_from = reader.text("name", volume);
  recipe.n_frames = to_int(reader.require("mean_over"), what + ": mean_over");
  recipe.has_water = reader.boolean("water", false);
  recipe.cell_from = "its own";
  for (Tcl_Obj* const charge : to_vector(reader.require("charges"), what + ", charges")) {
    const double q = to_double(charge, what + ", charge");
    recipe.net_charge += q;
    if (q != 0) ++recipe.n_charges;
  }
  // As `potential` makes it: by default the smooth part.
  recipe.pme =
      make_potential_options(recipe.method, take_potential_settings(reader), PmeOptions().temperature_K, true).pme;
  reader.finish();
  std::optional<Grid> mean = take_volume(volume);
  if (!mean) throw InputError(what + ": no volume named '" + volume + "' is in memory");
  const Lattice& lattice = mean->lattice;
  recipe.cell.centre = lattice.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    recipe.pme.size[axis] = lattice.size[axis];
    recipe.cell.edges[axis] = static_cast<double>(lattice.size[axis]) * lattice.step[axis];
    recipe.cell.centre += 0.5 * (lattice.size[axis] - 1) * lattice.step[axis];
  }
  state.map_input = {{}, potential_label(recipe), fingerprint(*mean)};
  state.make_map = averaged_map(std::move(*mean), std::move(recipe));
}

}  // namespace espdiff::vmdplugin
