// mapped_step.h: one mapping of two states, from the atoms' paths to where it can be trusted.
#pragma once

#include <string>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "certificate/result.h"
#include "compare/stages/last_step.h"
#include "engine/morph_stage.h"
#include "mapping/build_surface.h"
#include "mapping/mapping.h"
#include "motions/common_frame.h"

namespace espdiff {

struct CompareOptions;

/// Two states as one is mapped onto the other; all in the common frame.
struct StatesToMap {
  Engine& engine;
  const CompareOptions& options;
  const Molecule& source;
  const Surface& source_surface;
  const MeshPtr& regularized;  ///< the source's surface
  bool has_cavities;           ///< whether `regularized` has closed cavities, which may open
  const Molecule& target;
  const Surface& target_surface;
  const Alignment& alignment;

  float isovalue() const;
};

/// The source's surface, regularized as the method needs it.
struct RegularizedSurface {
  MeshPtr mesh;
  DeformReport report;
};
/// The morph keeps closed cavities, since one may open.
RegularizedSurface regularized_for(Engine& engine, const Surface& surface, const CompareOptions& options,
                                   const Progress& progress);

/// How a mapping begins.
struct MappingStart {
  const LastStep* before = nullptr;  ///< the step to continue from; null for the source
  std::string stage = "morph";       ///< name for progress reports
  double step_factor = 1;            ///< of the morph's largest step
};

/// A certified mapping.
struct MappedStep {
  CommonFrame frame;
  std::vector<MovingAtom> paths;  ///< of all atoms from the source to the target; empty if the method needs none
  MorphResult morphed;            ///< by the morph
  Mapping mapping;
  MappingReport report;          ///< without the start and the source's regularization
  MeshPtr moved;                 ///< the source's surface, moved by its rigid domains
  std::vector<bool> is_matched;  ///< [vertex] whether it lies in a matched triangle
  Certificate certificate;       ///< not judged
  MappedSurface surface;         ///< without normals and potentials
  SurfaceAreas areas;            ///< of that surface
  std::vector<ResidueRow> rows;  ///< [source residue] without potentials
};

/// Maps the source onto the target once, and certifies the mapping: paths, mapping, matched part, certificate,
/// residues, slip, what turned, and where it is trusted.
/// @param kept of why_of_mapping()
MappedStep map_once(const StatesToMap& states, const CommonFrame& frame, const MappingStart& start, KeptTurns kept,
                    const Progress& progress, StageClock& clock);

/// The mapping from the target's surface to the source's, in the same common frame; its matched part is known.
Mapping map_back(const StatesToMap& states, const CommonFrame& frame, const Progress& progress);

/// Sets unmatched vertices to NaN.
/// @param is_matched [vertex]
void set_unmatched_to_nan(const std::vector<bool>& is_matched, std::vector<float>& values);

/// The normals of a mapped surface and of its source, each in its own frame.
struct MappedNormals {
  std::vector<Vec3f> source, target;
};
MappedNormals normals_of(const StatesToMap& states, const MappedStep& step);

}  // namespace espdiff
