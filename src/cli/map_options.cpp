// map_options.cpp: options of maps, given or computed.
#include "cli/map_options.h"

#include "base/error.h"

namespace espdiff::cli {

void add_computed_map_options(CLI::App& p, PotentialRequest& a) {
  add_rows(p, potential_request_settings(), a);
  add_potential_settings(p, a.given, false);
}

void add_map_options(CLI::App& p, MapArguments& a) {
  PairMaps& maps = a;
  add_rows(p, pair_map_settings(), maps);
  add_computed_map_options(p, a);
}

void check_map_options(const MapArguments& a) {
  if (!a.any()) return;
  if (a.potential != "auto")
    throw InputError(option("potential") + " computes both maps; leave out " + option("source-map") + " and " +
                     option("target-map") + ", or " + option("potential"));
  if (!a.given.empty())
    throw InputError(option(a.given.front().first) +
                     " is of computed potentials, and maps were given; leave out one of them");
}

}  // namespace espdiff::cli
