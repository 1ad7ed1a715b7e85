// metrics.cpp: the table of metrics, and how its values are got and written.
#include "report/records/metrics.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <mutex>
#include <tuple>

#include "base/error.h"
#include "base/formatted.h"
#include "base/molecule/surface_parts.h"
#include "base/not_a_number.h"
#include "certificate/region_result.h"
#include "certificate/result.h"
#include "engine/potential_sums.h"
#include "field/field_kinds.h"
#include "options/input_settings.h"
#include "options/options.h"

namespace espdiff {
namespace {

template <double Certificate::*Member>
double of_certificate(const MeasuredSurface& result) {
  return result.certificate.*Member;
}
template <DistanceSummary Certificate::*Side, double DistanceSummary::*Member>
double of_distances(const MeasuredSurface& result) {
  return result.certificate.*Side.*Member;
}
template <double DistortionReport::*Member>
double of_distortion(const MeasuredSurface& result) {
  return result.certificate.distortion.*Member;
}
template <double RoundTrip::*Member>
double of_round_trip(const MeasuredSurface& result) {
  return result.certificate.round_trip ? (*result.certificate.round_trip).*Member : kNaN;
}

template <double RemovedArea::*Member>
double of_removed(const MeasuredSurface& result) {
  return result.certificate.removed.*Member;
}

double residue_correlation(const MeasuredSurface& result) {
  return result.certificate.residues ? result.certificate.residues->correlation : kNaN;
}

double outside_maps(const MeasuredSurface& result) {
  return result.potential.compared ? result.certificate.outside_maps : kNaN;
}

template <double SlipSummary::*Member>
double of_slip(const MeasuredSurface& result) {
  return result.certificate.slip ? (*result.certificate.slip).*Member : kNaN;
}

double trusted_of_source(const MeasuredSurface& result) { return result.certificate.trusted.source; }
double trusted_of_target(const MeasuredSurface& result) { return result.certificate.trusted.target; }
double turned_of_trusted(const MeasuredSurface& result) { return result.certificate.turned.of_trusted; }
double difference_without_turned(const MeasuredSurface& result) {
  return result.potential.compared ? result.certificate.turned.mean_abs_difference : kNaN;
}
template <Why Reason>
double not_trusted(const MeasuredSurface& result) {
  return result.certificate.trusted.by_why[static_cast<std::size_t>(Reason)];
}

double rmsd(const MeasuredSurface& result) { return result.rmsd_A; }
double source_area(const MeasuredSurface& result) { return result.source_surface.area_A2; }
double target_area(const MeasuredSurface& result) { return result.target_surface.area_A2; }
double mapped_area(const MeasuredSurface& result) { return result.area_mapped_A2; }
double intersecting_pairs(const MeasuredSurface& result) {
  return static_cast<double>(result.certificate.self_intersecting_pairs);
}
double iterations(const MeasuredSurface& result) { return static_cast<double>(result.n_steps); }

std::vector<Metric> make_metrics() {
  using S = MetricSection;
  using U = MetricUnit;
  using C = Certificate;
  using D = DistanceSummary;
  constexpr unsigned kNowhere = 0, kBoth = kInSeries | kInMatrix;
  return {
      {"rmsd_A", "RMSD", S::kSuperposition, U::kAngstrom, kBoth, "Of the paired atoms after the superposition", rmsd},
      {"area_A2",
       "Area compared",
       S::kShape,
       U::kSquareAngstrom,
       kNowhere,
       "Area of the mapped surface on which the numbers rest",
       {&Metrics::area_A2, &ResidueRow::area_A2},
       "/area_A2/trusted"},
      {"trusted_area_fraction", "Trusted area", S::kShape, U::kFraction, kNowhere,
       "Share of the residue's surface on the source that is trusted", &ResidueRow::trusted_area_fraction},
      {"mean_abs_difference",
       "Mean absolute difference",
       S::kPotential,
       U::kPotential,
       kBoth,
       "Mean absolute difference of the potentials at corresponding points, weighted by area",
       {&Metrics::mean_abs_difference, &ResidueRow::mean_abs_difference}},
      {"rms_difference", "RMS difference", S::kPotential, U::kPotential, kBoth,
       "Root of the mean squared difference of the potentials", &Metrics::rms_difference},
      {"mean_signed_difference",
       "Mean signed difference",
       S::kPotential,
       U::kPotential,
       kBoth | kAntisymmetric,
       "Mean of target - source, with its sign",
       {&Metrics::mean_signed_difference, &ResidueRow::mean_signed_difference}},
      {"mean_source", "Mean potential, source", S::kPotential, U::kPotential, kNowhere,
       "Mean potential on the source's surface", &ResidueRow::mean_source},
      {"mean_target", "Mean potential, target", S::kPotential, U::kPotential, kNowhere,
       "Mean potential at the corresponding points of the target's surface", &ResidueRow::mean_target},
      {"sign_change_area_fraction",
       "Area whose sign changes",
       S::kPotential,
       U::kFraction,
       kBoth,
       "Share of the area where the potential has another sign on the target",
       {&Metrics::sign_change_area_fraction, &ResidueRow::sign_change_area_fraction}},
      {"hodgkin_index", "Hodgkin index", S::kPotential, U::kIndex, kBoth,
       "Similarity of the potentials: 1 same, 0 unrelated, -1 opposite", &Metrics::hodgkin_index},
      {"carbo_index", "Carbo index", S::kPotential, U::kIndex, kInMatrix,
       "Similarity of the potentials' patterns, whatever their magnitudes: 1 same, 0 unrelated, -1 opposite",
       &Metrics::carbo_index},
      {"mean_displacement_A",
       "Mean displacement",
       S::kShape,
       U::kAngstrom,
       kBoth,
       "How far points of the source's surface travel to the target's: the farther, the less certain",
       {&Metrics::mean_displacement_A, &ResidueRow::mean_displacement_A}},
      {"mean_path_length_A",
       "Mean path length",
       S::kShape,
       U::kAngstrom,
       kNowhere,
       "Length of the points' paths: the more it exceeds the displacement, the less certain",
       {&Metrics::mean_path_length_A, &ResidueRow::mean_path_length_A}},
      {"own_difference", "Difference on its own surface", S::kPotential, U::kPotential, kNowhere,
       "The residue's mean potential on the target's own surface minus that on the source's, without a mapping",
       &ResidueRow::own_difference},
      {"own_area_A2", "Area of its own surfaces", S::kPotential, U::kSquareAngstrom, kNowhere,
       "Harmonic mean of the residue's areas on the two surfaces: the weight of its difference there",
       &ResidueRow::own_area_A2},
      {"mean_slip_A", "Mean slip", S::kShape, U::kAngstrom, kNowhere,
       "Mean distance of the points from where their own atoms carried them: the farther, the less certain",
       &ResidueRow::mean_slip_A},
      {"slip_area_fraction", "Area of a slip beyond 3 A", S::kShape, U::kFraction, kNowhere,
       "Share of the area that slipped farther than the distance between neighbouring residues",
       &ResidueRow::slip_area_fraction},
      {"area_source_A2", "Area of the source", S::kSurface, U::kSquareAngstrom, kNowhere, "Surface area of the source",
       source_area, "/area_A2/source", "Area", "source"},
      {"area_target_A2", "Area of the target", S::kSurface, U::kSquareAngstrom, kNowhere, "Surface area of the target",
       target_area, "/area_A2/target", "Area", "target"},
      {"area_mapped_A2", "Area of the mapped surface", S::kSurface, U::kSquareAngstrom, kBoth,
       "Area of the source's surface after it was mapped onto the target", mapped_area, "/area_A2/mapped", "Area",
       "mapped"},
      {"trusted_source", "Trusted area, source", S::kCertificate, U::kFraction, kBoth,
       "Share of the source's surface on which the numbers rest", trusted_of_source,
       "/certificate/trusted_area_fraction/source", "Trusted area", "source"},
      {"trusted_target", "Trusted area, target", S::kCertificate, U::kFraction, kBoth,
       "Share of the target's surface on which the numbers rest", trusted_of_target,
       "/certificate/trusted_area_fraction/target", "Trusted area", "target"},
      {"untrusted_unmatched", "Not trusted, unmatched", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface without a place on the target", not_trusted<Why::kUnmatched>,
       "/certificate/not_trusted/unmatched", "Not trusted of the source", "unmatched"},
      {"untrusted_corrupt", "Not trusted, corrupt", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface whose place is not on the target's surface", not_trusted<Why::kCorrupt>,
       "/certificate/not_trusted/corrupt", "Not trusted of the source", "corrupt"},
      {"untrusted_unpaired", "Not trusted, unpaired", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface whose residue has no partner", not_trusted<Why::kUnpaired>,
       "/certificate/not_trusted/unpaired", "Not trusted of the source", "unpaired"},
      {"untrusted_slipped", "Not trusted, slipped", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface that slipped by more than 3 A", not_trusted<Why::kSlipped>,
       "/certificate/not_trusted/slipped", "  or for its place", "slipped"},
      {"untrusted_other_residue", "Not trusted, on another residue", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface that lies on another residue than the paired one",
       not_trusted<Why::kOtherResidue>, "/certificate/not_trusted/other_residue", "  or for its place", "off residue"},
      {"untrusted_turned", "Not trusted, turned", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface on residues that turned as a whole, farther than 3 A from where their atoms "
       "went, and on side chains that turned, farther than 8 A (3 A with leave-out-turned)",
       not_trusted<Why::kTurned>, "/certificate/not_trusted/turned", "  or for its place", "turned"},
      {"untrusted_disagrees", "Not trusted, disagrees", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface of residues whose difference is not that of their own surfaces",
       not_trusted<Why::kDisagrees>, "/certificate/not_trusted/disagrees", "  or for its potential", "disagrees"},
      {"untrusted_no_potential", "Not trusted, without a potential", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's surface outside the maps", not_trusted<Why::kNoPotential>,
       "/certificate/not_trusted/no_potential", "  or for its potential", "missing"},
      {"turned_area_fraction", "Trusted area on turned side chains", S::kCertificate, U::kFraction, kBoth,
       "Share of the source's trusted area on side chains that turned, farther than 3 A from where their atoms went: "
       "there the residue is right, but not its face",
       turned_of_trusted, "/certificate/turned_side_chains/of_trusted_area", "On turned side chains", "area"},
      {"difference_without_turned", "Difference without turned side chains", S::kCertificate, U::kPotential, kNowhere,
       "Mean absolute difference over the trusted area that is on no turned side chain", difference_without_turned,
       "/certificate/turned_side_chains/mean_abs_difference_without", "On turned side chains", "without"},
      {"corrupt_area_fraction", "Corrupt area", S::kCertificate, U::kFraction, kBoth | kRemovable,
       "Share of the mapped area that does not lie on the target's surface; the morph removes it",
       of_certificate<&C::corrupt_area_fraction>, "/certificate/corrupt_area_fraction"},
      {"flipped_area_fraction", "Flipped area", S::kCertificate, U::kFraction, kBoth | kRemovable,
       "Share of the mapped area that is turned inside out; the morph removes it",
       of_certificate<&C::flipped_area_fraction>, "/certificate/flipped_area_fraction"},
      {"self_intersecting_pairs", "Intersecting pairs of triangles", S::kCertificate, U::kCount, kInMatrix | kRemovable,
       "Pairs of triangles of the mapped surface that intersect; the morph removes them", intersecting_pairs,
       "/certificate/self_intersecting_pairs"},
      {"removed_torn", "Removed area, torn", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's area that was torn or crushed while its atoms moved", of_removed<&RemovedArea::torn>,
       "/certificate/removed/torn", "Removed of the source as", "torn"},
      {"removed_intersecting", "Removed area, intersecting", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's area whose triangles would intersect", of_removed<&RemovedArea::intersecting>,
       "/certificate/removed/intersecting", "Removed of the source as", "crossing"},
      {"removed_flipped", "Removed area, flipped", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's area that would be turned inside out", of_removed<&RemovedArea::flipped>,
       "/certificate/removed/flipped", "Removed of the source as", "flipped"},
      {"removed_corrupt", "Removed area, corrupt", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's area that would not lie on the target's surface", of_removed<&RemovedArea::corrupt>,
       "/certificate/removed/corrupt", "  or for its place, as", "corrupt"},
      {"removed_far", "Removed area, far", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's area farther than 1 A from the target", of_removed<&RemovedArea::far>,
       "/certificate/removed/far", "  or for its place, as", "far"},
      {"removed_grown", "Removed area, grown", S::kCertificate, U::kFraction, kNowhere,
       "Share of the source's area that grew more than tenfold", of_removed<&RemovedArea::grown>,
       "/certificate/removed/grown", "  or for its place, as", "grown"},
      {"no_counterpart_source", "Unmatched area, source", S::kCertificate, U::kFraction, kBoth,
       "Share of the source's area that has no place on the target", of_certificate<&C::unmatched_source>,
       "/certificate/no_counterpart_area_fraction/source", "Unmatched area", "source"},
      {"no_counterpart_target", "Unmatched area, target", S::kCertificate, U::kFraction, kBoth,
       "Share of the target's area that nothing was mapped to", of_certificate<&C::unmatched_target>,
       "/certificate/no_counterpart_area_fraction/target", "Unmatched area", "target"},
      {"mapped_to_target_mean_A", "Distance of the mapped surface to the target", S::kCertificate, U::kAngstrom,
       kInMatrix, "Mean distance of the mapped surface to the target's", of_distances<&C::mapped_to_target, &D::mean>,
       "/certificate/mapped_to_target_A/mean", "Mapped to target", "mean"},
      {"mapped_to_target_p95_A", "95th percentile of the distance of the mapped surface to the target", S::kCertificate,
       U::kAngstrom, kNowhere, "95 % of the mapped area lies nearer to the target's surface",
       of_distances<&C::mapped_to_target, &D::p95>, "/certificate/mapped_to_target_A/p95", "Mapped to target", "p95"},
      {"mapped_to_target_max_A", "Greatest distance of the mapped surface to the target", S::kCertificate, U::kAngstrom,
       kNowhere, "Greatest distance of the mapped surface to the target's", of_distances<&C::mapped_to_target, &D::max>,
       "/certificate/mapped_to_target_A/max", "Mapped to target", "max"},
      {"mapped_to_target_mean_within_limit_A", "Distance of the mapped surface to the target, within 1 A",
       S::kCertificate, U::kAngstrom, kNowhere, "Mean distance to the target's surface of what lies within 1 A",
       of_distances<&C::mapped_to_target, &D::mean_within_limit>, "/certificate/mapped_to_target_A/mean_within_limit",
       "  where within 1 A", "mean"},
      {"target_to_mapped_mean_A", "Distance of the target to the mapped surface", S::kCertificate, U::kAngstrom,
       kInMatrix, "Mean distance of the target's surface to the mapped one",
       of_distances<&C::target_to_mapped, &D::mean>, "/certificate/target_to_mapped_A/mean", "Target to mapped",
       "mean"},
      {"target_to_mapped_p95_A", "95th percentile of the distance of the target to the mapped surface", S::kCertificate,
       U::kAngstrom, kNowhere, "95 % of the target's area lies nearer to the mapped surface",
       of_distances<&C::target_to_mapped, &D::p95>, "/certificate/target_to_mapped_A/p95", "Target to mapped", "p95"},
      {"target_to_mapped_max_A", "Greatest distance of the target to the mapped surface", S::kCertificate, U::kAngstrom,
       kBoth, "Greatest distance of the target's surface to the mapped one",
       of_distances<&C::target_to_mapped, &D::max>, "/certificate/target_to_mapped_A/max", "Target to mapped", "max"},
      {"target_to_mapped_mean_within_limit_A", "Distance of the target to the mapped surface, within 1 A",
       S::kCertificate, U::kAngstrom, kNowhere, "Mean distance to the mapped surface of what lies within 1 A",
       of_distances<&C::target_to_mapped, &D::mean_within_limit>, "/certificate/target_to_mapped_A/mean_within_limit",
       "  where within 1 A", "mean"},
      {"slip_mean_A", "Slip", S::kCertificate, U::kAngstrom, kBoth,
       "Mean distance of the mapped points from where their own atoms carried them", of_slip<&SlipSummary::mean_A>,
       "/certificate/slip/mean_A", "Slip", "mean"},
      {"slip_median_A", "Median slip", S::kCertificate, U::kAngstrom, kNowhere, "Half of the mapped area slipped less",
       of_slip<&SlipSummary::median_A>, "/certificate/slip/median_A", "Slip", "median"},
      {"slip_p95_A", "95th percentile of the slip", S::kCertificate, U::kAngstrom, kBoth,
       "95 % of the mapped area slipped less", of_slip<&SlipSummary::p95_A>, "/certificate/slip/p95_A", "Slip", "p95"},
      {"slip_max_A", "Greatest slip", S::kCertificate, U::kAngstrom, kNowhere,
       "Greatest distance of a mapped point from where its own atoms carried it", of_slip<&SlipSummary::max_A>,
       "/certificate/slip/max_A", "Slip", "max"},
      {"slip_beyond_2A", "Area of a slip beyond 2 A, whole surface", S::kCertificate, U::kFraction, kBoth,
       "Share of the mapped area that slipped by more than 2 A", of_slip<&SlipSummary::medium_area_fraction>,
       "/certificate/slip/beyond_2A_area_fraction", "Slipped area", "2 A"},
      {"slip_beyond_3A", "Area of a slip beyond 3 A, whole surface", S::kCertificate, U::kFraction, kBoth,
       "Share of the mapped area that slipped by more than 3 A", of_slip<&SlipSummary::large_area_fraction>,
       "/certificate/slip/beyond_3A_area_fraction", "Slipped area", "3 A"},
      {"slip_unpaired", "Mapped area without partners", S::kCertificate, U::kFraction, kNowhere,
       "Share of the mapped area whose atoms have no partner, so that its slip is not known",
       of_slip<&SlipSummary::unpaired_area_fraction>, "/certificate/slip/unpaired_area_fraction"},
      {"residue_correlation", "Residue correlation", S::kCertificate, U::kIndex, kBoth,
       "Correlation of the residues' mean differences with those of their potentials on their own surfaces",
       residue_correlation, "/certificate/residues/correlation"},
      {"outside_maps", "Area outside the maps", S::kCertificate, U::kFraction, kBoth,
       "Share of the mapped area that lies outside a map and is in no number", outside_maps,
       "/certificate/outside_maps_area_fraction"},
      {"round_trip_mean_A", "Round-trip error", S::kCertificate, U::kAngstrom, kNowhere,
       "Mean distance from its start at which a point ends that a second mapping takes back",
       of_round_trip<&RoundTrip::mean_A>, "/certificate/round_trip/mean_A", "Round-trip error", "mean"},
      {"round_trip_p95_A", "95th percentile of the round-trip error", S::kCertificate, U::kAngstrom, kNowhere,
       "95 % of the area ends nearer to its start", of_round_trip<&RoundTrip::p95_A>, "/certificate/round_trip/p95_A",
       "Round-trip error", "p95"},
      {"round_trip_max_A", "Greatest round-trip error", S::kCertificate, U::kAngstrom, kNowhere,
       "Greatest distance from its start at which a point ends", of_round_trip<&RoundTrip::max_A>,
       "/certificate/round_trip/max_A", "Round-trip error", "max"},
      {"round_trip_unmatched_target", "Unmatched area of the mapping back", S::kCertificate, U::kFraction, kNowhere,
       "Share of the target's area that the second mapping did not match",
       of_round_trip<&RoundTrip::unmatched_target_area_fraction>, "/certificate/round_trip/lost_target_area_fraction",
       "Unmatched by the way back", "target"},
      {"area_ratio_p05", "5th percentile of the area ratio", S::kCertificate, U::kIndex, kNowhere,
       "5 % of the source's area has a smaller ratio of mapped area to source area",
       of_distortion<&DistortionReport::area_ratio_p05>, "/certificate/area_ratio/p05", "Mapped area / source area",
       "p05"},
      {"area_ratio_median", "Median area ratio", S::kCertificate, U::kIndex, kNowhere,
       "Median ratio of mapped area to source area", of_distortion<&DistortionReport::area_ratio_median>,
       "/certificate/area_ratio/median", "Mapped area / source area", "median"},
      {"area_ratio_p95", "95th percentile of the area ratio", S::kCertificate, U::kIndex, kNowhere,
       "95 % of the source's area has a smaller ratio of mapped area to source area",
       of_distortion<&DistortionReport::area_ratio_p95>, "/certificate/area_ratio/p95", "Mapped area / source area",
       "p95"},
      {"symmetric_dirichlet_median", "Median distortion", S::kCertificate, U::kIndex, kNowhere,
       "Median symmetric Dirichlet energy: 1 where nothing is distorted",
       of_distortion<&DistortionReport::dirichlet_median>, "/certificate/symmetric_dirichlet/median", "Distortion",
       "median"},
      {"symmetric_dirichlet_p95", "95th percentile of the distortion", S::kCertificate, U::kIndex, kNowhere,
       "95 % of the source's area has a smaller symmetric Dirichlet energy",
       of_distortion<&DistortionReport::dirichlet_p95>, "/certificate/symmetric_dirichlet/p95", "Distortion", "p95"},
      {"same_residue_area_fraction", "Area on the same residue", S::kCertificate, U::kFraction, kInMatrix,
       "Share of the mapped area whose residue on the target is the one paired with that on the source",
       of_certificate<&C::same_residue_area_fraction>, "/certificate/same_residue_area_fraction"},
      {"irregularity_A", "Irregularity", S::kCertificate, U::kAngstrom, kNowhere,
       "Mean length of the umbrella Laplacian of the mapped mesh", of_certificate<&C::irregularity_A>,
       "/certificate/irregularity_A"},
      {"iterations", "Iterations or steps", S::kMapping, U::kCount, kBoth,
       "Iterations of the deformation, or steps of the morph", iterations},
  };
}

/// Guards the tables of parts and of fields, and their texts.
std::mutex& one_at_a_time() {
  static std::mutex guard;
  return guard;
}

std::vector<Metric>& table() {
  static std::vector<Metric> all = make_metrics();
  return all;
}

/// The rows of every field; the potential's have other words. Sign change and Hodgkin's index come last.
std::vector<Metric> field_rows(bool is_signed) {
  using S = MetricSection;
  using U = MetricUnit;
  constexpr unsigned kNowhere = 0, kBoth = kInSeries | kInMatrix;
  std::vector<Metric> rows = {
      {"area_A2", "Area with values", S::kPotential, U::kSquareAngstrom, kBoth,
       "Area of the mapped surface on which the numbers rest", &Metrics::area_A2},
      {"mean_abs_difference",
       "Mean absolute difference",
       S::kPotential,
       U::kPotential,
       kBoth,
       "Mean absolute difference of the field at corresponding points, weighted by area",
       {&Metrics::mean_abs_difference, &ResidueRow::mean_abs_difference}},
      {"rms_difference", "RMS difference", S::kPotential, U::kPotential, kBoth,
       "Root of the mean squared difference of the field", &Metrics::rms_difference},
      {"mean_signed_difference",
       "Mean signed difference",
       S::kPotential,
       U::kPotential,
       kBoth | kAntisymmetric,
       "Mean of target - source, with its sign",
       {&Metrics::mean_signed_difference, &ResidueRow::mean_signed_difference}},
      {"correlation", "Correlation", S::kPotential, U::kIndex, kBoth,
       "Pearson's correlation of the field's values at corresponding points", &Metrics::correlation},
      {"mean_source", "Mean, source", S::kPotential, U::kPotential, kNowhere, "Mean on the source's surface",
       &ResidueRow::mean_source},
      {"mean_target", "Mean, target", S::kPotential, U::kPotential, kNowhere,
       "Mean at the corresponding points of the target's surface", &ResidueRow::mean_target}};
  if (!is_signed) return rows;
  rows.push_back({"sign_change_area_fraction",
                  "Area whose sign changes",
                  S::kPotential,
                  U::kFraction,
                  kBoth,
                  "Share of the area where the field has another sign on the target",
                  {&Metrics::sign_change_area_fraction, &ResidueRow::sign_change_area_fraction}});
  rows.push_back({"hodgkin_index", "Hodgkin index", S::kPotential, U::kIndex, kBoth,
                  "Similarity of the field: 1 same, 0 unrelated, -1 opposite", &Metrics::hodgkin_index});
  return rows;
}

/// Texts that names of metrics point to, which must stay where they are.
const char* kept(const std::string& text) {
  static std::deque<std::string> texts;
  return texts.emplace_back(text).c_str();
}

std::vector<Metric> make_field_metrics(const Quantity& field, const std::string& part) {
  std::vector<Metric> all = field_rows(field.is_signed);
  for (Metric& metric : all) {
    metric.json = kept(field_pointer(field.name, part) + "/" + metric.name);
    metric.name = kept((part.empty() ? "" : part + "_") + field.name + "_" + metric.name);
    metric.label = kept(std::string(metric.label) + ", " + field.name + (part.empty() ? "" : ", " + part));
    metric.part = kept(part);
    metric.field = kept(field.name);
    metric.field_unit = kept(field.unit);
  }
  return all;
}

std::vector<Metric> make_part_metrics(const std::string& part) {
  MeasuredSurface scratch;
  scratch.certificate.not_checked = unchecked_in_parts();
  std::vector<Metric> all;
  for (const Metric& metric : metrics()) {
    if (!metric.has_result() || metric.section == MetricSection::kMapping || is_unchecked(metric, scratch)) continue;
    Metric of_part = metric;
    of_part.name = kept(part + "_" + metric.name);
    of_part.label = kept(std::string(metric.label) + ", " + part);
    of_part.json = kept(part_pointer(part) + metric.json_pointer());
    of_part.part = kept(part);
    all.push_back(of_part);
  }
  return all;
}

}  // namespace

const std::vector<Metric>& metrics() { return table(); }

void add_metric(const Metric& metric) {
  if (find_metric_or_null(metric.name) != nullptr)
    throw Error(ErrorClass::kInternal, std::string("there is a metric '") + metric.name + "' already");
  table().push_back(metric);
}

const std::vector<Metric>& part_metrics(const std::string& part) {
  static std::map<std::string, std::vector<Metric>> known;
  const std::lock_guard<std::mutex> lock(one_at_a_time());
  const auto found = known.find(part);
  return found != known.end() ? found->second : known.emplace(part, make_part_metrics(part)).first->second;
}

const std::vector<Metric>& field_metrics(const Quantity& field, const std::string& part) {
  static std::map<std::string, std::vector<Metric>> known;
  const std::lock_guard<std::mutex> lock(one_at_a_time());
  const std::string key = field.name + '\n' + field.unit + '\n' + (field.is_signed ? "1" : "0") + '\n' + part;
  const auto found = known.find(key);
  return found != known.end() ? found->second : known.emplace(key, make_field_metrics(field, part)).first->second;
}

std::string field_pointer(const std::string& field, const std::string& part) {
  return (part.empty() ? "" : part_pointer(part)) + "/fields/" + field;
}

std::vector<Metric> residue_metrics(const CompareResult& result) {
  std::vector<Metric> all;
  const auto add = [&all](const std::vector<Metric>& more) {
    std::copy_if(more.begin(), more.end(), std::back_inserter(all), [](const Metric& m) { return m.has_residues(); });
  };
  add(metrics());
  for (const FieldResult& field : result.fields) add(field_metrics(field.quantity));
  return all;
}

bool PartsAndFields::operator<(const PartsAndFields& other) const {
  const auto key = [](const Quantity& q) { return std::tie(q.name, q.label, q.unit, q.is_signed); };
  if (parts != other.parts) return parts < other.parts;
  return std::lexicographical_compare(fields.begin(), fields.end(), other.fields.begin(), other.fields.end(),
                                      [&](const Quantity& a, const Quantity& b) { return key(a) < key(b); });
}

PartsAndFields parts_and_fields(const CompareResult& result) {
  PartsAndFields compared(part_names(result.parts));
  for (const FieldResult& field : result.fields) compared.fields.push_back(field.quantity);
  return compared;
}

PartsAndFields parts_and_fields(const CompareOptions& options) {
  PartsAndFields compared(part_names(options.input));
  for (const Field& field : make_fields(options.fields)) compared.fields.push_back(field.quantity);
  return compared;
}

std::vector<Metric> all_field_metrics(const PartsAndFields& compared) {
  std::vector<Metric> all;
  for (const Quantity& field : compared.fields) {
    const auto add = [&](const std::string& part) {
      const std::vector<Metric>& rows = field_metrics(field, part);
      std::copy_if(rows.begin(), rows.end(), std::back_inserter(all), [](const Metric& m) { return m.has_result(); });
    };
    add("");
    for (const std::string& part : compared.parts) add(part);
  }
  return all;
}

const FieldResult* field_of(const MeasuredSurface& result, const std::string& name) {
  const auto found = std::find_if(result.fields.begin(), result.fields.end(),
                                  [&](const FieldResult& field) { return field.quantity.name == name; });
  return found == result.fields.end() ? nullptr : &*found;
}

std::string part_pointer(const std::string& part) {
  return part == kRegionPart ? std::string("/") + kRegionPart : "/fixed_patches/" + part;
}

const Metric* find_metric_or_null(const std::string& name) {
  const auto found =
      std::find_if(metrics().begin(), metrics().end(), [&](const Metric& metric) { return metric.name == name; });
  return found == metrics().end() ? nullptr : &*found;
}

namespace {

/// "site" of "site_mean_difference"; empty where the name does not end like that.
std::string before_ending(const std::string& name, const std::string& ending) {
  const std::string all = "_" + ending;
  const bool fits = name.size() > all.size() && name.compare(name.size() - all.size(), all.size(), all) == 0;
  return fits ? name.substr(0, name.size() - all.size()) : std::string();
}

const Metric* find_in(const std::vector<Metric>& rows, const std::string& name) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Metric& metric) { return metric.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

const Metric* metric_of_column(const std::string& name, const std::vector<Quantity>& fields) {
  if (const Metric* const whole = find_metric_or_null(name)) return whole;
  for (const Quantity& field : fields) {
    if (const Metric* const metric = find_in(field_metrics(field), name)) return metric;
    for (const Metric& metric : field_metrics(field)) {
      const std::string part = before_ending(name, metric.name);
      if (!part.empty()) return find_in(field_metrics(field, part), name);
    }
  }
  for (const Metric& metric : metrics()) {
    const std::string part = before_ending(name, metric.name);
    const Metric* const of_part = part.empty() ? nullptr : find_in(part_metrics(part), name);
    if (of_part != nullptr) return of_part;
  }
  return nullptr;
}

double value_of(const Metric& metric, const CompareResult& result) {
  if (*metric.part == '\0') return value_on(metric, result);
  const PartResult* const part = part_of(result.parts, metric.part);
  return part == nullptr ? kNaN : value_on(metric, *part);
}

double value_on(const Metric& metric, const MeasuredSurface& result) {
  if (*metric.field != '\0') {
    const FieldResult* const field = field_of(result, metric.field);
    return field == nullptr ? kNaN : field->metrics.*metric.source.of_area;
  }
  if (metric.source.of_result != nullptr) return metric.source.of_result(result);
  return counted_metrics(result).*metric.source.of_area;
}

double value_over_all_triangles(const Metric& metric, const MeasuredSurface& result) {
  if (*metric.field != '\0') {
    const FieldResult* const field = field_of(result, metric.field);
    return field == nullptr ? kNaN : field->metrics_all.*metric.source.of_area;
  }
  if (metric.source.of_area == nullptr || !result.potential.compared) return kNaN;
  return result.potential.metrics_all.*metric.source.of_area;
}

double value_of(const Metric& metric, const CompareResult& result, const ResidueRow& row) {
  if (*metric.field != '\0') {
    const FieldResult* const field = field_of(result, metric.field);
    if (field == nullptr || row.residue >= field->residues.size()) return kNaN;
    return field->residues[row.residue].*static_cast<double ResidueMeans::*>(metric.source.of_residue);
  }
  if (metric.section == MetricSection::kPotential && !result.potential.compared) return kNaN;
  return row.*metric.source.of_residue;
}

bool is_unchecked(const Metric& metric, const MeasuredSurface& result) {
  const std::string pointer = metric.json_pointer();
  const auto& names = result.certificate.not_checked;
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return pointer.rfind("/certificate/" + name + "/", 0) == 0; });
}

