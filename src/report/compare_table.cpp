// compare_table.cpp: a comparison's result as a table for a terminal.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "align/rigid_domains.h"
#include "compare/result.h"
#include "engine/certificate_stage.h"
#include "report/potential_json.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

constexpr std::size_t kLabelWidth = 28, kUnitWidth = 14, kColumnWidth = 14;

std::string formatted(const char* format, double value) {
  if (std::isnan(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string significant(double value) { return formatted("%.4g", value); }
std::string percent(double fraction) { return formatted("%.3g", 100 * fraction) + " %"; }

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

void print_superposition(std::ostream& out, const Molecule& source, const CompareResult& result) {
  const AtomPairing& pairing = result.pairing;
  out << "Superposition\n";
  if (pairing.pairs.empty()) {
    line(out, "paired atoms", "none; compared where they lie");
    return;
  }
  std::string paired = counted(pairing.pairs.size(), "atom") + ", by " + pairing.method;
  if (pairing.n_substituted_residues > 0) {
    paired += " (" + std::to_string(pairing.n_substituted_residues) + " of " +
              counted(pairing.n_aligned_residues, "residue") + " substituted)";
  }
  line(out, "paired atoms", paired);
  const std::string over = result.n_superposed_atoms > 0
                               ? "after superposing " + counted(result.n_superposed_atoms, "atom")
                               : std::string("where they lie, not superposed");
  line(out, "RMSD", significant(result.rmsd_A) + " A " + over);
  for (const RigidDomain& piece : result.domains)
    line(out, "rigid piece", significant(piece.rmsd_A) + " A, " + residue_ranges(source, piece.residues));
}

/// Which potential it is that differs, and what to know of it.
void print_kind_of_potential(std::ostream& out, const CompareResult& result) {
  const std::string label = potential_label(result);
  if (label.empty()) return;
  const auto &source = result.source_recipe, &target = result.target_recipe;
  const std::string because = source ? source->because : target->because;
  out << "\nPotential computed\n";
  line(out, "kind", label + (because.empty() ? "" : " (" + because + ")"));
  for (const auto& [side, recipe] : {std::pair("source", &source), std::pair("target", &target)}) {
    if (!*recipe) continue;
    const MapRecipe& r = **recipe;
    std::string text = formatted("%.4g", r.net_charge) + " e in " + counted(r.n_charges, "charge") + "; zero " +
                       to_string(r.zero);
    if (r.method == PotentialMethod::kPoissonBoltzmann)
      text += "; residual " + formatted("%.1e", r.pb_report.relative_residual) + " after " +
              counted(static_cast<std::size_t>(std::max(r.pb_report.cycles, 0)), "cycle");
    line(out, side, text);
  }
  for (const std::string& note :
       potential_notes(source ? &*source : nullptr, target ? &*target : nullptr))
    line(out, "note", note);
}

void print_metrics(std::ostream& out, const CompareResult& result) {
  const Metrics &valid = result.metrics, &all = result.metrics_all;
  const std::string unit = potential_unit_text(result);
  const auto both = [&](double Metrics::*member) {
    return std::vector<std::string>{significant(valid.*member), significant(all.*member)};
  };
  print_kind_of_potential(out, result);
  heading(out, "Potential (target - source)", {"valid area", "all area"});
  row(out, "mean absolute difference", unit, both(&Metrics::mean_abs_difference));
  row(out, "RMS difference", unit, both(&Metrics::rms_difference));
  row(out, "mean signed difference", unit, both(&Metrics::mean_signed_difference));
  row(out, "sign changes on", "of the area",
      {percent(valid.sign_change_area_fraction), percent(all.sign_change_area_fraction)});
  row(out, "Hodgkin index", "", both(&Metrics::hodgkin_index));
  row(out, "Carbo index", "", both(&Metrics::carbo_index));
  row(out, "mean displacement", "A", both(&Metrics::mean_displacement_A));
  row(out, "mean path length", "A", both(&Metrics::mean_path_length_A));
  row(out, "area", "A^2", {formatted("%.1f", valid.area_A2), formatted("%.1f", all.area_A2)});
}

/// The metrics by distance from the surfaces, where it is not 0 alone.
void print_offsets(std::ostream& out, const CompareResult& result) {
  if (result.by_offset.empty() || (result.by_offset.size() == 1 && result.by_offset.front().offset_A == 0)) return;
  std::vector<std::string> columns, mean, rms, signed_mean, hodgkin, area, inside, outside;
  for (const OffsetMetrics& at : result.by_offset) {
    columns.push_back(formatted("%.3g", at.offset_A) + " A");
    mean.push_back(significant(at.metrics.mean_abs_difference));
    rms.push_back(significant(at.metrics.rms_difference));
    signed_mean.push_back(significant(at.metrics.mean_signed_difference));
    hodgkin.push_back(significant(at.metrics.hodgkin_index));
    area.push_back(formatted("%.1f", at.metrics.area_A2));
    inside.push_back(std::to_string(at.n_inside_source + at.n_inside_target));
    outside.push_back(std::to_string(at.n_outside_source_map + at.n_outside_target_map));
  }
  const std::string unit = potential_unit_text(result);
  heading(out, "Read outside the surfaces by", columns);
  row(out, "mean absolute difference", unit, mean);
  row(out, "RMS difference", unit, rms);
  row(out, "mean signed difference", unit, signed_mean);
  row(out, "Hodgkin index", "", hodgkin);
  row(out, "area", "A^2", area);
  row(out, "vertices inside", "left out", inside);
  row(out, "vertices outside the maps", "left out", outside);
}

void print_surfaces(std::ostream& out, const CompareResult& result) {
  const SurfaceSummary &source = result.source_surface, &target = result.target_surface;
  const auto count = [](std::size_t n) { return std::to_string(n); };
  heading(out, "Surface", {"source", "target", "mapped"});
  row(out, "area", "A^2",
      {formatted("%.1f", source.area_A2), formatted("%.1f", target.area_A2), formatted("%.1f", result.area_mapped_A2)});
  row(out, "vertices", "",
      {count(source.n_vertices), count(target.n_vertices), count(result.surface.positions.size())});
  row(out, "components", "", {count(source.n_components), count(target.n_components)});
  row(out, "closed cavities left out", "", {count(source.n_cavities_left_out), count(target.n_cavities_left_out)});
  if (result.has_potential) {
    row(out, "vertices outside the map", "", {count(result.n_outside_source_map), count(result.n_outside_target_map)});
  }
}

std::string in_words(const DistanceSummary& d) {
  return "mean " + significant(d.mean) + " A, 95 % of the area within " + significant(d.p95) + " A, at most " +
         significant(d.max) + " A";
}

void print_certificate(std::ostream& out, const CompareResult& result) {
  const Certificate& c = result.certificate;
  out << "\nCertificate\n";
  line(out, "off the target's surface", percent(c.corrupt_area_fraction) + " of the mapped area (corrupt)");
  line(out, "turned inside out", percent(c.flipped_area_fraction) + " of the mapped area (flipped)");
  line(out, "intersecting itself", counted(c.self_intersecting_pairs, "pair") + " of triangles");
  line(out, "mapped to target", in_words(c.mapped_to_target));
  line(out, "target to mapped", in_words(c.target_to_mapped));
  line(out, "without counterpart",
       percent(c.unmatched_source) + " of the source's, " + percent(c.unmatched_target) + " of the target's area");
  if (c.round_trip) {
    line(out, "there and back",
         "mean " + significant(c.round_trip->mean_A) + " A from the start, 95 % of the area within " +
             significant(c.round_trip->p95_A) + " A, at most " + significant(c.round_trip->max_A) + " A");
  }
  const DistortionReport& d = c.distortion;
  line(out, "area, mapped to source",
       "median " + significant(d.area_ratio_median) + ", 90 % of the area from " + significant(d.area_ratio_p05) +
           " to " + significant(d.area_ratio_p95));
  line(out, "on the same residue", percent(c.same_residue_area_fraction) + " of the mapped area");
  line(out, "irregularity", significant(c.irregularity_A) + " A");
  const auto n_of = [](int n) { return static_cast<std::size_t>(std::max(n, 0)); };
  if (result.morph_report.steps > 0) {
    line(out, "mapping",
         "carried by the atoms in " + counted(n_of(result.morph_report.steps), "step") + ", " +
             counted(result.morph_report.n_vertices_added, "vertex", "vertices") + " added");
  } else {
    line(out, "mapping",
         std::string(c.converged ? "converged after " : "did not converge in ") +
             counted(n_of(result.deform_report.iterations), "iteration") +
             (result.n_vertices_subdivided > 0
                  ? ", " + counted(result.n_vertices_subdivided, "vertex", "vertices") + " added"
                  : ""));
  }
  if (result.flow_report.sweeps > 0) {
    line(out, "gradient vector flow",
         std::string(result.flow_report.converged ? "converged after " : "did not converge in ") +
             counted(n_of(result.flow_report.sweeps), "sweep"));
  }
  std::string not_checked;
  for (const std::string& name : c.not_checked) not_checked += (not_checked.empty() ? "" : ", ") + name;
  std::replace(not_checked.begin(), not_checked.end(), '_', ' ');
  if (!not_checked.empty()) line(out, "not checked", not_checked);
}

void print_verdict(std::ostream& out, const CompareResult& result) {
  const Certificate& c = result.certificate;
  out << '\n';
  if (c.trustworthy) {
    out << "TRUSTWORTHY: the mapping is within every limit that was checked\n";
  } else {
    out << "NOT TRUSTWORTHY:\n";
    for (const std::string& reason : c.reasons) out << "  - " << reason << '\n';
  }
}

}  // namespace

void print_table(std::ostream& out, const Molecule& source, const Molecule& target, const CompareResult& result) {
  out << "Source  " << source.name << "\nTarget  " << target.name << "\n\n";
  print_superposition(out, source, result);
  if (result.has_potential) {
    print_metrics(out, result);
    print_offsets(out, result);
  } else {
    const CountedSurface shape = counted_surface(result);
    heading(out, "Shape", {"valid area"});
    if (!result.shapes_because.empty()) line(out, "no potential", result.shapes_because);
    row(out, "mean displacement", "A", {significant(shape.mean_displacement_A)});
    row(out, "mean path length", "A", {significant(shape.mean_path_length_A)});
    row(out, "area", "A^2", {formatted("%.1f", shape.area_A2)});
  }
  print_surfaces(out, result);
  print_certificate(out, result);
  print_verdict(out, result);
}

}  // namespace espdiff
