// array_lines.h: arrays of the mapped surface that follow from others.
#pragma once

#include <vector>

#include "io/files/read_csv.h"
#include "verify/lines.h"
#include "verify/mapped_file.h"

namespace espdiff {

class GaussianAtoms;

/// Counts, and arrays that follow from others.
void add_array_lines(const MappedFile& file, Lines& lines);

/// Units, label and version, which more than one file has.
void add_text_lines(const MappedFile& file, const ResultRecord& record, Lines& lines);

/// Normals against the gradients of the atoms' density.
void add_normal_lines(const MappedFile& file, const GaussianAtoms& source, const GaussianAtoms& target, Lines& lines);

/// Names and numbers of residues against those of the source.
void add_residue_name_lines(const MappedFile& file, const CsvTable& table, const std::vector<Residue>& residues,
                            Lines& lines);

}  // namespace espdiff
