// compare_table.cpp: a comparison's result as a table for a terminal.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "align/chain_motions.h"
#include "align/compared_chains.h"
#include "align/rigid_domains.h"
#include "base/formatted.h"
#include "causes/causes.h"
#include "compare/map_check.h"
#include "compare/result.h"
#include "compare/short_numbers.h"
#include "report/causes_report.h"
#include "report/metrics.h"
#include "report/placement.h"
#include "report/potential_json.h"
#include "report/state_report.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

constexpr std::size_t kLabelWidth = 35, kUnitWidth = 7, kColumnWidth = 14;

std::string counted(std::size_t n, const std::string& noun, const std::string& plural) {
  return std::to_string(n) + " " + (n == 1 ? noun : plural);
}
std::string counted(std::size_t n, const std::string& noun) { return counted(n, noun, noun + "s"); }

std::string left(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

std::string right(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 1, ' ') + text;
}

/// A line of numbers: label, unit, and one column for each value.
void row(std::ostream& out, const std::string& label, const std::string& unit, const std::vector<std::string>& values) {
  out << left("  " + label, kLabelWidth) << left(unit, kUnitWidth);
  for (const std::string& value : values) out << right(value, kColumnWidth);
  out << '\n';
}

/// "  - TEXT", its further lines indented like the first.
void item(std::ostream& out, const std::string& text, std::size_t indent = 2) {
  constexpr std::size_t kTextWidth = 100;
  std::string current = std::string(indent, ' ') + "-";
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (current.size() + 1 + word.size() > kTextWidth && current.size() > indent + 1) {
      out << current << '\n';
      current = std::string(indent + 1, ' ');
    }
    current += " " + word;
  }
  out << current << '\n';
}

/// A heading over such lines.
void heading(std::ostream& out, const std::string& title, const std::vector<std::string>& columns) {
  out << '\n' << left(title, kLabelWidth + kUnitWidth);
  for (const std::string& column : columns) out << right(column, kColumnWidth);
  out << '\n';
}

/// A line in words.
void line(std::ostream& out, const std::string& label, const std::string& text) {
  out << left("  " + label, kLabelWidth) << text << '\n';
}

/// "1.234 A"
std::string with_unit(const Metric& metric, double value) {
  const std::string unit = unit_of(metric, "");
  return formatted(metric, value) + (unit.empty() ? "" : " " + unit);
}

/// Which chains were compared, unless there is one of one name; and copies, of which one may be meant.
void print_chains(std::ostream& out, const CompareResult& result) {
  const bool one = result.chains.size() == 1 && result.chains[0].source == result.chains[0].target;
  if (!one && !result.chains.empty()) line(out, "Chains", in_words(result.chains));
  if (!result.chain_motions.empty()) line(out, "Against the others", in_words(result.chain_motions));
  for (const auto& [label, copies] : {std::pair("Copies in the source", &result.source_copies),
                                      std::pair("Copies in the target", &result.target_copies)}) {
    for (const auto& group : *copies) {
      std::string names;
      for (const std::string& name : group) names += (names.empty() ? "" : ", ") + name;
      line(out, label, "chains " + names + " repeat one sequence");
    }
  }
}

void print_superposition(std::ostream& out, const Molecule& source, const CompareResult& result) {
  const AtomPairing& pairing = result.pairing;
  out << "Superposition\n";
  if (pairing.pairs.empty()) {
    line(out, "Paired atoms", "none; compared where they lie");
    return;
  }
  std::string paired = counted(pairing.pairs.size(), "atom") + ", by " + pairing.method;
  if (pairing.n_substituted_residues > 0) {
    paired += " (" + std::to_string(pairing.n_substituted_residues) + " of " +
              counted(pairing.n_aligned_residues, "residue") + " substituted)";
  }
  line(out, "Paired atoms", paired);
  const std::string over = result.n_superposed_atoms > 0
                               ? "after superposing " + counted(result.n_superposed_atoms, "atom")
                               : std::string("where they lie, not superposed");
  for (const Metric& metric : metrics()) {
    if (metric.section != MetricSection::kSuperposition) continue;
    line(out, metric.label, with_unit(metric, value_of(metric, result)) + " " + over);
  }
  print_chains(out, result);
  for (const RigidDomain& domain : result.domains) {
    line(out, "Rigid domain", formatted("%.4g", domain.rmsd_A) + " A, " + residue_ranges(source, domain.residues));
  }
  for (const auto& [label, text] : result.input_lines) line(out, label, text);
}

