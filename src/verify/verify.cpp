// verify.cpp: reads a result's files and computes its numbers again.
#include "verify/verify.h"

#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "io/read_grid.h"
#include "io/read_vtp.h"
#include "io/structure_file.h"
#include "verify/target_surface.h"

namespace espdiff {
namespace {

using Json = nlohmann::json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// The engine's target surface lies on a lattice of 1 A and is projected, ours on half of it and is not: they differ by
/// hundredths of an Angstrom.
constexpr double kDistanceTolerance_A = 0.03, kMaxTolerance_A = 0.3, kShareTolerance = 0.01, kAreaTolerance = 0.01;
/// Sums in single precision against sums in double precision.
constexpr double kRelative = 2e-4;
constexpr double kMatchLimit_A = 1, kCorruptDensity = 0.1;

Json read_json(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw IoError(path, "cannot be read; give the prefix of a result: OUT of OUT.json and OUT.vtp");
  const Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.contains("certificate") || !json.contains("inputs"))
    throw InputError(path + ": is not the record of a comparison; run `espdiff compare` again");
  return json;
}

/// The mapped surface's file, by vertex and by triangle.
struct MappedFile {
  VtpContent content;

  std::vector<double> numbers(const std::string& name) const {
    const VtpNumbers* const found = find_array(content.point_arrays, name);
    return found == nullptr ? std::vector<double>() : found->values;
  }
  std::vector<double> flags(const std::string& name) const {
    const VtpNumbers* const found = find_array(content.cell_arrays, name);
    return found == nullptr ? std::vector<double>(content.triangles.size(), 0) : found->values;
  }
  std::vector<Vec3d> source_positions() const {
    std::vector<Vec3d> positions;
    const std::vector<double> values = numbers("source_position");
    for (std::size_t k = 0; k + 2 < values.size(); k += 3)
      positions.push_back({values[k], values[k + 1], values[k + 2]});
    return positions;
  }
};

double triangle_area(const std::vector<Vec3d>& p, const Triangle& t) {
  return 0.5 * norm(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
}

/// The value below which this share of the weight lies.
double quantile(std::vector<std::pair<double, double>> weighted, double share) {
  std::sort(weighted.begin(), weighted.end());
  double all = 0, below = 0;
  for (const auto& entry : weighted) all += entry.second;
  for (const auto& [value, weight] : weighted) {
    if ((below += weight) >= share * all) return value;
  }
  return weighted.empty() ? kNan : weighted.back().first;
}

class Verifier {
 public:
  explicit Verifier(const std::string& prefix)
      : json_(read_json(prefix + ".json")), file_{read_vtp(prefix + ".vtp")}, folder_(folder_of(prefix)) {}

  Verification run() {
    areas();
    potentials();
    slip();
    target_surface();
    maps();
    result_.not_recomputed = {"certificate/self_intersecting_pairs (the tests count them with CGAL)",
                              "certificate/irregularity_A",
                              "certificate/dirichlet_energy",
                              "certificate/same_residue_area_fraction and slip at the vertices (they need the pairs)",
                              "certificate/round_trip",
                              "mean_path_length_A (its path is in no file)"};
    return std::move(result_);
  }

 private:
  static std::string folder_of(const std::string& prefix) {
    return std::filesystem::path(prefix).parent_path().string();
  }

  void add(const std::string& pointer, double recomputed, double tolerance) {
    const Json::json_pointer at("/" + pointer);
    if (!json_.contains(at) || !json_.at(at).is_number()) return;
    const double recorded = json_.at(at).get<double>();
    result_.lines.push_back({pointer, recorded, recomputed, std::max(tolerance, kRelative * std::fabs(recorded))});
  }

  bool is_matched(std::size_t t) const { return unmatched_[t] == 0; }
  bool is_valid(std::size_t t) const { return is_matched(t) && corrupt_[t] == 0; }

  void areas() {
    unmatched_ = file_.flags("no_counterpart");
    corrupt_ = file_.flags("corrupt");
    source_ = file_.source_positions();
    double mapped = 0, of_source = 0, matched_source = 0;
    std::vector<std::pair<double, double>> ratios;
    for (std::size_t t = 0; t < file_.content.triangles.size(); ++t) {
      const double before = triangle_area(source_, file_.content.triangles[t]);
      of_source += before;
      if (!is_matched(t)) continue;
      const double after = triangle_area(file_.content.positions, file_.content.triangles[t]);
      mapped += after;
      matched_source += before;
      matched_.push_back(file_.content.triangles[t]);
      if (before > 0) ratios.emplace_back(after / before, before);
    }
    add("area_A2/mapped", mapped, 0);
    unmatched_source_ = 1 - matched_source / of_source;
    add("certificate/area_ratio/p05", quantile(ratios, 0.05), 1e-3);
    add("certificate/area_ratio/median", quantile(ratios, 0.5), 1e-3);
    add("certificate/area_ratio/p95", quantile(ratios, 0.95), 1e-3);
  }

  /// [vertex] a third of the area of each valid triangle whose corners all have potentials.
  std::vector<double> weights(const std::vector<double>& a, const std::vector<double>& b) const {
    std::vector<double> weight(file_.content.positions.size(), 0.0);
    for (std::size_t t = 0; t < file_.content.triangles.size(); ++t) {
      const Triangle& v = file_.content.triangles[t];
      const bool counts = is_valid(t) && (a.empty() || std::all_of(v.begin(), v.end(), [&](std::uint32_t c) {
                                            return std::isfinite(a[c]) && std::isfinite(b[c]);
                                          }));
      if (!counts) continue;
      for (const std::uint32_t c : v) weight[c] += triangle_area(file_.content.positions, v) / 3;
    }
    return weight;
  }

  void potentials() {
    const std::vector<double> a = file_.numbers("potential_source"), b = file_.numbers("potential_target"),
                              displacement = file_.numbers("displacement");
    const std::vector<double> weight = weights(a, b);
    double area = 0, sum = 0, absolute = 0, square = 0, aa = 0, bb = 0, ab = 0, changes = 0, moved = 0;
    for (std::size_t v = 0; v < weight.size(); ++v) {
      if (weight[v] <= 0) continue;
      area += weight[v];
      moved += weight[v] * displacement[v];
      if (a.empty()) continue;
      const double d = b[v] - a[v];
      sum += weight[v] * d;
      absolute += weight[v] * std::fabs(d);
      square += weight[v] * d * d;
      aa += weight[v] * a[v] * a[v];
      bb += weight[v] * b[v] * b[v];
      ab += weight[v] * a[v] * b[v];
      changes += a[v] * b[v] < 0 ? weight[v] : 0;
    }
    add("area_A2/valid", area, 0);
    add("mean_displacement_A", moved / area, 1e-4);
    if (a.empty()) return;
    add("mean_abs_difference", absolute / area, 0);
    add("rms_difference", std::sqrt(square / area), 0);
    add("mean_signed_difference", sum / area, kRelative * absolute / area);
    add("sign_change_area_fraction", changes / area, 1e-4);
    add("hodgkin_index", 2 * ab / (aa + bb), 1e-4);
    add("carbo_index", ab / std::sqrt(aa * bb), 1e-4);
  }

  void slip() {
    const std::vector<double> slip = file_.numbers("slip");
    if (slip.empty()) return;
    const std::vector<double> weight = weights({}, {});
    std::vector<std::pair<double, double>> weighted;
    double area = 0, sum = 0, medium = 0, large = 0, most = 0;
    for (std::size_t v = 0; v < slip.size(); ++v) {
      if (weight[v] <= 0 || !std::isfinite(slip[v])) continue;
      weighted.emplace_back(slip[v], weight[v]);
      area += weight[v];
      sum += weight[v] * slip[v];
      medium += slip[v] > 2 ? weight[v] : 0;
      large += slip[v] > 3 ? weight[v] : 0;
      most = std::max(most, slip[v]);
    }
    if (area == 0) return;
    add("certificate/slip/mean_A", sum / area, 1e-4);
    add("certificate/slip/median_A", quantile(weighted, 0.5), 1e-3);
    add("certificate/slip/p95_A", quantile(weighted, 0.95), 1e-3);
    add("certificate/slip/max_A", most, 1e-4);
    add("certificate/slip/beyond_2A_area_fraction", medium / area, 1e-4);
    add("certificate/slip/beyond_3A_area_fraction", large / area, 1e-4);
  }

  /// The input of this role; null where it was not read from a file.
  const Json* input(const std::string& role) const {
    for (const Json& entry : json_.at("inputs")) {
      if (entry.value("role", "") == role && !entry.contains("computed")) return &entry;
    }
    return nullptr;
  }
  std::string path_of(const Json& entry) const {
    const std::string path = entry.value("path", "");
    const std::string beside = (std::filesystem::path(folder_) / std::filesystem::path(path).filename()).string();
    return std::filesystem::exists(path) ? path : beside;
  }

  Molecule molecule(const std::string& role) const {
    const Json* const entry = input(role);
    if (entry == nullptr) throw InputError("OUT.json names no file for the " + role + ", which verify needs");
    StructureOptions options;
    options.model = entry->value("model", 1);
    options.include_hetero = entry->value("hetero", true);
    options.include_water = entry->value("water", false);
    const StructureFile file(path_of(*entry));
    if (file.sha256() != entry->value("sha256", ""))
      throw InputError(path_of(*entry) + ": has changed since the comparison; compare again");
    return file.read(options);
  }

  void target_surface() {
    const Molecule target = molecule("target");
    const Json& options = json_.at("options");
    const double isovalue = options.value("isovalue", 0.5), spacing = options.value("grid_spacing_A", 1.0);
    std::vector<double> widths;
    for (const float radius : target.radii)
      widths.push_back(options.value("radius_scale", 1.0) * static_cast<double>(radius));
    const GaussianAtoms atoms(target.positions, widths);
    double corrupt = 0, flipped = 0, area = 0;
    for (const Triangle& t : matched_) {
      const auto& p = file_.content.positions;
      Vec3d gradient;
      const double density = atoms.at((1.0 / 3) * (p[t[0]] + p[t[1]] + p[t[2]]), gradient);
      const double own = triangle_area(p, t);
      area += own;
      corrupt += std::fabs(density - isovalue) > kCorruptDensity ? own : 0;
      flipped += dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), gradient) > 0 ? own : 0;
    }
    add("certificate/corrupt_area_fraction", corrupt / area, 1e-4);
    add("certificate/flipped_area_fraction", flipped / area, 1e-5);
    const auto rebuilt = atoms.surface(isovalue, spacing / 2);
    const auto mapped = polydata(file_.content.positions, matched_);
    add("area_A2/target", area_of(rebuilt), kAreaTolerance * area_of(rebuilt));
    const SurfaceDistances there = distances(mapped, rebuilt, kMatchLimit_A),
                           back = distances(rebuilt, mapped, kMatchLimit_A);
    for (const auto& [name, d] : {std::pair("mapped_to_target_A", there), std::pair("target_to_mapped_A", back)}) {
      const std::string at = std::string("certificate/") + name;
      add(at + "/mean", d.mean, kDistanceTolerance_A);
      add(at + "/p95", d.p95, 2 * kDistanceTolerance_A);
      add(at + "/max", d.max, kMaxTolerance_A);
      add(at + "/mean_within_limit", d.mean_within, kDistanceTolerance_A);
    }
    add("certificate/no_counterpart_area_fraction/source", 1 - (1 - unmatched_source_) * (1 - there.beyond), 1e-3);
    add("certificate/no_counterpart_area_fraction/target", back.beyond, kShareTolerance);
  }

