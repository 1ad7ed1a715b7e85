// page_molecule.cpp: the backbones of both structures, which the page draws as ribbons.
#include "page/page_molecule.h"

#include <vector>

#include "base/error.h"
#include "io/structures/run_record.h"
#include "page/page_surface.h"

namespace espdiff {
namespace {

// Neighbours in a chain: C-alphas are 3.8 A apart, phosphorus atoms up to 7.5 A.
constexpr double kLongestStep_A = 4.5, kLongestNucleicStep_A = 9;

/// The atoms of a residue that matter here; -1 where there is none.
struct BackboneAtoms {
  int trace = -1, carbon = -1, oxygen = -1;
  bool is_nucleic = false;
};

std::vector<BackboneAtoms> backbone_atoms(const Molecule& molecule) {
  std::vector<BackboneAtoms> all(molecule.residues.size());
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Atom& atom = molecule.atoms[i];
    BackboneAtoms& residue = all[static_cast<std::size_t>(atom.residue)];
    const auto index = static_cast<int>(i);
    if (atom.name == "CA" && atom.element != "Ca") residue.trace = index;
    if (atom.name == "P" && residue.trace < 0) {
      residue.trace = index;
      residue.is_nucleic = true;
    }
    if (atom.name == "C") residue.carbon = index;
    if (atom.name == "O") residue.oxygen = index;
  }
  return all;
}

nlohmann::ordered_json backbone_of(PageArrays& arrays, const Molecule& molecule, const RigidTransform& to_target) {
  std::vector<std::size_t> chains;
  std::vector<Vec3d> points, sides;
  const std::vector<BackboneAtoms> residues = backbone_atoms(molecule);
  std::size_t before = residues.size();
  for (std::size_t r = 0; r < residues.size(); ++r) {
    const BackboneAtoms& atoms = residues[r];
    if (atoms.trace < 0) continue;
    const Vec3d point = to_target.apply(molecule.positions[static_cast<std::size_t>(atoms.trace)]);
    const double longest = atoms.is_nucleic ? kLongestNucleicStep_A : kLongestStep_A;
    const bool continues = before < residues.size() && molecule.residues[before].chain == molecule.residues[r].chain &&
                           norm(point - points.back()) < longest;
    if (continues)
      ++chains.back();
    else
      chains.push_back(1);
    Vec3d side{};
    if (atoms.carbon >= 0 && atoms.oxygen >= 0) {
      const Vec3d bond = to_target.apply(molecule.positions[static_cast<std::size_t>(atoms.oxygen)]) -
                         to_target.apply(molecule.positions[static_cast<std::size_t>(atoms.carbon)]);
      side = (1 / norm(bond)) * bond;
    }
    points.push_back(point);
    sides.push_back(side);
    before = r;
  }
  return {
      {"chains", chains}, {"points", add_page_positions(arrays, points)}, {"sides", add_page_positions(arrays, sides)}};
}

}  // namespace

void add_backbones(nlohmann::ordered_json& page, PageArrays& arrays, const std::string& prefix) {
  const RunRecord record = read_run_record(prefix + ".vtp");
  try {
    const Molecule source = read_compared(record, record.source, false, ""),
                   target = read_compared(record, record.target, false, "");
    page["backbone"] = {{"source", backbone_of(arrays, source, record.source_to_target)},
                        {"target", backbone_of(arrays, target, RigidTransform())}};
    if (page["backbone"]["target"]["chains"].empty()) {
      page.erase("backbone");
      page["molecule_because"] = "no molecule: the structures have no C-alpha atoms";
    }
  } catch (const Error& error) {
    page["molecule_because"] = std::string("no molecule: ") + error.what();
  }
}

}  // namespace espdiff
