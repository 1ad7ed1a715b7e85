// template_patches.cpp: residues and earlier patches as vertices of a template.
#include "ensemble/result/template_patches.h"

#include <utility>

#include "base/molecule/residue_label.h"
#include "certificate/place_patch.h"
#include "certificate/region_result.h"
#include "compare/template_mapping.h"
#include "ensemble/frames/ensemble_plan.h"
#include "ensemble/result/ensemble_result.h"
#include "options/options.h"
#include "prepare/region.h"

namespace espdiff {

std::vector<FixedPatch> fixed_patches(const CompareOptions& options, const Molecule& molecule) {
  std::vector<FixedPatch> patches;
  for (SurfacePatch& patch : patches_on(molecule, options.input.patches))
    patches.push_back({std::move(patch.name), std::move(patch.residues), std::move(patch.earlier)});
  return patches;
}

Molecule residues_of_template(const EnsemblePlan& plan) {
  Molecule molecule;
  molecule.name = "the template (its residues alone, as CA atoms)";
  for (const std::string& label : plan.residues) {
    Atom atom;
    atom.name = "CA";
    atom.element = "C";
    atom.residue = static_cast<std::int32_t>(molecule.residues.size());
    molecule.atoms.push_back(atom);
    molecule.residues.push_back(parse_residue_label(label));
    molecule.positions.emplace_back();
    molecule.radii.push_back(1);
  }
  return molecule;
}

std::vector<std::uint8_t> vertices_on_template(FixedPatch& patch, const TemplateSurface& surface,
                                               const std::vector<std::string>& residue_labels) {
  if (patch.earlier == nullptr) return vertices_of(surface.residue, patch.residues);
  std::vector<Residue> residues;
  residues.reserve(residue_labels.size());
  for (const std::string& label : residue_labels) residues.push_back(parse_residue_label(label));
  PlacedPatch placed =
      place_patch(*patch.earlier, {surface.positions, surface.triangles, surface.residue, residues}, "the template");
  patch.placement = placed.placement;
  return std::move(placed.inside);
}

}  // namespace espdiff