/// A row for each metric of the section: over the area that is counted and, with potentials, over all of it.
void print_section(std::ostream& out, const CompareResult& result, MetricSection section) {
  for (const Metric& metric : metrics()) {
    if (metric.section != section || !metric.has_result()) continue;
    std::vector<std::string> values = {formatted(metric, value_of(metric, result))};
    if (result.has_potential && metric.source.of_area != nullptr)
      values.push_back(formatted(metric, value_over_all_triangles(metric, result)));
    row(out, metric.label, unit_of(metric, to_string(result.unit)), values);
  }
}

/// The metrics that share a line follow one another.
void print_lines(std::ostream& out, const CompareResult& result, MetricSection section) {
  const std::vector<Metric>& all = metrics();
  for (std::size_t i = 0; i < all.size();) {
    const Metric& first = all[i];
    std::vector<std::string> values;
    const auto shares_line = [&] {
      return i < all.size() && all[i].section == section && *first.line != '\0' &&
             std::string(all[i].line) == first.line;
    };
    do {
      const std::string word = *all[i].word != '\0' ? std::string(all[i].word) + " " : std::string();
      if (all[i].has_result()) values.push_back(word + formatted(all[i], value_of(all[i], result)));
      ++i;
    } while (shares_line());
    if (first.section != section || is_unchecked(first, result)) continue;
    // Such a line is no evidence, so the reader must know.
    if (result.certificate.zero_by_construction && (first.flags & kRemovable) != 0)
      values.emplace_back(" by construction, see Removed");
    row(out, *first.line != '\0' ? first.line : first.label, unit_of(first, to_string(result.unit)), values);
  }
}

/// Which potential it is that differs, and what to know of it.
void print_kind_of_potential(std::ostream& out, const CompareResult& result) {
  const auto &source = result.source_recipe, &target = result.target_recipe;
  if (!source && !target) return;
  const std::string label = potential_label(result);
  const std::string because = source ? source->because : target->because;
  out << "\nComputed potential\n";
  line(out, "Kind", label + (because.empty() ? "" : " (" + because + ")"));
  for (const auto& [side, recipe] : {std::pair("Of the source", &source), std::pair("Of the target", &target)}) {
    if (!*recipe) continue;
    const MapRecipe& r = **recipe;
    std::string text =
        formatted("%.4g", r.net_charge) + " e in " + counted(r.n_charges, "charge") + "; zero " + to_string(r.zero);
    if (r.method == PotentialMethod::kPoissonBoltzmann)
      text += "; residual " + formatted("%.1e", r.pb_report.relative_residual) + " after " +
              counted(static_cast<std::size_t>(std::max(r.pb_report.cycles, 0)), "cycle");
    line(out, side, text);
  }
  for (const std::string& note : potential_notes(source ? &*source : nullptr, target ? &*target : nullptr))
    line(out, "Note", note);
}

/// How given maps compare with the potentials of the molecules' charges.
void print_given_maps(std::ostream& out, const CompareResult& result) {
  if (!result.source_map_check && !result.target_map_check) return;
  out << "\nGiven maps, against the potentials of the charges\n";
  for (const auto& [side, check] :
       {std::pair("Of the source", &result.source_map_check), std::pair("Of the target", &result.target_map_check)}) {
    if (!*check) continue;
    const ReferenceFit& fit = (*check)->best();
    line(out, side,
         std::string("as in ") + to_string((*check)->kind) + ": slope " + formatted("%.3g", fit.slope) +
             ", correlation " + number_beside(fit.correlation, 1, 3) + " at " + counted((*check)->n_points, "point"));
  }
}

void print_metrics(std::ostream& out, const CompareResult& result) {
  if (result.has_potential) {
    print_kind_of_potential(out, result);
    print_given_maps(out, result);
    const bool vacuum = potential_unit_text(result) != to_string(result.unit);
    heading(out, std::string("Potential") + (vacuum ? kInVacuum : "") + " (target - source)",
            {"trusted area", "all area"});
    print_section(out, result, MetricSection::kPotential);
    const WholeSurface whole = whole_surface(result);
    const Metric& mean = *find_metric_or_null("mean_abs_difference");
    line(out, "Mean abs. of the whole surface",
         "about " + formatted(mean, whole.estimate) + ", at most " + formatted(mean, whole.at_most) + " " +
             to_string(result.unit));
  } else {
    heading(out, "Shape (no potentials)", {"trusted area"});
    if (!result.shapes_because.empty()) line(out, "Because", result.shapes_because);
  }
  print_section(out, result, MetricSection::kShape);
}

/// A section for each field besides the potential.
void print_fields(std::ostream& out, const CompareResult& result) {
  for (const FieldResult& field : result.fields) {
    heading(out, "Field " + field.quantity.name, {"trusted area", "all area"});
    line(out, "Kind", field.quantity.label);
    for (const Metric& metric : field_metrics(field.quantity)) {
      if (!metric.has_result()) continue;
      const std::string label = metric.label;
      row(out, label.substr(0, label.rfind(", ")), unit_of(metric, ""),
          {formatted(metric, value_of(metric, result)), formatted(metric, value_over_all_triangles(metric, result))});
    }
    if (field.n_missing_source + field.n_missing_target > 0)
      row(out, "Vertices without a value", "",
          {"source " + std::to_string(field.n_missing_source), "target " + std::to_string(field.n_missing_target)});
  }
}

