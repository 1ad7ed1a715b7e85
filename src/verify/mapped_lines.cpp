// mapped_lines.cpp: numbers that follow from OUT.vtp and OUT.residues.csv alone.
#include "verify/mapped_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/not_a_number.h"
#include "io/files/read_csv.h"
#include "verify/mapped_file.h"

namespace espdiff {
namespace {

constexpr double kRelativeOfMean = 2e-4;  ///< of a mean whose sign may cancel
constexpr double kMediumSlip_A = 2, kLargeSlip_A = 3;
constexpr double kLeastResidueArea_A2 = 5;
constexpr double kLeastTrustedShare = 0.25;  // of a residue whose mapped mean is one of the residue

void add_areas(const MappedFile& file, Lines& lines) {
  double mapped = 0, all = 0, matched = 0;
  std::vector<std::pair<double, double>> ratios, energies;
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    const double before = file.source_area(t);
    all += before;
    if (!file.is_matched[t]) continue;
    const double after = file.area(t);
    matched += before;
    mapped += after;
    if (!(before > 0)) continue;
    ratios.emplace_back(after / before, before);
    // Singular values of the triangle's linear map, by its sides in orthonormal frames of both planes.
    const auto sides = [&](const std::vector<Vec3d>& p) {
      const Triangle& v = file.triangles[t];
      const Vec3d a = p[v[1]] - p[v[0]], b = p[v[2]] - p[v[0]];
      const double length = norm(a), along = dot(a, b) / length;
      return std::array<double, 3>{length, along, std::sqrt(std::max(0.0, dot(b, b) - along * along))};
    };
    const auto [p, q, h] = sides(file.source_positions);
    const auto [u, v, w] = sides(file.positions);
    const double scale = u / p, shear = (v - q * scale) / h, height = w / h;  // columns (scale, 0), (shear, height)
    const double squared = scale * scale + shear * shear + height * height, determinant = scale * height;
    const double inverse = squared / (determinant * determinant);
    energies.emplace_back(determinant > 0 ? 0.25 * (squared + inverse) : std::numeric_limits<double>::infinity(),
                          before);
  }
  lines.add("area_A2/mapped", mapped, 0);
  lines.add_sum("certificate/removed", 1 - matched / all, 1e-5);
  for (const auto& [name, share] : {std::pair("p05", 0.05), std::pair("median", 0.5), std::pair("p95", 0.95)})
    lines.add(std::string("certificate/area_ratio/") + name, weighted_quantile(ratios, share), 1e-3);
  for (const auto& [name, share] : {std::pair("median", 0.5), std::pair("p95", 0.95)}) {
    const double energy = weighted_quantile(energies, share);
    lines.add(std::string("certificate/symmetric_dirichlet/") + name, energy, 1e-3 * energy);
  }
}

constexpr const char* kReasons[kNumberOfReasons] = {"trusted",       "unmatched", "corrupt",      "unpaired", "slipped",
                                                    "other_residue", "disagrees", "no_potential", "turned"};

/// The shares of both surfaces that are trusted, and those of the source that are not.
void add_trusted_shares(const MappedFile& file, const ResultRecord& record, Lines& lines) {
  double by_reason[kNumberOfReasons] = {}, all = 0, matched = 0, trusted = 0;
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    by_reason[static_cast<std::size_t>(file.why[t])] += file.source_area(t);
    all += file.source_area(t);
    matched += file.is_matched[t] ? file.area(t) : 0;
    trusted += file.is_trusted[t] ? file.area(t) : 0;
  }
  const double unmatched = record.number("certificate/no_counterpart_area_fraction/target").value_or(kNaN);
  lines.add("certificate/trusted_area_fraction/source", by_reason[0] / all, 1e-5);
  lines.add("certificate/trusted_area_fraction/target", (1 - unmatched) * trusted / matched, 1e-5);
  for (int k = 1; k < kNumberOfReasons; ++k)
    lines.add(std::string("certificate/not_trusted/") + kReasons[k], by_reason[k] / all, 1e-5);
}

/// The share of the trusted area on side chains that turned, and the mean difference over the rest of it.
void add_turned_area(const MappedFile& file, Lines& lines) {
  double trusted = 0, turned = 0, rest = 0, difference = 0;
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    if (!file.is_trusted[t]) continue;
    const Triangle& corners = file.triangles[t];
    trusted += file.source_area(t);
    if (std::count_if(corners.begin(), corners.end(), [&](std::uint32_t v) { return file.turned[v] != 0; }) >= 2) {
      turned += file.source_area(t);
      continue;
    }
    if (file.potential_source.empty()) continue;
    rest += file.area(t);
    for (const std::uint32_t v : corners)
      difference += file.area(t) / 3 * std::fabs(file.potential_target[v] - file.potential_source[v]);
  }
  lines.add("certificate/turned_side_chains/of_trusted_area", turned / trusted, 1e-5);
  lines.add("certificate/turned_side_chains/mean_abs_difference_without", difference / rest, 1e-5 * difference / rest);
}

