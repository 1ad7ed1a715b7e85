// verify.cpp: reads a result's files and computes its numbers again.
#include "verify/verify.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "io/structures/structure_file.h"
#include "verify/array_lines.h"
#include "verify/cause_lines.h"
#include "verify/lines.h"
#include "verify/map_deviation.h"
#include "verify/mapped_file.h"
#include "verify/mapped_lines.h"
#include "verify/result_record.h"
#include "verify/target_surface.h"
#include "verify/triangle_meetings.h"
#include "verify/trusted_lines.h"

namespace espdiff {
namespace {

constexpr double kShareTolerance = 0.01, kWholeShare = 0.95;
/// The engine's surface lies on a lattice, is projected and regularized; ours on half of its spacing h and is not. A
/// chord of length h on a sphere of radius R stays h^2 / (8 R) below it and loses h^2 / (24 R^2) of its length, so
/// distances and areas differ by what grows with h^2: at 1 A 0.01 A and up to 0.5 % for a peptide. A few atoms have no
/// hollows between them, whose errors would cancel: there the areas of two spacings say how much is lost.
constexpr double kDistancePerSquare = 0.03, kAreaPerSquare = 0.01, kAreaLost = 1.5;
/// Of the spacing: what triangles may cut off at a crease.
constexpr double kMaxTolerance = 0.6;
constexpr double kMatchLimit_A = 1, kCorruptDensity = 0.1;
/// Vertices where two residues are equally strong go either way.
constexpr double kResidueTolerance = 2e-3;
/// What a record may say; beyond it no comparison has been.
constexpr double kLeastSpacing_A = 1e-3, kMostSpacing_A = 100, kMostRadiusScale = 100, kMostIsovalue = 1e6;

/// The atoms that were compared.
struct Side {
  Molecule molecule;
  std::vector<std::int32_t> residues;  ///< [atom]
  GaussianAtoms atoms;
};

std::vector<double> widths_of(const Molecule& molecule, double radius_scale) {
  std::vector<double> widths;
  for (const float radius : molecule.radii) widths.push_back(radius_scale * static_cast<double>(radius));
  return widths;
}

Side make_side(Molecule molecule, double radius_scale) {
  std::vector<std::int32_t> residues;
  for (const auto& atom : molecule.atoms) residues.push_back(atom.residue);
  GaussianAtoms atoms(molecule.positions, widths_of(molecule, radius_scale));
  return {std::move(molecule), std::move(residues), std::move(atoms)};
}

class Verifier {
 public:
  explicit Verifier(const std::string& prefix)
      : prefix_(prefix),
        record_(prefix),
        file_(prefix + ".vtp"),
        residues_(read_csv(prefix + ".residues.csv")),
        lines_(record_, result_) {}

  Verification run() {
    add_mapped_lines(file_, record_, lines_);
    add_array_lines(file_, lines_);
    add_text_lines(file_, record_, lines_);
    add_residue_lines(file_, record_, residues_, lines_);
    add_cause_lines(prefix_, record_, lines_);
    lines_.add("certificate/self_intersecting_pairs",
               static_cast<double>(count_meetings(file_.positions, file_.matched())),
               0.01 * record_.number("certificate/self_intersecting_pairs").value_or(0));
    verdict();
    const std::string why = atoms_not_read();
    if (why.empty()) {
      const double scale = record_.number_between("options/radius_scale", 1e-3, kMostRadiusScale, 1);
      const Side source = make_side(molecule("source"), scale), target = make_side(molecule("target"), scale);
      add_normal_lines(file_, source.atoms, target.atoms, lines_);
      add_residue_name_lines(file_, residues_, source.molecule.residues, lines_);
      for (const char* role : {"source", "target"}) {
        lines_.cover(record_.place_of_input(role) + "/sha256");
        lines_.cover(std::string("radii_origin/") + role);
      }
      fit(target);
      surfaces(source, target);
      pairs(source, target);
    } else {
      add_trust_lines(file_, residues_, {}, lines_);
      for (const char* name : {"certificate", "rmsd_A", "n_paired_atoms", "area_A2", "superposition", "radii_origin",
                               "OUT.vtp", "OUT.residues.csv"})
        lines_.explain(name, why);
    }
    maps();
    lines_.name_the_rest();
    result_.not_recomputed.emplace_back(
        "slip at single vertices: its quantiles follow from OUT.vtp; the atoms' rotations are in no file");
    return std::move(result_);
  }

