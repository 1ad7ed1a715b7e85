// settings.h: every setting of a comparison by name, once for the command line, the Tcl commands and their manuals.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "compare/options.h"

namespace espdiff {

enum class SettingKind { kNumber, kInteger, kBoolean, kChoice, kText };

/// One setting. Its name is the option's: `--grid-spacing 1` on the command line, `-grid-spacing 1` in Tcl.
struct Setting {
  std::string name;
  std::string group;  ///< heading under which manuals list it
  SettingKind kind = SettingKind::kNumber;
  std::vector<std::string> choices;  ///< of a choice
  std::string help;
  bool of_surface = false;  ///< one molecule's surface depends on it
  /// Takes the value written in the text.
  /// @throws InputError that names the setting, the text and what is accepted
  std::function<void(CompareOptions&, const std::string&)> set;
  /// The value as text that set() takes.
  std::function<std::string(const CompareOptions&)> get;
  std::string unit = "";  ///< "A", "K", "A2": ends the name of its key in OUT.json

  /// Its key in OUT.json: "grid_spacing_A".
  std::string key() const;
};

/// All settings, in the order in which manuals list them.
const std::vector<Setting>& settings();

/// Every setting's value as text, by name.
std::vector<std::pair<std::string, std::string>> setting_texts(const CompareOptions& options);

/// @throws InputError when there is none of that name; for an earlier name the message gives the present one
const Setting& find_setting(const std::string& name);

/// A setting's earlier name, refused with the present one until 1.0.
struct RenamedSetting {
  std::string old_name, name;
};
const std::vector<RenamedSetting>& renamed_settings();

/// The setting that takes the thesis' iteration as it stands as the base of all others.
constexpr const char* kThesisSetting = "thesis";

/// Options from the settings that were given; the others keep their defaults, or with `thesis` the thesis' values. The
/// order does not matter.
/// @throws InputError as Setting::set, find_setting
CompareOptions make_options(const std::vector<std::pair<std::string, std::string>>& given);

}  // namespace espdiff