/// Mean distance of the matched vertices from the mean of their neighbours, where triangles surround them: each edge
/// from there belongs to two.
double irregularity(const MappedFile& file) {
  std::vector<std::map<std::uint32_t, int>> edges(file.positions.size());
  for (const Triangle& t : file.matched()) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) {
        if (a != b) ++edges[a][b];
      }
    }
  }
  double sum = 0, n = 0;
  for (std::size_t v = 0; v < edges.size(); ++v) {
    Vec3d mean{};
    bool surrounded = !edges[v].empty();
    for (const auto& [other, n_triangles] : edges[v]) {
      surrounded = surrounded && n_triangles == 2;
      mean += file.positions[other];
    }
    if (!surrounded) continue;
    sum += norm((1 / static_cast<double>(edges[v].size())) * mean - file.positions[v]);
    ++n;
  }
  return sum / n;
}

/// The metrics over these triangles. @param at where they stand: "" or "metrics_all_triangles/"
void add_metrics(const MappedFile& file, const std::vector<bool>& counts, const std::string& at,
                 const std::string& area_name, Lines& lines) {
  const std::vector<double> weight = file.weights(counts), &a = file.potential_source, &b = file.potential_target;
  double area = 0, sum = 0, absolute = 0, square = 0, aa = 0, bb = 0, ab = 0, changes = 0, moved = 0, path = 0;
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (weight[v] <= 0) continue;
    const double w = weight[v];
    area += w;
    moved += w * file.displacement[v];
    path += w * file.path_length[v];
    if (a.empty()) continue;
    const double d = b[v] - a[v];
    sum += w * d;
    absolute += w * std::fabs(d);
    square += w * d * d;
    aa += w * a[v] * a[v];
    bb += w * b[v] * b[v];
    ab += w * a[v] * b[v];
    changes += a[v] * b[v] < 0 ? w : 0;
  }
  lines.add(at + area_name, area, 0);
  lines.add(at + "mean_displacement_A", moved / area, 1e-4);
  lines.add(at + "mean_path_length_A", path / area, 1e-4);
  if (a.empty()) return;
  lines.add(at + "mean_abs_difference", absolute / area, 0);
  lines.add(at + "rms_difference", std::sqrt(square / area), 0);
  lines.add(at + "mean_signed_difference", sum / area, kRelativeOfMean * absolute / area);
  lines.add(at + "sign_change_area_fraction", changes / area, 1e-4);
  lines.add(at + "hodgkin_index", 2 * ab / (aa + bb), 1e-4);
  lines.add(at + "carbo_index", ab / std::sqrt(aa * bb), 1e-4);
}

void add_slip(const MappedFile& file, Lines& lines) {
  const std::vector<double> weight = file.weights(file.is_valid);
  std::vector<std::pair<double, double>> weighted;
  double all = 0, known = 0, sum = 0, medium = 0, large = 0, most = 0;
  for (std::size_t v = 0; v < file.slip.size(); ++v) {
    all += weight[v];
    if (weight[v] <= 0 || !std::isfinite(file.slip[v])) continue;
    weighted.emplace_back(file.slip[v], weight[v]);
    known += weight[v];
    sum += weight[v] * file.slip[v];
    medium += file.slip[v] > kMediumSlip_A ? weight[v] : 0;
    large += file.slip[v] > kLargeSlip_A ? weight[v] : 0;
    most = std::max(most, file.slip[v]);
  }
  if (weighted.empty()) return;
  const std::string at = "certificate/slip/";
  lines.add(at + "mean_A", sum / known, 1e-4);
  lines.add(at + "median_A", weighted_quantile(weighted, 0.5), 1e-3);
  lines.add(at + "p95_A", weighted_quantile(weighted, 0.95), 1e-3);
  lines.add(at + "max_A", most, 1e-4);
  lines.add(at + "beyond_2A_area_fraction", medium / known, 1e-4);
  lines.add(at + "beyond_3A_area_fraction", large / known, 1e-4);
  lines.add(at + "unpaired_area_fraction", 1 - known / all, 1e-6);
}

