// compare_table.cpp: a comparison's record as a table for a terminal, with every number.
#include "report/compare_table.h"

#include <algorithm>
#include <cmath>

#include "align/geometry/rigid_domains.h"
#include "base/formatted.h"
#include "base/text/short_numbers.h"
#include "base/units.h"
#include "certificate/trusted_area.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "report/field_patches_report.h"
#include "report/records/metrics.h"
#include "report/records/record.h"
#include "report/records/record_words.h"
#include "report/records/text_lines.h"
#include "report/sections/interface_report.h"

namespace espdiff {
namespace {

using Json = Record::Json;

/// "1.234 A"
std::string with_unit(const Metric& metric, double value) {
  const std::string unit = unit_of(metric, "");
  return formatted(metric, value) + (unit.empty() ? "" : " " + unit);
}

void print_superposition(std::ostream& out, const Record& record) {
  out << "Superposition\n";
  const std::size_t n_paired = record.count("/n_paired_atoms");
  if (n_paired == 0) {
    print_line(out, "Paired atoms", "none; compared where they lie");
    return;
  }
  print_line(out, "Paired atoms", paired_in_words(record));
  const std::size_t n_superposed = record.count("/superposition/n_superposed_atoms");
  const std::string over = n_superposed > 0 ? "after superposing " + counted(n_superposed, "atom")
                                            : std::string("where they lie, not superposed");
  for (const Metric& metric : metrics()) {
    if (metric.section != MetricSection::kSuperposition) continue;
    print_line(out, metric.label, with_unit(metric, record.value_of(metric)) + " " + over);
  }
  for (const auto& [label, text] : chains_in_words(record)) print_line(out, label, text);
  for (const Json& domain : record.at("/superposition/domains")) {
    const Record r(domain);
    print_line(out, "Rigid domain", formatted("%.4g", r.number("/rmsd_A")) + " A, " + r.text("/residues"));
  }
  for (const Json& note : record.at("/notes")) print_line(out, Record(note).text("/label"), Record(note).text("/text"));
}

/// A row for each metric of the section: over the area that is counted and, with potentials, over all of it.
void print_section(std::ostream& out, const Record& record, MetricSection section) {
  for (const Metric& metric : metrics()) {
    if (metric.section != section || !metric.has_result()) continue;
    std::vector<std::string> values = {formatted(metric, record.value_of(metric))};
    if (record.has_potential() && metric.source.of_area != nullptr)
      values.push_back(formatted(metric, record.value_over_all_triangles(metric)));
    print_row(out, metric.label, unit_of(metric, record.potential_unit()), values);
  }
}

/// The metrics that share a line follow one another.
void print_lines(std::ostream& out, const Record& record, MetricSection section) {
  const std::vector<Metric>& all = metrics();
  const std::vector<std::string> constructed = record.texts("/certificate/zero_by_construction");
  for (std::size_t i = 0; i < all.size();) {
    const Metric& first = all[i];
    std::vector<std::string> values;
    const auto shares_line = [&] {
      return i < all.size() && all[i].section == section && *first.line != '\0' &&
             std::string(all[i].line) == first.line;
    };
    do {
      const std::string word = *all[i].word != '\0' ? std::string(all[i].word) + " " : std::string();
      if (all[i].has_result()) values.push_back(word + formatted(all[i], record.value_of(all[i])));
      ++i;
    } while (shares_line());
    if (first.section != section || record.is_unchecked(first)) continue;
    // Such a line is no evidence, so the reader must know.
    if (std::find(constructed.begin(), constructed.end(), first.name) != constructed.end())
      values.emplace_back(" by construction, see Removed");
    print_row(out, *first.line != '\0' ? first.line : first.label, unit_of(first, record.potential_unit()), values);
  }
}

/// How the map of a side was computed; null for given ones.
const Json* computed_map(const Record& record, const std::string& side) {
  for (const Json& input : record.at("/inputs")) {
    if (Record(input).text("/role") == side + "_map" && input.contains("computed")) return &input.at("computed");
  }
  return nullptr;
}

/// Which potential it is that differs, and what to know of it.
void print_kind_of_potential(std::ostream& out, const Record& record) {
  if (!record.has("/potential")) return;
  out << "\nComputed potential\n";
  print_line(out, "Kind", potential_in_words(record));
  for (const std::string side : {"source", "target"}) {
    const Json* const computed = computed_map(record, side);
    if (computed == nullptr) continue;
    const Record r(*computed);
    std::string text = formatted("%.4g", r.number("/net_charge")) + " e in " +
                       counted(r.count("/n_charges"), "charge") + "; zero " + r.text("/zero");
    if (r.has("/relative_residual"))
      text += (r.has("/surface_error") ? "; error " + formatted("%.1e", r.number("/surface_error"))
                                       : "; residual " + formatted("%.1e", r.number("/relative_residual"))) +
              " after " + counted(r.count("/cycles"), "cycle");
    print_line(out, "Of the " + side, text);
  }
  for (const std::string& note : record.texts("/potential/notes")) print_line(out, "Note", note);
}

/// How given maps compare with the potentials of the molecules' charges.
void print_given_maps(std::ostream& out, const Record& record) {
  if (!record.has("/given_maps/source") && !record.has("/given_maps/target")) return;
  out << "\nGiven maps, against the potentials of the charges\n";
  for (const std::string side : {"source", "target"}) {
    if (!record.has("/given_maps/" + side)) continue;
    const Record check(record.at("/given_maps/" + side));
    print_line(out, "Of the " + side,
               "as in " + check.text("/kind") + ": slope " + formatted("%.3g", check.number("/slope")) +
                   ", correlation " + number_beside(check.number("/correlation"), 1, 3) + " at " +
                   counted(check.count("/n_points"), "point"));
  }
}

void print_metrics(std::ostream& out, const Record& record) {
  if (record.has_potential()) {
    print_kind_of_potential(out, record);
    print_given_maps(out, record);
    const bool vacuum = is_in_vacuum(record.text("/potential_unit"));
    print_heading(out, std::string("Potential") + (vacuum ? kInVacuum : "") + " (target - source)",
                  {"trusted area", "all area"});
    print_section(out, record, MetricSection::kPotential);
    print_line(out, "Mean abs. of the whole surface", whole_surface_in_words(record));
  } else {
    print_heading(out, "Shape (no potentials)", {"trusted area"});
    if (record.has("/shapes_because")) print_line(out, "Because", record.text("/shapes_because"));
  }
  print_section(out, record, MetricSection::kShape);
}

/// A section for each field besides the potential.
void print_fields(std::ostream& out, const Record& record) {
  for (const auto& [name, json] : record.at("/fields").items()) {
    const Record field(json);
    const Quantity quantity{name, field.text("/label"), field.text("/unit"), field.flag("/signed")};
    print_heading(out, "Field " + name, {"trusted area", "all area"});
    print_line(out, "Kind", quantity.label);
    for (const Metric& metric : field_metrics(quantity)) {
      if (!metric.has_result()) continue;
      const std::string label = metric.label, key = Json::json_pointer(metric.json_pointer()).back();
      print_row(out, label.substr(0, label.rfind(", ")), unit_of(metric, ""),
                {formatted(metric, field.number("/" + key)),
                 formatted(metric, field.number("/metrics_all_triangles/" + key))});
    }
    const std::size_t n_source = field.count("/n_vertices_without_value/source"),
                      n_target = field.count("/n_vertices_without_value/target");
    if (n_source + n_target > 0)
      print_row(out, "Vertices without a value", "",
                {"source " + std::to_string(n_source), "target " + std::to_string(n_target)});
  }
}

/// The metrics by distance from the surfaces, unless that is 0 alone.
void print_offsets(std::ostream& out, const Record& record) {
  const Json& offsets = record.at("/by_offset");
  if (offsets.empty() || (offsets.size() == 1 && Record(offsets.front()).number("/offset_A") == 0)) return;
  std::vector<std::string> columns, inside, outside;
  for (const Json& at : offsets) {
    const Record r(at);
    const auto both = [&](const std::string& name) {
      return std::to_string(r.count("/" + name + "/source") + r.count("/" + name + "/target"));
    };
    columns.push_back(formatted("%.3g", r.number("/offset_A")) + " A");
    inside.push_back(both("n_vertices_inside"));
    outside.push_back(both("n_vertices_outside_map"));
  }
  print_heading(out, "Read outside the surfaces by", columns);
  for (const Metric& metric : metrics()) {
    const bool depends = metric.section == MetricSection::kPotential || metric.unit == MetricUnit::kSquareAngstrom;
    if (!depends || metric.source.of_area == nullptr) continue;
    std::vector<std::string> values;
    for (const Json& at : offsets)
      values.push_back(formatted(metric, Record(at).number(std::string("/") + metric.name)));
    print_row(out, metric.label, unit_of(metric, record.potential_unit()), values);
  }
  print_row(out, "Vertices inside, left out", "", inside);
  print_row(out, "Vertices outside the maps", "", outside);
}

void print_surfaces(std::ostream& out, const Record& record) {
  out << "\nSurface\n";
  print_lines(out, record, MetricSection::kSurface);
  const auto number = [&](const std::string& side, const std::string& pointer) {
    return side + " " + std::to_string(record.count(pointer));
  };
  const auto counts = [&](const char* label, const std::string& name) {
    print_row(out, label, "",
              {number("source", "/surfaces/source/" + name), number("target", "/surfaces/target/" + name)});
  };
  print_row(out, "Vertices", "",
            {number("source", "/surfaces/source/n_vertices"), number("target", "/surfaces/target/n_vertices"),
             number("mapped", "/n_vertices")});
  counts("Components", "n_components");
  counts("Closed cavities left out", "n_cavities_left_out");
  if (record.has_potential())
    print_row(out, "Vertices outside the map", "",
              {number("source", "/n_vertices_outside_map/source"), number("target", "/n_vertices_outside_map/target")});
}

/// What a mapping followed.
std::string words_of_motions(const std::string& domains) {
  return domains == kLocalMotions ? "local motions" : "the superposition of the whole";
}

void print_mapping(std::ostream& out, const Record& record) {
  const std::size_t iterations = record.count("/iterations"), added = record.count("/n_vertices_added");
  if (record.text("/options/method") == to_string(Method::kMorph)) {
    print_line(out, "Mapping",
               "carried by the atoms in " + counted(iterations, "step") + ", " + counted(added, "vertex", "vertices") +
                   " added");
  } else {
    print_line(out, "Mapping",
               std::string(record.flag("/certificate/converged") ? "converged after " : "did not converge in ") +
                   counted(iterations, "iteration") +
                   (added > 0 ? ", " + counted(added, "vertex", "vertices") + " added" : ""));
  }
  if (record.has("/motions/other")) {
    const Record other(record.at("/motions/other"));
    print_line(out, "Mapped twice, kept",
               words_of_motions(record.text("/motions/domains")) + ": " + record.text("/motions/because"));
    print_line(out, "The other",
               words_of_motions(other.text("/domains")) + ": " + share_of(other.number("/beyond_3A_area_fraction")) +
                   " beyond 3 A, " + share_of(other.number("/same_residue_area_fraction")) +
                   " on the same residue, unmatched " + share_of(other.number("/no_counterpart_area_fraction/source")) +
                   ", " + share_of(other.number("/no_counterpart_area_fraction/target")));
  }
  if (record.has("/gvf"))
    print_line(out, "Gradient vector flow",
               std::string(record.flag("/gvf/converged") ? "converged after " : "did not converge in ") +
                   counted(record.count("/gvf/sweeps"), "sweep"));
}

void print_certificate(std::ostream& out, const Record& record) {
  out << "\nCertificate\n";
  print_lines(out, record, MetricSection::kCertificate);
  print_mapping(out, record);
  std::string not_checked;
  for (const std::string& name : record.texts("/certificate/not_checked"))
    not_checked += (not_checked.empty() ? "" : ", ") + name;
  std::replace(not_checked.begin(), not_checked.end(), '_', ' ');
  if (!not_checked.empty()) print_line(out, "Not checked", not_checked);
}

/// The metrics, unmatched area and verdict of a region or patch.
void print_part(std::ostream& out, const std::string& title, const Record& part, const Record& whole) {
  print_heading(out, title + ": " + counted(part.count("/n_residues"), "residue") + " of the source", {"trusted area"});
  for (const MetricSection section : {MetricSection::kPotential, MetricSection::kShape}) {
    if (section == MetricSection::kPotential && !whole.has_potential()) continue;
    for (const Metric& metric : metrics()) {
      if (metric.section == section && metric.has_result())
        print_row(out, metric.label, unit_of(metric, whole.potential_unit()),
                  {formatted(metric, part.value_of(metric))});
    }
  }
  for (const auto& [name, json] : part.at("/fields").items()) {
    const Record field(json);
    print_row(out, "Field " + name, field.text("/unit"),
              {"mean abs. " + formatted("%.4g", field.number("/mean_abs_difference")),
               "signed " + formatted("%.4g", field.number("/mean_signed_difference"))});
  }
  print_row(out, "Unmatched area", "",
            {"source " + share_of(part.number("/certificate/no_counterpart_area_fraction/source")),
             "target " + share_of(part.number("/certificate/no_counterpart_area_fraction/target"))});
  print_line(out, "Verdict", part.text("/certificate/verdict"));
  for (const std::string& reason : part.texts("/certificate/reasons")) print_item(out, reason, 4);
  if (part.has("/placement")) print_item(out, part.text("/placement/in_words"));
}

/// What is said of each reading whose causes were asked for.
void print_causes(std::ostream& out, const Record& record) {
  for (const Json& reading : record.at("/causes")) {
    out << "\nCauses of the difference, " << Record(reading).text("/reading") << '\n';
    for (const std::string& text : causes_in_words(Record(reading))) print_item(out, text);
  }
}

void print_warnings(std::ostream& out, const Record& record) {
  const std::vector<std::string> warnings = record.texts("/warnings");
  if (warnings.empty()) return;
  out << "\nWarnings\n";
  for (const std::string& warning : warnings) print_item(out, warning);
}

void print_verdict(std::ostream& out, const Record& record) {
  const bool trustworthy = record.flag("/certificate/trustworthy");
  out << '\n' << record.text("/certificate/verdict") << (trustworthy ? ": " : ":\n");
  if (!trustworthy) {
    for (const std::string& reason : record.texts("/certificate/reasons")) print_item(out, reason);
    return;
  }
  out << "the numbers rest on " << trusted_in_words(record) << unknown_signs(record) << '\n';
  const std::vector<std::string> parts = record.texts("/certificate/untrusted_parts");
  const bool whole = std::fmin(record.number("/certificate/trusted_area_fraction/source"),
                               record.number("/certificate/trusted_area_fraction/target")) >= kWholeShare;
  if (whole || parts.empty()) return;
  out << "Not trusted:\n";
  for (const std::string& part : parts) print_item(out, part);
}

}  // namespace

void print_table(std::ostream& out, const Json& json) {
  const Record record(json);
  out << "Source  " << input_in_words(record, "source") << "\nTarget  " << input_in_words(record, "target") << "\n\n";
  print_superposition(out, record);
  print_metrics(out, record);
  print_offsets(out, record);
  print_fields(out, record);
  print_surfaces(out, record);
  print_certificate(out, record);
  if (record.has("/region")) print_part(out, "Region", Record(record.at("/region")), record);
  for (const auto& [name, patch] : record.at("/fixed_patches").items())
    print_part(out, "Patch " + name, Record(patch), record);
  for (const Json& patches : record.at("/field_patches")) {
    out << "\nPatches of " << Record(patches).text("/field") << '\n';
    print_item(out, field_patches_in_words(Record(patches)));
  }
  print_interface(out, record);
  print_causes(out, record);
  print_warnings(out, record);
  print_verdict(out, record);
}

}  // namespace espdiff
