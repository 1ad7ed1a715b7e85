// exported_result.cpp: what all formats take from the files of a comparison.
#include "export/exported_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/printable.h"
#include "base/version.h"
#include "io/files/read_csv.h"
#include "io/structures/run_record.h"
#include "plot/automatic_range.h"
#include "plot/shared_range.h"

namespace espdiff {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The item of that name, or the first of the usual ones where no name is given.
template <typename Items, typename Name>
const typename Items::value_type& chosen(const Items& items, const std::string& name,
                                         const std::vector<const char*>& usual, const std::string& what, Name name_of) {
  std::vector<std::string> wanted(usual.begin(), usual.end());
  if (!name.empty()) wanted = {name};
  for (const std::string& one : wanted) {
    for (const auto& item : items) {
      if (name_of(item) == one) return item;
    }
  }
  std::string there;
  for (const auto& item : items) there += (there.empty() ? "" : ", ") + name_of(item);
  throw InputError(what + " '" + (name.empty() ? usual.back() : name) + "': there are " + there);
}

double limit_of(const std::vector<double>& values) { return automatic_limit({values.begin(), values.end()}); }

/// The widest automatic limit of this surface's array and of those of the other comparisons.
double shared_limit_of(const std::string& array, const std::string& prefix, const std::vector<std::string>& others) {
  std::vector<std::string> surfaces = {prefix + ".vtp"};
  for (const std::string& other : others) surfaces.push_back(other + ".vtp");
  return shared_limits(surfaces).at(array);
}

/// The same of a column of residues.
double shared_residue_limit(double own, const std::string& column, const std::vector<std::string>& others) {
  double limit = own;
  for (const std::string& other : others) {
    const CsvTable table = read_csv(other + ".residues.csv");
    const std::vector<ResidueColumn> columns = residue_columns(table);
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const ResidueColumn& c) { return c.name == column; });
    if (found == columns.end()) throw InputError(table.path + ": no column '" + column + "' to share a scale with");
    std::vector<double> values;
    for (std::size_t r = 0; r < table.rows.size(); ++r) values.push_back(table.number(r, found->index));
    limit = std::max(limit, limit_of(values));
  }
  return limit;
}

void choose_surface_values(ExportedResult& result, const ExportOptions& options) {
  const SurfaceQuantity quantity =
      chosen(surface_quantities(result.files), options.array, {"potential_difference", "displacement"},
             result.files.prefix + ".vtp has no point array", [](const SurfaceQuantity& q) { return q.values->name; });
  result.values = quantity.values->values;
  const double limit = options.limit > 0 ? options.limit
                       : !options.range_of.empty()
                           ? shared_limit_of(quantity.values->name, result.files.prefix, options.range_of)
                           : limit_of(result.values);
  result.scale = {quantity.values->name, quantity.label, quantity.unit, limit, quantity.is_signed, options.colours};
  for (const double value : result.values) result.colours.push_back(result.scale.colour(value));
}

void choose_residue_values(ExportedResult& result, const ExportOptions& options) {
  const CsvTable& table = result.files.residues;
  const ResidueColumn column =
      chosen(residue_columns(table), options.residues, {"mean_abs_difference", "mean_displacement"},
             result.files.prefix + ".residues.csv has no column", [](const ResidueColumn& c) { return c.name; });
  for (std::size_t r = 0; r < table.rows.size(); ++r) result.residue_values.push_back(table.number(r, column.index));
  const bool is_signed =
      std::any_of(result.residue_values.begin(), result.residue_values.end(), [](double value) { return value < 0; });
  const double limit = shared_residue_limit(limit_of(result.residue_values), column.name, options.range_of);
  result.residue_scale = {column.name, column.label, column.unit, limit, is_signed, options.colours};
}

std::string described(const ExportScale& scale) {
  return scale.label + " (" + scale.name + "), " + formatted(scale.low()) + " to " + formatted(scale.limit) +
         (scale.unit.empty() ? "" : " " + scale.unit);
}

void add_notes(ExportedResult& result) {
  auto& notes = result.notes;
  const Verdict verdict = verdict_of(result.files);
  notes.emplace_back("Title", result.title);
  notes.emplace_back("Verdict", verdict.text);
  for (const std::string& reason : verdict.reasons) notes.emplace_back("Reason", reason);
  notes.emplace_back("Surface", described(result.scale));
  notes.emplace_back("Residues", described(result.residue_scale));
  notes.emplace_back("Positions", "Angstrom, in the target's frame");
  notes.emplace_back("Written by", std::string("espdiff ") + kVersion);
  for (const auto& row : provenance_of(result.files)) notes.push_back(row);
  for (auto& [name, text] : notes) text = printable(text);
}

/// Chain, number and insertion code of a residue.
using ResidueKey = std::tuple<std::string, std::string, std::string>;

}  // namespace

Rgb ExportScale::colour(double value) const {
  if (std::isnan(value)) return kNoValueColour;
  return is_signed ? diverging_colour(0.5 + 0.5 * value / limit, diverging_map(colours))
                   : sequential_colour(value / limit, name == "displacement" ? kGreenHue : kOrangeHue);
}

ExportedResult read_exported_result(const std::string& prefix, const ExportOptions& options) {
  diverging_map(options.colours);
  if (!(options.limit >= 0) || !std::isfinite(options.limit))
    throw InputError(option("range", formatted(options.limit)) +
                     ": give a positive number, or 0 for an automatic scale");
  if (options.limit > 0 && !options.range_of.empty())
    throw InputError(option("range-of") + " and " + option("range") +
                     " exclude each other: one of them sets the scale");
  ExportedResult result;
  result.files = read_pair_files(prefix);
  result.title = printable(options.title.empty() ? title_of(result.files) : options.title);
  choose_surface_values(result, options);
  choose_residue_values(result, options);
  result.source = superposed_source(result.files);
  result.triangles = counted_triangles(result.files.surface);
  add_notes(result);
  return result;
}

ExportedMolecule read_exported_molecule(const ExportedResult& result) {
  const CsvTable& table = result.files.residues;
  const RunRecord record = read_run_record(result.files.prefix + ".vtp");
  ExportedMolecule exported;
  exported.molecule = read_compared(
      record, record.source, false,
      "; compare again, or export the surface alone (" + option("to", "glb").plain() + ", ply or blender)");
  for (Vec3d& p : exported.molecule.positions) p = record.source_to_target.apply(p);
  const std::size_t chain = table.require("chain"), number = table.require("residue_number"),
                    code = table.require("insertion_code");
  std::map<ResidueKey, double> values;
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    values[{table.rows[r][chain], table.rows[r][number], table.rows[r][code]}] = result.residue_values[r];
  for (const Atom& atom : exported.molecule.atoms) {
    const Residue& residue = exported.molecule.residues[static_cast<std::size_t>(atom.residue)];
    const auto found = values.find({residue.chain, std::to_string(residue.number),
                                    residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code)});
    exported.values.push_back(found == values.end() ? kNone : found->second);
  }
  return exported;
}

}  // namespace espdiff
