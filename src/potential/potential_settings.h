// potential_settings.h: every option of a computed potential by name, once for the command line, Tcl, the window and
// their manuals.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "compare/settings.h"
#include "potential/potential.h"

namespace espdiff {

/// One option of potentials.
struct PotentialSetting {
  /// In Tcl, `{map {pb KEY VALUE}}`.
  std::string key;
  /// The option of the verbs that compare, without dashes before it: there `grid` could be the surface's.
  std::string option;
  std::vector<PotentialMethod> of;  ///< the potentials that read it
  SettingKind kind = SettingKind::kNumber;
  std::vector<std::string> choices;  ///< of a choice
  std::string help;                  ///< with the unit
  /// Takes the value written in the text.
  /// @throws InputError that names the option, the text and what is accepted
  std::function<void(PotentialOptions&, const std::string&)> set;
  /// The value as text that set() takes; empty where none is set.
  std::function<std::string(const PotentialOptions&)> get;

  /// The option of `espdiff potential`, without dashes before it: PMEPot's name where PMEPot has one.
  std::string map_option() const;
};

/// All of them, in the order in which manuals list them.
const std::vector<PotentialSetting>& potential_settings();

/// @param name a key or an option
/// @throws InputError when there is none of that name
const PotentialSetting& find_potential_setting(const std::string& name);

/// The names and texts that were given.
using GivenPotentialSettings = std::vector<std::pair<std::string, std::string>>;

/// Options of one potential; what is not given keeps its default. Ewald's sum is in full unless `compatible`, since the
/// map is for surfaces.
/// @param on_lattice for a map in a file: coulomb then has a grid and a box, and pme its smooth part, since a grid
/// cannot hold what is near the charges
/// @throws InputError as PotentialSetting::set; for what the potential does not read, which would be ignored in silence
PotentialOptions make_potential_options(PotentialMethod method, const GivenPotentialSettings& given,
                                        double temperature_K, bool on_lattice = false);

/// All that the potential reads, for heads and plans of resumable runs: "pb ionic-strength 0.15 ...".
std::string potential_in_words(const PotentialOptions& options);

}  // namespace espdiff