void add_outside_maps(const MappedFile& file, Lines& lines) {
  const std::vector<double> weight = file.weights(file.is_valid);
  double all = 0, outside = 0;
  for (std::size_t v = 0; v < weight.size(); ++v) {
    all += weight[v];
    if (!std::isfinite(file.potential_source[v]) || !std::isfinite(file.potential_target[v])) outside += weight[v];
  }
  lines.add("certificate/outside_maps_area_fraction", outside / all, 1e-6);
}

/// Largest deviation of a column from the means at the vertices, in shares of the column's largest value.
double deviation(const CsvTable& table, int at, const std::vector<double>& expected) {
  double largest = 0, scale = 1e-12;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const double value = table.number(r, static_cast<std::size_t>(at));
    if (std::isnan(value) != std::isnan(expected[r])) return 1;
    if (std::isnan(value)) continue;
    largest = std::max(largest, std::fabs(value - expected[r]));
    scale = std::max(scale, std::fabs(expected[r]));
  }
  return largest / scale;
}

/// Pearson's over the residues whose own difference is known and of which enough is trusted, weighted by the area that
/// it rests on.
double correlation(const CsvTable& table, int area, int trusted, int weight, int own, int mapped) {
  std::vector<std::array<double, 3>> values;
  double total = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto at = [&](int c) { return table.number(r, static_cast<std::size_t>(c)); };
    if (!(at(area) >= kLeastResidueArea_A2 && at(trusted) >= kLeastTrustedShare) || !std::isfinite(at(own))) continue;
    values.push_back({at(weight), at(own), at(mapped)});
    total += at(weight);
  }
  if (values.size() < 5) return kNaN;
  for (const auto& [w, a, b] : values) {
    x += w * a / total;
    y += w * b / total;
  }
  for (const auto& [w, a, b] : values) {
    xx += w * (a - x) * (a - x);
    yy += w * (b - y) * (b - y);
    xy += w * (a - x) * (b - y);
  }
  return xy / std::sqrt(xx * yy);
}

/// Whether the record says that the residues' correlation was not judged: of noise with noise it has none.
bool residues_not_checked(const ResultRecord& record) {
  const std::string list = "certificate/not_checked";
  for (std::size_t k = 0; k < record.size(list); ++k) {
    if (record.text(list + "/" + std::to_string(k)) == "residues") return record.size("certificate/residues") == 0;
  }
  return false;
}

}  // namespace

void add_mapped_lines(const MappedFile& file, const ResultRecord& record, Lines& lines) {
  add_areas(file, lines);
  add_trusted_shares(file, record, lines);
  add_turned_area(file, lines);
  lines.add("certificate/irregularity_A", irregularity(file), 1e-4);
  add_metrics(file, file.is_trusted, "", "area_A2/trusted", lines);
  add_slip(file, lines);
  if (file.potential_source.empty()) return;
  add_metrics(file, file.with_potentials(file.is_matched), "metrics_all_triangles/", "area_A2", lines);
  if (record.size("by_offset") > 0) {
    const std::string offsets = record.text("options/offset");
    lines.add("by_offset/0/offset_A", std::strtod(offsets.c_str(), nullptr), 0);
    add_metrics(file, file.is_trusted, "by_offset/0/", "area_A2", lines);
  }
  add_outside_maps(file, lines);
}

namespace {

/// Sums over the vertices of each residue.
struct ResidueSums {
  std::vector<double> area, slip_area, own_area, trusted;
  std::map<std::string, std::vector<double>> of;  ///< by the name of the column, times area
};

/// @returns false if a vertex has a residue that the table lacks
bool sum_residues(const MappedFile& file, std::size_t n, ResidueSums& sums) {
  const std::vector<double> weight = file.weights(file.is_trusted), matched = file.weights(file.is_valid);
  for (std::vector<double>* sum : {&sums.area, &sums.slip_area, &sums.own_area, &sums.trusted}) sum->assign(n, 0);
  for (const char* name : {"mean_displacement", "mean_path_length", "mean_slip", "slip_area_fraction"})
    sums.of[name].assign(n, 0);
  for (const char* name :
       {"mean_abs_difference", "mean_signed_difference", "mean_source", "mean_target", "sign_change_area_fraction"})
    sums.of[name].assign(n, 0);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (!(file.residue[v] >= 0)) continue;
    if (file.residue[v] >= static_cast<double>(n)) return false;
    const auto r = static_cast<std::size_t>(file.residue[v]);
    if (std::isfinite(file.slip[v])) {
      sums.slip_area[r] += matched[v];
      sums.of["mean_slip"][r] += matched[v] * file.slip[v];
      sums.of["slip_area_fraction"][r] += file.slip[v] > kLargeSlip_A ? matched[v] : 0;
    }
    if (weight[v] <= 0) continue;
    sums.area[r] += weight[v];
    sums.of["mean_displacement"][r] += weight[v] * file.displacement[v];
    sums.of["mean_path_length"][r] += weight[v] * file.path_length[v];
    if (file.potential_source.empty()) continue;
    const double a = file.potential_source[v], b = file.potential_target[v];
    sums.of["mean_abs_difference"][r] += weight[v] * std::fabs(b - a);
    sums.of["mean_signed_difference"][r] += weight[v] * (b - a);
    sums.of["mean_source"][r] += weight[v] * a;
    sums.of["mean_target"][r] += weight[v] * b;
    sums.of["sign_change_area_fraction"][r] += a * b < 0 ? weight[v] : 0;
  }
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    for (const std::uint32_t v : file.triangles[t]) {
      if (!(file.residue[v] >= 0)) continue;
      sums.own_area[static_cast<std::size_t>(file.residue[v])] += file.source_area(t) / 3;
      sums.trusted[static_cast<std::size_t>(file.residue[v])] += file.is_trusted[t] ? file.source_area(t) / 3 : 0;
    }
  }
  return true;
}

