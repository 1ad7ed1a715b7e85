// residue_values.cpp: columns of the residue table by name.
#include "pipeline/residue_values.h"

#include "base/error.h"
#include "base/version.h"
#include "io/atomic_file.h"
#include "io/write_pdb.h"

namespace espdiff {
namespace {

struct Quantity {
  const char* name;
  double ResidueRow::*member;
  bool of_potential;
};

constexpr Quantity kQuantities[] = {
    {"mean_abs_difference", &ResidueRow::mean_abs_difference, true},
    {"mean_signed_difference", &ResidueRow::mean_signed_difference, true},
    {"mean_source", &ResidueRow::mean_source, true},
    {"mean_target", &ResidueRow::mean_target, true},
    {"sign_change_area_fraction", &ResidueRow::sign_change_area_fraction, true},
    {"mean_displacement_A", &ResidueRow::mean_displacement_A, false},
};

const Quantity& find_quantity(const std::string& name) {
  std::string list;
  for (const Quantity& quantity : kQuantities) {
    if (quantity.name == name) return quantity;
    list += (list.empty() ? "" : ", ") + std::string(quantity.name);
  }
  throw InputError("residues have no quantity '" + name + "'; there are: " + list);
}

}  // namespace

const std::vector<std::string>& residue_quantities() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Quantity& quantity : kQuantities) all.emplace_back(quantity.name);
    return all;
  }();
  return names;
}

std::vector<double> residue_values(const CompareResult& result, const std::string& quantity) {
  const Quantity& q = find_quantity(quantity);
  if (q.of_potential && !result.has_potential)
    throw InputError(quantity + " needs potentials, and shapes alone were compared; take mean_displacement_A");
  std::vector<double> values;
  for (const ResidueRow& row : result.residues) values.push_back(row.*q.member);
  return values;
}

std::string residue_unit(const CompareResult& result, const std::string& quantity) {
  if (quantity == "mean_displacement_A") return "A";
  return quantity == "sign_change_area_fraction" ? "" : to_string(result.unit);
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