/// The metrics by distance from the surfaces, unless that is 0 alone.
void print_offsets(std::ostream& out, const CompareResult& result) {
  if (result.by_offset.empty() || (result.by_offset.size() == 1 && result.by_offset.front().offset_A == 0)) return;
  std::vector<std::string> columns, inside, outside;
  for (const OffsetMetrics& at : result.by_offset) {
    columns.push_back(formatted("%.3g", at.offset_A) + " A");
    inside.push_back(std::to_string(at.n_inside_source + at.n_inside_target));
    outside.push_back(std::to_string(at.n_outside_source_map + at.n_outside_target_map));
  }
  heading(out, "Read outside the surfaces by", columns);
  for (const Metric& metric : metrics()) {
    const bool depends = metric.section == MetricSection::kPotential || metric.unit == MetricUnit::kSquareAngstrom;
    if (!depends || metric.source.of_area == nullptr) continue;
    std::vector<std::string> values;
    for (const OffsetMetrics& at : result.by_offset)
      values.push_back(formatted(metric, at.metrics.*metric.source.of_area));
    row(out, metric.label, unit_of(metric, to_string(result.unit)), values);
  }
  row(out, "Vertices inside, left out", "", inside);
  row(out, "Vertices outside the maps", "", outside);
}

void print_surfaces(std::ostream& out, const CompareResult& result) {
  const SurfaceSummary &source = result.source_surface, &target = result.target_surface;
  out << "\nSurface\n";
  print_lines(out, result, MetricSection::kSurface);
  const auto counts = [&](const char* label, std::size_t of_source, std::size_t of_target) {
    row(out, label, "", {"source " + std::to_string(of_source), "target " + std::to_string(of_target)});
  };
  row(out, "Vertices", "",
      {"source " + std::to_string(source.n_vertices), "target " + std::to_string(target.n_vertices),
       "mapped " + std::to_string(result.surface.positions.size())});
  counts("Components", source.n_components, target.n_components);
  counts("Closed cavities left out", source.n_cavities_left_out, target.n_cavities_left_out);
  if (result.has_potential)
    counts("Vertices outside the map", result.n_outside_source_map, result.n_outside_target_map);
}

/// "12.3 %", "-" for none.
std::string share_of(double fraction) {
  return std::isfinite(fraction) ? formatted("%.3g", 100 * fraction) + " %" : "-";
}

/// What a mapping followed.
std::string words_of_motions(const std::string& domains) {
  return domains == kLocalMotions ? "local motions" : "the superposition of the whole";
}

void print_mapping(std::ostream& out, const CompareResult& result) {
  const Certificate& c = result.certificate;
  const auto n_of = [](int n) { return static_cast<std::size_t>(std::max(n, 0)); };
  if (result.morph_report.steps > 0) {
    line(out, "Mapping",
         "carried by the atoms in " + counted(n_of(result.morph_report.steps), "step") + ", " +
             counted(result.morph_report.n_vertices_added, "vertex", "vertices") + " added");
  } else {
    line(out, "Mapping",
         std::string(c.converged ? "converged after " : "did not converge in ") +
             counted(n_of(result.deform_report.iterations), "iteration") +
             (result.n_vertices_subdivided > 0
                  ? ", " + counted(result.n_vertices_subdivided, "vertex", "vertices") + " added"
                  : ""));
  }
  if (result.other_mapping) {
    const OtherMapping& other = *result.other_mapping;
    line(out, "Mapped twice, kept", words_of_motions(result.domains_used) + ": " + other.because);
    line(out, "The other",
         words_of_motions(other.domains) + ": " + share_of(other.slip_area_fraction) + " beyond 3 A, " +
             share_of(other.same_residue_area_fraction) + " on the same residue, unmatched " +
             share_of(other.unmatched_source) + ", " + share_of(other.unmatched_target));
  }
  if (result.flow_report.sweeps > 0) {
    line(out, "Gradient vector flow",
         std::string(result.flow_report.converged ? "converged after " : "did not converge in ") +
             counted(n_of(result.flow_report.sweeps), "sweep"));
  }
}

void print_certificate(std::ostream& out, const CompareResult& result) {
  out << "\nCertificate\n";
  print_lines(out, result, MetricSection::kCertificate);
  print_mapping(out, result);
  std::string not_checked;
  for (const std::string& name : result.certificate.not_checked)
    not_checked += (not_checked.empty() ? "" : ", ") + name;
  std::replace(not_checked.begin(), not_checked.end(), '_', ' ');
  if (!not_checked.empty()) line(out, "Not checked", not_checked);
}

