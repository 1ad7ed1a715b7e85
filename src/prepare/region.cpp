// region.cpp: regions by selection and by distance.
#include "prepare/region.h"

#include <algorithm>

#include "align/pair_residues.h"
#include "base/error.h"
#include "io/molecules/select_atoms.h"
#include "prepare/read_earlier_patch.h"

namespace espdiff {
namespace {

bool any(const std::vector<std::uint8_t>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](std::uint8_t flag) { return flag != 0; });
}

/// [residue] nonzero where any atom is selected.
std::vector<std::uint8_t> residues_of(const Molecule& molecule, const std::vector<bool>& selected) {
  std::vector<std::uint8_t> residues(molecule.residues.size(), 0);
  for (std::size_t i = 0; i < selected.size(); ++i) {
    if (selected[i]) residues[static_cast<std::size_t>(molecule.atoms[i].residue)] = 1;
  }
  return residues;
}

}  // namespace

std::vector<std::uint8_t> region_within(const Molecule& molecule, const Molecule& whole,
                                        const std::vector<bool>& near_to, double distance_A) {
  std::vector<Vec3d> centres;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (near_to[i]) centres.push_back(whole.positions[i]);
  }
  std::vector<std::uint8_t> region(molecule.residues.size(), 0);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    std::uint8_t& flag = region[static_cast<std::size_t>(molecule.atoms[i].residue)];
    if (flag != 0) continue;
    const Vec3d& p = molecule.positions[i];
    flag =
        std::any_of(centres.begin(), centres.end(), [&](const Vec3d& c) { return norm(c - p) <= distance_A; }) ? 1 : 0;
  }
  return region;
}

bool has_region_atoms(const Molecule& whole, const InputOptions& options) {
  if (options.region_of.empty()) return false;
  const std::vector<bool> near_to = select_atoms(whole, options.region_of, "of");
  return std::find(near_to.begin(), near_to.end(), true) != near_to.end();
}

std::vector<std::uint8_t> region_residues(const Molecule& source, const Molecule& whole_source, const Molecule& target,
                                          const Molecule& whole_target, const InputOptions& options) {
  if (!options.has_region()) return {};
  if (!options.region.empty()) return residues_of(source, select_some_atoms(source, options.region, "region"));
  std::vector<bool> near_to = select_atoms(whole_source, options.region_of, "of");
  std::vector<std::uint8_t> region;
  if (std::find(near_to.begin(), near_to.end(), true) != near_to.end()) {
    region = region_within(source, whole_source, near_to, options.region_within_A);
  } else {
    near_to = select_atoms(whole_target, options.region_of, "of");
    if (std::find(near_to.begin(), near_to.end(), true) == near_to.end())
      throw InputError(option("of", options.region_of) + " selects no atom; " + whole_source.name + " has " +
                       describe_chains(whole_source) +
                       (&whole_target == &whole_source
                            ? std::string()
                            : "; " + whole_target.name + " has " + describe_chains(whole_target)));
    const auto of_target = region_within(target, whole_target, near_to, options.region_within_A);
    region.assign(source.residues.size(), 0);
    const ResiduePairing pairing = pair_residues(ResidueView(source), ResidueView(target));
    for (const auto& [s, t] : pairing.pairs) region[s] = of_target[t];
  }
  if (!any(region))
    throw InputError(source.name + ": no residue lies within " + option("region-within") + " of " +
                     option("of", options.region_of) + "; take a larger distance");
  return region;
}

std::vector<SurfacePatch> patches_on(const Molecule& source, const std::vector<PatchRequest>& requests,
                                     const std::vector<SurfacePatch>& known) {
  std::vector<SurfacePatch> patches;
  for (const PatchRequest& request : requests) {
    try {
      if (const auto name = earlier_patch_name(request.selection)) {
        patches.push_back(
            {request.name, {}, known.empty() ? read_earlier_patch(*name) : known.at(patches.size()).earlier});
      } else {
        patches.push_back(
            {request.name, residues_of(source, select_some_atoms(source, request.selection, "patch")), {}});
      }
    } catch (const Error& error) {
      throw Error(error.error_class(), "patch " + request.name + ": " + error.message());
    }
  }
  return patches;
}

SurfaceParts source_parts(const Molecule& source, const Molecule& whole_source, const Molecule& target,
                          const Molecule& whole_target, const InputOptions& options,
                          const std::vector<SurfacePatch>& known) {
  return {region_residues(source, whole_source, target, whole_target, options),
          patches_on(source, options.patches, known)};
}

}  // namespace espdiff
