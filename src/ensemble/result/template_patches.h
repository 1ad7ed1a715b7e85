// template_patches.h: patches that were chosen beforehand, on the surface of a template.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

struct CompareOptions;
struct EnsemblePlan;
struct FixedPatch;
struct TemplateSurface;

/// The residues of each patch on the template. @throws as patches_on()
std::vector<FixedPatch> fixed_patches(const CompareOptions& options, const Molecule& molecule);

/// The template as its file knows it: a CA atom for each residue.
Molecule residues_of_template(const EnsemblePlan& plan);

/// [vertex] nonzero in the patch. The place of an earlier one is found, and noted in the patch.
/// @throws as place_patch()
std::vector<std::uint8_t> vertices_on_template(FixedPatch& patch, const TemplateSurface& surface,
                                               const std::vector<std::string>& residue_labels);

}  // namespace espdiff
