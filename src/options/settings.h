// settings.h: every setting of a comparison by name, once for the command line, the Tcl commands and their manuals.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/text/option_row.h"

namespace espdiff {

struct CompareOptions;

/// One setting of a comparison.
struct Setting : OptionRow<CompareOptions> {
  Setting(OptionRow<CompareOptions> row) : OptionRow(std::move(row)) {}  // NOLINT(google-explicit-constructor)

  bool of_surface = false;  ///< whether one molecule's surface depends on it
  std::string unit;         ///< "A", "K", "A2": ends the name of its key in OUT.json
  bool is_list = false;     ///< a text of several values, separated by commas; on the command line it may be repeated
  bool is_named = false;    ///< a list of NAME=TEXT, separated by `|`; in Tcl {NAME TEXT ...}
  std::string file_key;     ///< its key in OUT.json where that is not made of its name

  /// Its key in OUT.json: "grid_spacing_A".
  std::string key() const;
};

/// The row, marked as one that the surface depends on.
Setting of_surface(Setting row);

/// Headings of the settings that say which atoms are compared, and where their charges come from.
constexpr const char* kStructureGroup = "Structures";
constexpr const char* kChargeGroup = "Charges";
constexpr const char* kRegionGroup = "Region";

/// All settings, in the order of the manuals.
const std::vector<Setting>& settings();

/// Every setting's value as text, by name.
std::vector<std::pair<std::string, std::string>> setting_texts(const CompareOptions& options);

/// @param what of a run without patches of one state: "a matrix"
/// @throws InputError if the options ask for them
void refuse_patches_of(const CompareOptions& options, const std::string& what);

/// @throws InputError if there is none of that name; for an old name the message gives the new one
const Setting& find_setting(const std::string& name);

/// An old name of a setting, refused with the new one until 1.0.
struct RenamedSetting {
  std::string old_name, name;
};
const std::vector<RenamedSetting>& renamed_settings();

/// The setting that makes the thesis' original iteration the default of all others.
constexpr const char* kThesisSetting = "thesis";

/// Options from the given settings; the others keep their defaults, or the thesis' values with `thesis`. The order does
/// not matter.
/// @throws InputError as Setting::set, find_setting
CompareOptions make_options(const std::vector<std::pair<std::string, std::string>>& given);

}  // namespace espdiff