/// The metrics, unmatched area and verdict of a region or patch.
void print_part(std::ostream& out, const std::string& title, const CompareResult& part,
                const OptionSpelling& spelling) {
  heading(out, title + ": " + counted(part.residues.size(), "residue") + " of the source", {"trusted area"});
  for (const MetricSection section : {MetricSection::kPotential, MetricSection::kShape}) {
    if (section == MetricSection::kPotential && !part.has_potential) continue;
    for (const Metric& metric : metrics()) {
      if (metric.section == section && metric.has_result())
        row(out, metric.label, unit_of(metric, to_string(part.unit)), {formatted(metric, value_of(metric, part))});
    }
  }
  for (const FieldResult& field : part.fields) {
    row(out, "Field " + field.quantity.name, field.quantity.unit,
        {"mean abs. " + formatted("%.4g", field.metrics.mean_abs_difference),
         "signed " + formatted("%.4g", field.metrics.mean_signed_difference)});
  }
  row(out, "Unmatched area", "",
      {"source " + share_of(part.certificate.unmatched_source),
       "target " + share_of(part.certificate.unmatched_target)});
  line(out, "Verdict", verdict_of(part.certificate));
  for (const Message& reason : part.certificate.reasons) item(out, reason.spelled(spelling), 4);
}

void print_causes(std::ostream& out, const CompareResult& result) {
  if (result.causes == nullptr) return;
  for (const CausesOfReading& reading : result.causes->readings) {
    out << "\nCauses of the difference, " << reading.name << '\n';
    for (const std::string& text : causes_lines(*result.causes, reading, potential_unit_text(result))) item(out, text);
  }
}

void print_warnings(std::ostream& out, const CompareResult& result, const OptionSpelling& spelling) {
  if (result.warnings.empty()) return;
  out << "\nWarnings\n";
  for (const Warning& warning : result.warnings) item(out, warning.text.spelled(spelling));
}

/// "; the sign of the difference of region is not known: ..." for readings whose interval spans zero; otherwise empty.
std::string unknown_signs(const CompareResult& result) {
  std::string names;
  if (result.causes == nullptr) return names;
  for (const CausesOfReading& reading : result.causes->readings) {
    if (reading.placements && reading.placements->spans_zero()) names += (names.empty() ? "" : ", ") + reading.name;
  }
  return names.empty() ? names
                       : "; the sign of the difference is not known (" + names +
                             "): with side chains in other places its interval spans zero";
}

void print_verdict(std::ostream& out, const CompareResult& result, const OptionSpelling& spelling) {
  const Certificate& c = result.certificate;
  out << '\n';
  out << verdict_of(c) << (c.trustworthy ? ": " : ":\n");
  if (!c.trustworthy) {
    for (const Message& reason : c.reasons) item(out, reason.spelled(spelling));
    return;
  }
  out << "the numbers rest on " << share_of(c.trusted.source) << " of the source's surface and "
      << share_of(c.trusted.target) << " of the target's" << unknown_signs(result) << '\n';
  if (c.trusted.share() >= kWholeShare || c.untrusted_parts.empty()) return;
  out << "Not trusted:\n";
  for (const std::string& part : c.untrusted_parts) item(out, part);
}

}  // namespace

void print_table(std::ostream& out, const Molecule& source, const Molecule& target, const CompareResult& result,
                 const OptionSpelling& spelling) {
  out << "Source  " << source.name << "\nTarget  " << target.name << "\n\n";
  print_superposition(out, source, result);
  print_metrics(out, result);
  print_offsets(out, result);
  print_fields(out, result);
  print_surfaces(out, result);
  print_certificate(out, result);
  if (result.region != nullptr) print_part(out, "Region", *result.region, spelling);
  for (const PatchResult& patch : result.patches) {
    print_part(out, "Patch " + patch.name, *patch.result, spelling);
    if (patch.placement != nullptr) item(out, in_words(*patch.placement));
  }
  print_causes(out, result);
  print_warnings(out, result, spelling);
  print_verdict(out, result, spelling);
}

void print_verdict_line(std::ostream& out, const CompareResult& result) {
  const Metric& metric = *find_metric_or_null(result.has_potential ? "mean_abs_difference" : "mean_displacement_A");
  std::string label = metric.label;
  label[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(label[0])));
  out << verdict_of(result.certificate) << ": " << label << ' ' << formatted(metric, value_of(metric, result)) << ' '
      << unit_of(metric, to_string(result.unit)) << '\n';
}

}  // namespace espdiff
