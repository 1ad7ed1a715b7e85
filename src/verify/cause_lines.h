// cause_lines.h: the causes of a difference against their table.
#pragma once

#include <string>

#include "verify/lines.h"

namespace espdiff {

/// The causes against OUT.causes.csv, where there are any.
void add_cause_lines(const std::string& prefix, const ResultRecord& record, Lines& lines);

}  // namespace espdiff