 private:
  /// A result is trustworthy if, and only if, nothing speaks against it.
  void verdict() {
    const double n_reasons = static_cast<double>(record_.size("certificate/reasons"));
    const bool trustworthy = record_.flag("certificate/trustworthy");
    lines_.add_deviation("certificate/trustworthy, against its reasons", trustworthy == (n_reasons == 0) ? 0 : 1, 0);
    lines_.cover("certificate/trustworthy");
    const double share = std::min(record_.number("certificate/trusted_area_fraction/source").value_or(0),
                                  record_.number("certificate/trusted_area_fraction/target").value_or(0));
    std::string expected = trustworthy ? "TRUSTWORTHY" : "NOT TRUSTWORTHY";
    if (trustworthy && share < kWholeShare) expected += formatted(" ON %.0f %%", std::floor(100 * share));
    lines_.add_deviation("certificate/verdict, other than its share says",
                         record_.text("certificate/verdict") == expected ? 0 : 1, 0);
    lines_.cover("certificate/verdict");
  }

  /// Why the compared atoms cannot be read from the recorded inputs; empty if they can.
  std::string atoms_not_read() const {
    // Prepared states lie beside the result, with the compared atoms alone.
    const bool kept = record_.input("source_file") && record_.input("target_file");
    for (const char* const option : {"select", "source_select", "target_select", "leave_out", "assembly"}) {
      if (!kept && !record_.text(std::string("options/") + option).empty())
        return std::string("the compared atoms are a selection (options/") + option + ")";
    }
    for (const char* const role : {"source", "target"}) {
      const auto entry = record_.input(role);
      if (!entry) return std::string("OUT.json names no file for the ") + role;
      const char* const own = molecule(role).radii_origin == ValueOrigin::kFile ? "file" : "element";
      if (record_.text(std::string("radii_origin/") + role) != own)
        return "the radii of the " + std::string(role) + " are not those of its file (options/radii)";
    }
    return "";
  }

  Molecule molecule(const std::string& role) const {
    const VerifiedInput entry = *record_.input(role);
    StructureOptions options;
    options.model = entry.model;
    options.include_hetero = entry.hetero;
    options.include_water = entry.water;
    const StructureFile file(entry.path);
    if (file.sha256() != entry.sha256)
      throw InputError(entry.path + ": has changed since the comparison; compare again");
    return file.read(options);
  }

  double isovalue() const { return record_.number_between("options/isovalue", 1e-6, kMostIsovalue, 0.5); }

  void fit(const Side& target) {
    const double isovalue = this->isovalue();
    double corrupt = 0, flipped = 0, area = 0;
    for (std::size_t k = 0; k < file_.triangles.size(); ++k) {
      if (!file_.is_matched[k]) continue;
      const Triangle& t = file_.triangles[k];
      const auto& p = file_.positions;
      Vec3d gradient;
      const double density = target.atoms.at((1.0 / 3) * (p[t[0]] + p[t[1]] + p[t[2]]), gradient);
      const double own = file_.area(k);
      area += own;
      corrupt += std::fabs(density - isovalue) > kCorruptDensity ? own : 0;
      flipped += dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), gradient) > 0 ? own : 0;
    }
    lines_.add("certificate/corrupt_area_fraction", corrupt / area, 1e-4);
    lines_.add("certificate/flipped_area_fraction", flipped / area, 1e-4);
  }

