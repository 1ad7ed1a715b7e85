// metrics.h: every number that a comparison gives, once for files, tables, plots, Tcl and the window.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/molecule/quantity.h"
#include "engine/certificate_stage.h"

namespace espdiff {

struct CompareOptions;
struct CompareResult;
struct FieldResult;
struct MeasuredSurface;
struct ResidueRow;

/// What a result has numbers of besides the whole surface and the potential: region and patches by name, and fields.
struct PartsAndFields {
  PartsAndFields() = default;
  PartsAndFields(std::vector<std::string> names_of_parts, std::vector<Quantity> fields_compared = {})
      : parts(std::move(names_of_parts)), fields(std::move(fields_compared)) {}
  bool operator<(const PartsAndFields& other) const;

  std::vector<std::string> parts;  ///< names as part_names() gives them
  std::vector<Quantity> fields;
};

/// What the values of a metric are in.
enum class MetricUnit { kPotential, kAngstrom, kSquareAngstrom, kFraction, kIndex, kCount };

/// Heading under which the printed table and the window list a metric. Metrics of kPotential have values only where
/// potentials were compared.
enum class MetricSection { kSuperposition, kPotential, kShape, kSurface, kCertificate, kMapping };

/// Properties of a metric, added up.
enum MetricFlag : unsigned {
  kInSeries = 1,       ///< a column of a trajectory's CSV file
  kInMatrix = 2,       ///< a table of a matrix
  kAntisymmetric = 4,  ///< the value of target to source is its negative; otherwise it should be the same
  kRemovable = 8,      ///< 0 by construction where Certificate::zero_by_construction
};

/// Where the value of a metric comes from: a measured surface, whole or part, the row of a residue, or both.
struct MetricSource {
  using OfResult = double (*)(const MeasuredSurface&);

  MetricSource(OfResult result) : of_result(result) {}
  /// Over the trusted area; the printed table and OUT.json also show it over all triangles.
  MetricSource(double Metrics::*area, double ResidueRow::*residue = nullptr) : of_area(area), of_residue(residue) {}
  MetricSource(double ResidueRow::*residue) : of_residue(residue) {}

  OfResult of_result = nullptr;
  double Metrics::*of_area = nullptr;
  double ResidueRow::*of_residue = nullptr;
};

/// One row of the table. Adding one is all that JSON, CSV files, the printed table, plots, Tcl and the window need.
struct Metric {
  const char* name;   ///< of columns, and in Tcl: "mean_abs_difference"
  const char* label;  ///< for axes and tables: "Mean absolute difference"
  MetricSection section;
  MetricUnit unit;
  unsigned flags;
  const char* help;  ///< one sentence
  MetricSource source;
  /// JSON pointer in OUT.json; "/NAME" where it is empty. An entry of `not_checked` nulls the object of that name.
  const char* json = "";
  /// Metrics that follow one another with the same line share one in the printed table, distinguished by `word`.
  const char* line = "";
  const char* word = "";
  const char* part = "";        ///< the region (kRegionPart) or patch whose value it is; empty for the whole
  const char* field = "";       ///< the field whose value it is; empty for the potential
  const char* field_unit = "";  ///< of that field

  bool has_result() const { return source.of_result != nullptr || source.of_area != nullptr; }
  bool has_residues() const { return source.of_residue != nullptr; }
  std::string json_pointer() const { return *json != '\0' ? json : std::string("/") + name; }
};

/// All of them, in the order of files and tables.
const std::vector<Metric>& metrics();
/// Adds a row. Before anything is computed or written: columns are fixed from then on.
/// @throws Error (kInternal) when the name is taken
void add_metric(const Metric& metric);
/// What a region or a patch has of the metrics: all for whole results but those of the mapping and of checks that are
/// not made of parts. Named `PART_NAME`, labelled "LABEL, PART"; in OUT.json at the same place under part_pointer().
const std::vector<Metric>& part_metrics(const std::string& part);
/// "/region", or "/fixed_patches/PATCH".
std::string part_pointer(const std::string& part);
/// What a field has of the metrics, of the whole or of a part: the differences, their correlation, and where the
/// field's sign means something, the area whose sign changes and Hodgkin's index. Named `FIELD_NAME` and
/// `PART_FIELD_NAME`; in OUT.json under field_pointer().
const std::vector<Metric>& field_metrics(const Quantity& field, const std::string& part = "");
/// "/fields/FIELD", or of a part "/region/fields/FIELD".
std::string field_pointer(const std::string& field, const std::string& part = "");
/// Of a result, and of what options ask for. @throws as make_fields()
PartsAndFields parts_and_fields(const CompareResult& result);
PartsAndFields parts_and_fields(const CompareOptions& options);
/// The metrics of fields, and of fields on parts, field by field.
std::vector<Metric> all_field_metrics(const PartsAndFields& compared);
/// What the residues of a result have: metrics, then those of its fields.
std::vector<Metric> residue_metrics(const CompareResult& result);
/// Null where it was not compared.
const FieldResult* field_of(const MeasuredSurface& result, const std::string& name);
/// Null when there is none of that name.
const Metric* find_metric_or_null(const std::string& name);

/// The metric of a column: of the whole, of a field (or of it on a part), or of a part ("site_mean_abs_difference").
/// Null where it is none.
const Metric* metric_of_column(const std::string& name, const std::vector<Quantity>& fields = {});

/// The number for the whole comparison, or for one of its parts; NaN where there is none. The metric
/// has_result().
double value_of(const Metric& metric, const CompareResult& result);
/// The number for one surface, whatever part the metric is of.
double value_on(const Metric& metric, const MeasuredSurface& surface);
/// Over all triangles with samples, trusted or not; NaN where there is none.
double value_over_all_triangles(const Metric& metric, const MeasuredSurface& surface);
/// The number for one residue; NaN where it has no surface that is counted. The metric has_residues().
double value_of(const Metric& metric, const CompareResult& result, const ResidueRow& row);
/// Whether the certificate says that this was not checked.
bool is_unchecked(const Metric& metric, const MeasuredSurface& surface);

/// "kT/e", "A", "A^2", or empty for what is a mere number.
std::string unit_of(const Metric& metric, const std::string& potential_unit);
/// How people read the values: fractions as percent, lengths in A.
struct ShownUnit {
  std::string unit;
  double factor = 1;
};
ShownUnit shown_unit(const Metric& metric, const std::string& potential_unit);
/// A value with its unit as the printed tables write it: "1.234", "12.3 %", "-" for none.
std::string formatted(const Metric& metric, double value);

/// The metrics over the trusted surface. Without potentials, area, displacement and path length come from the
/// residues' rows, and the others are NaN.
Metrics counted_metrics(const MeasuredSurface& surface);

}  // namespace espdiff
