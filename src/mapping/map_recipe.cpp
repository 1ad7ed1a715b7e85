// map_recipe.cpp: computed potentials in words, and what two of them do not have in common.
#include "mapping/map_recipe.h"

#include <cmath>

#include "base/formatted.h"

namespace espdiff {
namespace {

double volume_of(const PmeCell& cell) { return dot(cell.edges[0], cross(cell.edges[1], cell.edges[2])); }

std::string of_dielectric(const CoulombOptions& o) {
  return "dielectric " + formatted("%.4g", o.dielectric) + (o.distance_dependent ? " r" : "");
}

/// A charge that was rounded in a file is whole to about this much.
constexpr double kWhole = 0.02;

void note_fraction(const char* side, const MapRecipe& r, std::vector<std::string>& notes) {
  if (std::fabs(r.net_charge - std::round(r.net_charge)) <= kWhole) return;
  notes.push_back(std::string("the charges of the ") + side + " add up to " + formatted("%.4f", r.net_charge) +
                  " e, which is not a whole number: atoms or charges may be missing");
}

void note_charges(const MapRecipe& source, const MapRecipe& target, std::vector<std::string>& notes) {
  if (std::fabs(source.net_charge - target.net_charge) <= kWhole) return;
  notes.push_back("the net charges differ, " + formatted("%.3g", source.net_charge) + " and " +
                  formatted("%.3g", target.net_charge) +
                  " e: each periodic cell is neutralized by a uniform background "
                  "of its own, which changes the difference; zero is the " +
                  to_string(source.zero) + (source.zero == target.zero ? "" : " and the " + to_string(target.zero)));
}

void note_cells(const MapRecipe& source, const MapRecipe& target, std::vector<std::string>& notes) {
  constexpr double kSameVolume = 0.01;
  const double a = volume_of(source.cell), b = volume_of(target.cell);
  if (std::fabs(a - b) <= kSameVolume * std::max(a, b)) return;
  notes.push_back("the periodic cells differ, " + formatted("%.0f", a) + " and " + formatted("%.0f", b) +
                  " A^3: the zero, the " + to_string(source.zero) + ", depends on that where the molecule is charged");
}

}  // namespace

std::string to_string(PotentialMethod method) {
  switch (method) {
    case PotentialMethod::kPme: return "pme";
    case PotentialMethod::kCoulomb: return "coulomb";
    case PotentialMethod::kPoissonBoltzmann: break;
  }
  return "pb";
}

std::string to_string(ZeroPlace zero) {
  switch (zero) {
    case ZeroPlace::kCellMean: return "mean of the cell";
    case ZeroPlace::kBulkSolvent: return "bulk solvent";
    case ZeroPlace::kFarAway: break;
  }
  return "far away";
}

bool is_vacuum(const MapRecipe& r) {
  if (r.method == PotentialMethod::kPme) return !r.has_water;
  return r.method == PotentialMethod::kCoulomb && r.coulomb.dielectric == 1 && !r.coulomb.distance_dependent;
}

std::string potential_label(const MapRecipe& r) {
  if (r.method == PotentialMethod::kPoissonBoltzmann)
    return std::string(r.pb.nonlinear ? "nonlinear " : "") + "Poisson-Boltzmann, " +
           formatted("%.4g", r.pb.ionic_strength) + " mol/l";
  if (r.method == PotentialMethod::kCoulomb)
    return is_vacuum(r) ? "vacuum (Coulomb)" : "Coulomb, " + of_dielectric(r.coulomb);
  const std::string part = r.pme.part == PmePart::kFull ? "" : ", smooth part";
  const std::string frames = r.n_frames > 1 ? ", mean over " + std::to_string(r.n_frames) + " frames" : "";
  return r.has_water ? "PME with explicit water" + part + frames : "vacuum (PME without water" + part + frames + ")";
}

std::string differing_parameters(const MapRecipe& source, const MapRecipe& target) {
  std::string text;
  const auto compare = [&](const char* name, double a, double b) {
    if (a != b)
      text +=
          (text.empty() ? "" : ", ") + std::string(name) + " " + formatted("%.6g", a) + " and " + formatted("%.6g", b);
  };
  if (source.method != target.method) return text;
  if (source.method == PotentialMethod::kPme && source.pme.part == PmePart::kSmooth)
    compare("beta", source.pme.ewald_factor, target.pme.ewald_factor);
  if (source.method != PotentialMethod::kPoissonBoltzmann) return text;
  const PoissonBoltzmannOptions &p = source.pb, &q = target.pb;
  compare("ionic strength", p.ionic_strength, q.ionic_strength);
  compare("solute dielectric", p.solute_dielectric, q.solute_dielectric);
  compare("solvent dielectric", p.solvent_dielectric, q.solvent_dielectric);
  compare("ion radius", p.ion_radius_A, q.ion_radius_A);
  compare("probe radius", p.probe_radius_A, q.probe_radius_A);
  compare("temperature", p.temperature_K, q.temperature_K);
  compare("grid spacing", source.pb_spacing_A, target.pb_spacing_A);
  if (p.dielectric_boundary != q.dielectric_boundary || p.smoothing != q.smoothing)
    text += (text.empty() ? "" : ", ") + std::string("the boundary of the dielectric");
  return text;
}

std::vector<std::string> potential_notes(const MapRecipe* source, const MapRecipe* target) {
  std::vector<std::string> notes;
  if (source != nullptr) note_fraction("source", *source, notes);
  if (target != nullptr) note_fraction("target", *target, notes);
  if (source != nullptr && target != nullptr) {
    const bool both_periodic = source->method == PotentialMethod::kPme && target->method == PotentialMethod::kPme;
    if (both_periodic) note_charges(*source, *target, notes);
    if (both_periodic) note_cells(*source, *target, notes);
    if (source->zero != target->zero)
      notes.push_back("zero is the " + to_string(source->zero) + " of the source's potential and the " +
                      to_string(target->zero) + " of the target's: the mean signed difference means little");
  }
  if ((source != nullptr && is_vacuum(*source)) || (target != nullptr && is_vacuum(*target)))
    notes.push_back("a potential in vacuum is tens of times that in salt water: compare it with its like only");
  return notes;
}

}  // namespace espdiff