/// The unit of a column: the field's whose name it begins with, otherwise of lengths, areas or the potential.
bool has_recorded_unit(const ResultRecord& record, const std::string& column, const std::string& unit) {
  for (std::size_t end = column.find('_'); end != std::string::npos; end = column.find('_', end + 1)) {
    const std::string field = "fields/" + column.substr(0, end);
    if (record.size(field) > 0) return unit == record.text(field + "/unit");
  }
  return unit == "A" || unit == "A^2" || unit == record.text("potential_unit");
}

/// Units in the names of columns: "area [A^2]".
void add_column_units(const ResultRecord& record, const CsvTable& table, Lines& lines) {
  double wrong = 0;
  for (const std::string& name : table.columns) {
    const std::size_t at = name.find(" [");
    if (at == std::string::npos) continue;
    const std::string unit = name.substr(at + 2, name.size() - at - 3);
    wrong += has_recorded_unit(record, name.substr(0, at), unit) ? 0 : 1;
  }
  lines.add_deviation("OUT.residues.csv, columns of other units than OUT.json has", wrong, 0);
}

}  // namespace

void add_residue_lines(const MappedFile& file, const ResultRecord& record, const CsvTable& table, Lines& lines) {
  for (const std::string& name : table.columns) lines.has("OUT.residues.csv/" + name.substr(0, name.find(" [")));
  if (!file.potential_source.empty()) add_column_units(record, table, lines);
  const std::size_t n = table.rows.size();
  ResidueSums sums;
  if (!sum_residues(file, n, sums)) {
    lines.add_deviation("OUT.residues.csv, residues that it lacks", 1, 0);
    return;
  }
  const bool has_potential = !file.potential_source.empty();
  const auto check = [&](const std::string& name, const std::vector<double>& expected) {
    const int at = column(table, name);
    if (at < 0) return;
    lines.cover("OUT.residues.csv/" + name);
    lines.add_deviation("OUT.residues.csv, " + name, deviation(table, at, expected), 1e-4);
  };
  check("area", sums.area);
  for (std::size_t r = 0; r < n; ++r)
    sums.trusted[r] = sums.own_area[r] > 0 ? sums.trusted[r] / sums.own_area[r] : kNaN;
  check("trusted_area_fraction", sums.trusted);
  for (auto& [name, values] : sums.of) {
    const bool of_shape = name == "mean_displacement" || name == "mean_path_length";
    const bool of_slip = name == "mean_slip" || name == "slip_area_fraction";
    const std::vector<double>& area = of_slip ? sums.slip_area : sums.area;
    const bool known = has_potential || of_shape || of_slip;
    for (std::size_t r = 0; r < n; ++r) values[r] = known && area[r] > 0 ? values[r] / area[r] : kNaN;
    check(name, values);
  }
  if (!has_potential || residues_not_checked(record)) return;
  const int own = column(table, "own_difference"), own_area = column(table, "own_area"),
            mapped = column(table, "mean_signed_difference"), of_area = column(table, "area"),
            trusted = column(table, "trusted_area_fraction");
  if (own >= 0 && own_area >= 0 && mapped >= 0 && of_area >= 0 && trusted >= 0)
    lines.add("certificate/residues/correlation", correlation(table, of_area, trusted, own_area, own, mapped), 1e-4);
}

}  // namespace espdiff
