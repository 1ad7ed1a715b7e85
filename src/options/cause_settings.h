// cause_settings.h: the settings of the causes of a difference.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

struct CompareOptions;
struct Setting;

/// Those of the causes of a difference.
void add_cause_settings(std::vector<Setting>& all);

/// @param text the reading as it was given. @throws InputError if no patch of that name is asked for
void require_patch(const CompareOptions& options, const std::string& text, const std::string& name);

/// @throws InputError for causes of a region or patch that is not asked for
void check_readings(const CompareOptions& options);

/// For what makes several results of one kind. @throws InputError where causes are asked for
void refuse_causes(const CompareOptions& options, const char* of_what);

}  // namespace espdiff
