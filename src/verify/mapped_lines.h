// mapped_lines.h: what the mapped surface gives against the record: areas, metrics, residues.
#pragma once

#include "io/files/read_csv.h"
#include "verify/lines.h"
#include "verify/mapped_file.h"

namespace espdiff {

/// Areas, metrics (trusted, all), the trusted shares, the quantiles of slip, distortion and irregularity.
void add_mapped_lines(const MappedFile& file, const ResultRecord& record, Lines& lines);

/// The residue table against the vertices, and the correlation of its columns.
void add_residue_lines(const MappedFile& file, const ResultRecord& record, const CsvTable& table, Lines& lines);

}  // namespace espdiff