std::string unit_of(const Metric& metric, const std::string& potential_unit) {
  switch (metric.unit) {
    case MetricUnit::kPotential: return *metric.field != '\0' ? metric.field_unit : potential_unit;
    case MetricUnit::kAngstrom: return "A";
    case MetricUnit::kSquareAngstrom: return "A^2";
    case MetricUnit::kFraction:
    case MetricUnit::kIndex:
    case MetricUnit::kCount: break;
  }
  return "";
}

ShownUnit shown_unit(const Metric& metric, const std::string& potential_unit) {
  if (metric.unit == MetricUnit::kFraction) return {"%", 100};
  return {unit_of(metric, potential_unit), 1};
}

std::string formatted(const Metric& metric, double value) {
  if (std::isnan(value)) return "-";
  switch (metric.unit) {
    case MetricUnit::kFraction: return formatted("%.3g", 100 * value) + " %";
    case MetricUnit::kSquareAngstrom: return formatted("%.1f", value);
    case MetricUnit::kCount: return formatted("%.0f", value);
    default: return formatted("%.4g", value);
  }
}

Metrics counted_metrics(const MeasuredSurface& result) {
  if (result.potential.compared) return result.potential.metrics;
  Metrics counted = PotentialSums().metrics();  // without area, all of potentials are NaN
  counted.mean_displacement_A = counted.mean_path_length_A = 0;
  for (const ResidueRow& row : result.residues) {
    if (!(row.area_A2 > 0)) continue;
    counted.area_A2 += row.area_A2;
    counted.mean_displacement_A += row.area_A2 * row.mean_displacement_A;
    counted.mean_path_length_A += row.area_A2 * row.mean_path_length_A;
  }
  const double area = counted.area_A2 > 0 ? counted.area_A2 : kNaN;
  counted.mean_displacement_A /= area;
  counted.mean_path_length_A /= area;
  return counted;
}

}  // namespace espdiff