  void surfaces(const Side& source, const Side& target) {
    if (record_.flag("options/cavities")) {
      for (const char* name : {"area_A2", "certificate/mapped_to_target_A", "certificate/target_to_mapped_A",
                               "certificate/no_counterpart_area_fraction"})
        lines_.explain(name, "surfaces include cavities (options/cavities)");
      return;
    }
    const double isovalue = this->isovalue(),
                 spacing = record_.number_between("options/grid_spacing_A", kLeastSpacing_A, kMostSpacing_A, 1);
    const double of_area = kAreaPerSquare * spacing * spacing, of_distance = kDistancePerSquare * spacing * spacing;
    const auto add_area = [&](const std::string& role, const GaussianAtoms& atoms, double area) {
      const double lost = std::fabs(area - area_of(atoms.surface(isovalue, spacing)));
      for (const std::string& name : {"area_A2/" + role, "surfaces/" + role + "/area_A2"})
        lines_.add(name, area, std::max(of_area * area, kAreaLost * lost));
    };
    add_area("source", source.atoms, area_of(source.atoms.surface(isovalue, spacing / 2)));
    const auto rebuilt = target.atoms.surface(isovalue, spacing / 2);
    const auto mapped = polydata(file_.positions, file_.matched());
    add_area("target", target.atoms, area_of(rebuilt));
    const SurfaceDistances there = distances(mapped, rebuilt, kMatchLimit_A),
                           back = distances(rebuilt, mapped, kMatchLimit_A);
    for (const auto& [name, d] : {std::pair("mapped_to_target_A", there), std::pair("target_to_mapped_A", back)}) {
      const std::string at = std::string("certificate/") + name;
      lines_.add(at + "/mean", d.mean, of_distance);
      lines_.add(at + "/p95", d.p95, 2 * of_distance);
      lines_.add(at + "/max", d.max, kMaxTolerance * spacing);
      lines_.add(at + "/mean_within_limit", d.mean_within, of_distance);
    }
    double all = 0, matched = 0;
    for (std::size_t t = 0; t < file_.triangles.size(); ++t) {
      all += file_.source_area(t);
      matched += file_.is_matched[t] ? file_.source_area(t) : 0;
    }
    lines_.add("certificate/no_counterpart_area_fraction/source", 1 - matched / all * (1 - there.beyond), 1e-3);
    lines_.add("certificate/no_counterpart_area_fraction/target", back.beyond,
               kShareTolerance * std::max(1.0, spacing * spacing));
  }

  /// RMSD, displacements and the area on the same residue, from the recorded pairs.
  void pairs(const Side& source, const Side& target) {
    std::map<std::int32_t, std::map<std::int32_t, int>> counts;
    double sum = 0, n = 0;
    const std::vector<double> r = record_.numbers("superposition/rotation_row_major"),
                              t = record_.numbers("superposition/translation_A");
    if (r.size() != 9 || t.size() != 3) throw InputError(record_.path() + ": has no superposition; compare again");
    const auto superposed = [&](const Vec3d& p) {
      return Vec3d{r[0] * p.x + r[1] * p.y + r[2] * p.z + t[0], r[3] * p.x + r[4] * p.y + r[5] * p.z + t[1],
                   r[6] * p.x + r[7] * p.y + r[8] * p.z + t[2]};
    };
    for (const auto& run : record_.triples("superposition/paired_atoms")) {
      const auto is_inside = [&](std::size_t first, std::size_t n_atoms) {
        return run[2] <= n_atoms && first <= n_atoms - run[2];
      };
      if (!is_inside(run[0], source.residues.size()) || !is_inside(run[1], target.residues.size()))
        throw InputError(record_.path() +
                         ": superposition/paired_atoms names atoms that the structures lack; compare again");
      for (std::size_t k = 0; k < run[2]; ++k) {
        const Vec3d d = superposed(source.molecule.positions[run[0] + k]) - target.molecule.positions[run[1] + k];
        sum += dot(d, d);
        ++n;
        ++counts[source.residues[run[0] + k]][target.residues[run[1] + k]];
      }
    }
    lines_.add("n_paired_atoms", n, 0);
    if (n == record_.number("superposition/n_superposed_atoms")) {
      lines_.add("rmsd_A", std::sqrt(sum / n), 1e-4);
      lines_.cover("superposition/n_superposed_atoms");
    } else {
      for (const char* name : {"rmsd_A", "superposition/n_superposed_atoms"})
        lines_.explain(name, "it is that of some of the pairs (options/align)");
    }
    lines_.cover("superposition/paired_atoms");
    if (record_.size("superposition/domains") == 0) {
      double largest = 0;
      for (std::size_t v = 0; v < file_.positions.size(); ++v) {
        if (std::isfinite(file_.displacement[v]))
          largest = std::max(largest, std::fabs(norm(file_.positions[v] - superposed(file_.source_positions[v])) -
                                                file_.displacement[v]));
      }
      lines_.add_deviation("displacement at the vertices, largest deviation", largest, 1e-3);
      lines_.cover("superposition/rotation_row_major");
      lines_.cover("superposition/translation_A");
    } else {
      lines_.explain("superposition", "the domains' motions are in no file");
    }
    same_residue(source, target, counts);
  }

