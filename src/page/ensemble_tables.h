// ensemble_tables.h: an ensemble's numbers in words: sections, tables, patches and residues of its page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/files/read_csv.h"
#include "io/vtk/read_vtp.h"

namespace espdiff {

/// How the groups are called; empty names where there is no second group.
struct EnsembleNames {
  std::string source, target, unit, regressed, confidence;  ///< unit of the values; confidence in per cent
  std::string field;                                        ///< its name; empty for the potential
  std::string quantity = "potential";                       ///< in words

  /// A label whose "{source}", "{target}", "{regressed}", "{quantity}" and "{confidence}" are replaced.
  std::string filled(const std::string& label) const;
  /// The array of the field that is there in place of the potential's, such as "potential_source".
  std::string of_quantity(const std::string& array_of_potential) const;
  /// The states, and the field where there is one.
  std::string title(const std::string& states) const { return field.empty() ? states : states + ": " + quantity; }
};

EnsembleNames names_of(const nlohmann::ordered_json& record, const VtpContent& surface);

/// `verdict` (the conclusion; trustworthy where the runs sample an equilibrium, with the reasons why not) and
/// `warnings`.
void add_verdict(nlohmann::ordered_json& page, const nlohmann::ordered_json& record);

/// [{title, rows: [{label, help, value}]}]
nlohmann::ordered_json number_sections(const nlohmann::ordered_json& record, const EnsembleNames& names);

/// [{title, columns, rows of texts}]: the replicates.
nlohmann::ordered_json ensemble_tables(const nlohmann::ordered_json& record, const EnsembleNames& names);

/// [{area, difference, p, residues}] as texts, in the order of OUT.json; empty without patches.
nlohmann::ordered_json patch_rows(const nlohmann::ordered_json& record, const EnsembleNames& names);

/// {columns, names, rows} of OUT.residues.csv.
/// @throws FormatError (no column `residue`)
nlohmann::ordered_json residue_table(const CsvTable& table, const EnsembleNames& names);

/// [[name, text]]
nlohmann::ordered_json ensemble_provenance(const nlohmann::ordered_json& record);

}  // namespace espdiff
