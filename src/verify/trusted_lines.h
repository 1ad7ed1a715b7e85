// trusted_lines.h: where a result is trusted, by reasons found again.
#pragma once

#include <cstdint>
#include <map>

#include "io/files/read_csv.h"
#include "verify/lines.h"
#include "verify/mapped_file.h"

namespace espdiff {

/// Where the result is trusted, by reasons found again.
/// @param partner_of by source residue; empty where the atoms were not read
void add_trust_lines(const MappedFile& file, const CsvTable& table,
                     const std::map<std::int32_t, std::int32_t>& partner_of, Lines& lines);

}  // namespace espdiff