  void same_residue(const Side& source, const Side& target,
                    const std::map<std::int32_t, std::map<std::int32_t, int>>& counts) {
    std::map<std::int32_t, std::int32_t> partner;
    for (const auto& [residue, partners] : counts) {
      int most = 0;
      for (const auto& [other, n] : partners) {
        if (n <= most) continue;
        most = n;
        partner[residue] = other;
      }
    }
    const std::vector<double> weight = file_.weights(file_.is_matched);
    double all = 0, same = 0, wrong = 0, wrong_there = 0, compared = 0;
    for (std::size_t v = 0; v < weight.size(); ++v) {
      if (weight[v] <= 0) continue;
      const std::int32_t own = source.atoms.strongest(file_.source_positions[v], source.residues);
      all += weight[v];
      wrong += own == static_cast<std::int32_t>(file_.residue[v]) ? 0 : weight[v];
      const std::int32_t there = target.atoms.strongest(file_.positions[v], target.residues);
      wrong_there += there == static_cast<std::int32_t>(file_.target_residue[v]) ? 0 : weight[v];
      const auto found = partner.find(own);
      if (found == partner.end()) continue;
      compared += weight[v];
      same += there == found->second ? weight[v] : 0;
    }
    lines_.add_deviation("residues of the vertices, share of the area that differs", wrong / all, kResidueTolerance);
    lines_.add_deviation("residues of the mapped vertices, share of the area that differs", wrong_there / all,
                         kResidueTolerance);
    lines_.cover("OUT.vtp/target_residue_index");
    add_trust_lines(file_, residues_, partner, lines_);
    lines_.add("certificate/same_residue_area_fraction",
               compared > 0 ? same / compared : std::numeric_limits<double>::quiet_NaN(), kResidueTolerance);
  }

  /// The unit in which maps are given; the result's says besides that they are in vacuum.
  std::string unit_of_maps() const {
    const std::string unit = record_.text("potential_unit");
    return unit.substr(0, unit.find(" in vacuum"));
  }

  /// The potentials at the vertices, from given map files.
  void maps() {
    if (file_.potential_source.empty()) return;
    for (const bool is_source : {true, false}) {
      const std::string role = is_source ? "source" : "target", array = "potential_" + role;
      const auto entry = record_.input(role + "_map");
      const double offset = record_.number("by_offset/0/offset_A").value_or(0);
      std::string why;
      double largest = 0, scale = 0;
      if (!entry || entry->computed) {
        why = "the map was computed and is in no file";
      } else if (offset != 0) {
        why = "it was read outside the surface (options/offset)";
      } else {
        why = map_deviation(*entry, unit_of_maps(), is_source ? file_.source_positions : file_.positions,
                            is_source ? file_.potential_source : file_.potential_target, largest, scale);
      }
      if (why.empty()) {
        lines_.cover(record_.place_of_input(role + "_map") + "/sha256");
        lines_.add_deviation(array + " at the vertices, largest deviation from the map", largest, 1e-4 * scale);
      } else {
        result_.not_recomputed.push_back(array + " at single vertices: " + why);
      }
    }
  }

  std::string prefix_;
  ResultRecord record_;
  MappedFile file_;
  CsvTable residues_;
  Verification result_;
  Lines lines_;
};

}  // namespace

Verification verify(const std::string& prefix) { return Verifier(prefix).run(); }

}  // namespace espdiff
