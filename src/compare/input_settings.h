// input_settings.h: the settings of a comparison's input: selections, charges, region.
#pragma once

#include <vector>

namespace espdiff {

struct InputOptions;
struct Setting;

/// Appends their rows to the table of settings.
void add_input_settings(std::vector<Setting>& all);

/// @throws InputError for settings that exclude or need each other
void check_input_options(const InputOptions& options);

}  // namespace espdiff