  /// The potentials at the vertices, from given map files; the largest deviation is compared with zero.
  void maps() {
    check_map("source_map", "potential_source", source_);
    check_map("target_map", "potential_target", file_.content.positions);
  }
  void check_map(const std::string& role, const std::string& array, const std::vector<Vec3d>& points) {
    const Json* const entry = input(role);
    const std::vector<double> recorded = file_.numbers(array);
    const auto offsets = json_.value("by_offset", Json::array());
    const bool at_surface = !offsets.empty() && offsets[0].value("offset_A", 1.0) == 0;
    if (entry == nullptr || recorded.empty() || !at_surface) return;
    const Grid map = read_grid(path_of(*entry));
    const auto& step = map.lattice.step;
    const bool is_straight = step[0].y == 0 && step[0].z == 0 && step[1].x == 0 && step[1].z == 0 && step[2].x == 0 &&
                             step[2].y == 0 && step[0].x > 0 && step[1].y > 0 && step[2].z > 0;
    if (!is_straight || to_string(map.unit) != json_.value("potential_unit", "")) return;
    vtkNew<vtkImageData> image;
    image->SetDimensions(map.lattice.size.data());
    image->SetOrigin(map.lattice.origin.x, map.lattice.origin.y, map.lattice.origin.z);
    image->SetSpacing(step[0].x, step[1].y, step[2].z);
    vtkNew<vtkDoubleArray> values;
    for (const float value : map.values) values->InsertNextValue(static_cast<double>(value));
    image->GetPointData()->SetScalars(values);
    double largest = 0, scale = 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (!std::isfinite(recorded[v])) continue;
      int cell[3];
      double x[3] = {points[v].x, points[v].y, points[v].z}, within[3], sum = 0;
      if (image->ComputeStructuredCoordinates(x, cell, within) == 0) continue;
      for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        int at[3];
        for (int axis = 0; axis < 3; ++axis) {
          const bool upper = ((corner >> axis) & 1) != 0;
          at[axis] = std::min(cell[axis] + (upper ? 1 : 0), map.lattice.size[static_cast<std::size_t>(axis)] - 1);
          weight *= upper ? within[axis] : 1 - within[axis];
        }
        sum += weight * image->GetScalarComponentAsDouble(at[0], at[1], at[2], 0);
      }
      largest = std::max(largest, std::fabs(sum - recorded[v]));
      scale = std::max(scale, std::fabs(recorded[v]));
    }
    result_.lines.push_back({array + ", largest deviation from the map", 0, largest, 1e-4 * scale});
  }

  Json json_;
  MappedFile file_;
  std::string folder_;
  std::vector<Vec3d> source_;
  std::vector<double> unmatched_, corrupt_;
  std::vector<Triangle> matched_;
  double unmatched_source_ = 0;
  Verification result_;
};

}  // namespace

bool VerifiedLine::agrees() const { return std::fabs(recorded - recomputed) <= tolerance; }

bool Verification::agrees() const {
  return std::all_of(lines.begin(), lines.end(), [](const VerifiedLine& line) { return line.agrees(); });
}

Verification verify(const std::string& prefix) { return Verifier(prefix).run(); }

}  // namespace espdiff
