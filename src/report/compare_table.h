// compare_table.h: a comparison's record as a table.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace espdiff {

/// Prints a comparison's record (compare_json()) for a terminal: every number and the certificate. At most 100 columns,
/// units with every number.
void print_table(std::ostream& out, const nlohmann::ordered_json& record);

}  // namespace espdiff
