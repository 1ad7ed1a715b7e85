// residue_values.cpp: columns of the residue table by name.
#include "report/residue_values.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/version.h"
#include "causes/causes.h"
#include "certificate/result.h"
#include "io/files/atomic_file.h"
#include "io/molecules/write_pdb.h"
#include "report/records/metrics.h"
#include "report/sections/potential_json.h"

namespace espdiff {
namespace {

constexpr const char* kShareOfArea = "share";

/// NaN where a residue has no surface that is counted.
std::vector<double> residue_shares(const CompareResult& result) {
  std::vector<double> shares = residue_values(result, "mean_abs_difference");
  const std::vector<double> areas = residue_values(result, "area_A2");
  double sum = 0;
  for (std::size_t r = 0; r < shares.size(); ++r) {
    shares[r] *= areas[r];
    if (std::isfinite(shares[r])) sum += shares[r];
  }
  for (double& share : shares) share = sum > 0 ? share / sum : std::numeric_limits<double>::quiet_NaN();
  return shares;
}

/// What each residue of the source adds to the first reading's difference.
std::vector<double> residue_contributions(const CompareResult& result) {
  if (result.causes == nullptr || result.causes->readings.empty())
    throw InputError(std::string(kContribution) + " is what a residue adds to a reading: give " +
                     option("causes", "region") + ", or another of its readings");
  std::vector<double> values(result.residues.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Contribution& c : result.causes->readings.front().contributions) {
    const std::int32_t residue = result.causes->changes[c.change].source;
    for (std::size_t row = 0; residue >= 0 && row < values.size(); ++row) {
      if (result.residues[row].residue == static_cast<std::size_t>(residue)) values[row] = c.difference();
    }
  }
  return values;
}

Metric find_quantity(const std::string& name, const CompareResult& result) {
  std::string list = std::string(kShareOfArea) + ", " + kContribution;
  for (const Metric& metric : residue_metrics(result)) {
    if (metric.name == name) return metric;
    list += ", " + std::string(metric.name);
  }
  throw InputError("residues have no quantity '" + name + "'; there are: " + list);
}

}  // namespace

std::vector<std::string> residue_quantities() {
  std::vector<std::string> names{kShareOfArea, kContribution};
  for (const Metric& metric : residue_metrics({})) names.emplace_back(metric.name);
  return names;
}

void require_residue_quantity(const std::string& name, const std::vector<FieldRequest>& fields) {
  if (name == kShareOfArea || name == kContribution) return;
  CompareResult like;
  for (const FieldRequest& request : fields) {
    like.fields.emplace_back().quantity.name = request.name;
    like.fields.back().quantity.is_signed = true;
  }
  find_quantity(name, like);
}

std::string usual_residue_quantity(const CompareResult& result) {
  return result.potential.compared ? "mean_abs_difference" : "mean_displacement_A";
}

std::vector<double> residue_values(const CompareResult& result, const std::string& quantity) {
  if (quantity == kShareOfArea) return residue_shares(result);
  if (quantity == kContribution) return residue_contributions(result);
  const Metric metric = find_quantity(quantity, result);
  if (metric.section == MetricSection::kPotential && *metric.field == '\0' && !result.potential.compared)
    throw InputError(quantity + " needs potentials, and shapes alone were compared; take mean_displacement_A");
  std::vector<double> values;
  for (const ResidueRow& row : result.residues) values.push_back(value_of(metric, result, row));
  return values;
}

std::string residue_unit(const CompareResult& result, const std::string& quantity) {
  if (quantity == kShareOfArea) return "";
  if (quantity == kContribution) return potential_unit_text(result);
  return unit_of(find_quantity(quantity, result), potential_unit_text(result));
}

void write_residue_pdb(AtomicFile& file, const Molecule& source, const CompareResult& result,
                       const std::string& quantity) {
  const std::vector<double> of_residue = residue_values(result, quantity);
  std::vector<double> of_atom;
  for (const Atom& atom : source.atoms) of_atom.push_back(of_residue.at(static_cast<std::size_t>(atom.residue)));
  const std::string unit = residue_unit(result, quantity);
  write_pdb(file.stream(), source, of_atom,
            {"B FACTOR: " + quantity + (unit.empty() ? "" : " [" + unit + "]") + " OF THE RESIDUE",
             "OCCUPANCY 0: THE RESIDUE HAS NO SURFACE THAT IS COUNTED", std::string("WRITTEN BY espdiff ") + kVersion});
}

void write_residue_pdb(const std::string& path, const Molecule& source, const CompareResult& result,
                       const std::string& quantity) {
  AtomicFile file(path);
  write_residue_pdb(file, source, result, quantity);
  file.commit();
}

}  // namespace espdiff
