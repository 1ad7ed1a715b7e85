// input_settings.h: the settings of a comparison's input: selections, charges, region.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace espdiff {

struct CompareOptions;
struct InputOptions;
struct PatchRequest;
struct Setting;

/// Appends their rows to the table of settings.
void add_input_settings(std::vector<Setting>& all);

/// Whether one molecule's preparation depends on a setting: which atoms, and how they get charges.
bool is_of_preparation(const Setting& setting);

/// Reads "NAME=SELECTION|NAME=SELECTION".
/// @throws InputError (form, name)
std::vector<PatchRequest> parse_patches(const std::string& text);

/// The parts of a source that results are given for, by the settings: the region, then patches.
std::vector<std::string> part_names(const InputOptions& options);
/// The same of settings as a file has them, by name. @throws as parse_patches()
std::vector<std::string> part_names(const std::vector<std::pair<std::string, std::string>>& settings);

/// @throws InputError for settings that exclude or need each other
void check_input_options(const InputOptions& options);

}  // namespace espdiff
