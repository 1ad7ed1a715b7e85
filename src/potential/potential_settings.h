// potential_settings.h: table of all options of computed potentials, used by the command line, Tcl, the window and
// the manuals.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "options/settings.h"
#include "potential/potential.h"

namespace espdiff {

/// One option of potentials. Its name is the option's of `compare`, `trajectory` and `matrix`.
struct PotentialSetting : OptionRow<PotentialOptions> {
  PotentialSetting(std::string tcl_key, std::vector<PotentialMethod> read_by, OptionRow<PotentialOptions> row)
      : OptionRow(std::move(row)), key(std::move(tcl_key)), of(std::move(read_by)) {}

  std::string key;                  ///< in Tcl, `{map {pb KEY VALUE}}`
  std::vector<PotentialMethod> of;  ///< the potentials that read it

  /// The option of `espdiff potential`, without dashes before it: PMEPot's name where PMEPot has one.
  std::string map_option() const;
};

/// All options, in the manuals' order.
const std::vector<PotentialSetting>& potential_settings();

/// @param name a key or an option
/// @throws InputError when there is none of that name
const PotentialSetting& find_potential_setting(const std::string& name);

/// Names and values that the user gave.
using GivenPotentialSettings = std::vector<std::pair<std::string, std::string>>;

/// Options of one potential; the others keep their defaults. Ewald's sum is full unless `compatible`, since the map is
/// for surfaces.
/// @param on_lattice for a map in a file: coulomb then has a grid and a box, and pme the smooth part, since a grid
/// cannot resolve the potential near charges
/// @throws InputError as PotentialSetting::set; for an option of another potential
PotentialOptions make_potential_options(PotentialMethod method, const GivenPotentialSettings& given,
                                        double temperature_K, bool on_lattice = false);

/// All options of the potential in words, for heads and plans of resumable runs: "pb ionic_strength 0.15 ...".
std::string potential_in_words(const PotentialOptions& options);
/// What potential_in_words() gave, for readers: "Poisson-Boltzmann, 0.15 mol/l". A text that it did not give, such as
/// one of another version, and one of pme, whose label depends on the charges, stay as they are.
std::string short_potential(const std::string& words);

}  // namespace espdiff
