// template_mapping.h: one surface, the template, mapped onto many frames: the potential of each frame in its vertices.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/types.h"
#include "base/units.h"
#include "mapping/surface_summary.h"

namespace espdiff {

struct CompareInput;
struct CompareOptions;

/// The template's surface, regularized, without closed cavities unless the options keep them.
struct TemplateSurface {
  std::vector<Vec3d> positions;  ///< [vertex] in the template molecule's own frame, Angstrom
  std::vector<Vec3f> normals;    ///< [vertex] unit, outward
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> residue;  ///< [vertex] index of the template's residue, -1 for none
  SurfaceSummary summary;
};

/// A mean of one frame's potential, and what the charges of each residue add to it, kT/e.
struct FrameReading {
  double mean = 0;
  std::vector<double> of_residue;  ///< [residue of the template] its partner's; 0 for none
  double others = 0;               ///< of what has no partner on the template: other residues, water, ions
};

/// One frame, seen from the template.
struct TemplateFrame {
  /// [vertex of the template] potential of the frame where the vertex is mapped to; NaN if the vertex is unmatched or
  /// lies outside the map.
  std::vector<float> potential;
  std::vector<std::uint8_t> trusted;  ///< [vertex of the template] trusted_vertices()
  PotentialUnit unit = PotentialUnit::kUnknown;
  std::vector<std::vector<float>> fields;  ///< [field of the options][vertex of the template] as `potential`
  std::vector<std::string> field_notes;    ///< what does not match, such as residues that a table lacks
  double rmsd_A = 0;                       ///< to the template, of the paired atoms
  double unmatched_template = 0, unmatched_frame = 0;  ///< fractions of the areas, as in a Certificate
  double distance_A = 0;                               ///< mean, from the mapped surface to the frame's
  double same_residue_area_fraction = 0;
  bool trustworthy = false;
  std::string reason;                  ///< the first reason why not
  std::vector<FrameReading> readings;  ///< those of take_apart()
  std::vector<std::pair<std::string, double>> time_ms;
};

/// Maps one surface onto many frames by the morph. The template's surface and its regularization are made once; a frame
/// costs its own surface, potential and mapping. Frames do not depend on each other, nor on their order.
///
/// A frame's certificate has the checks of the mapping (fit, distances, intersections, unmatched areas, slip, residues,
/// what turned) and those of the input; round trip and the residues' own potentials are not checked.
class TemplateMapping {
 public:
  /// @param source the template; its potential, if it has one, is where an iterative potential of a frame starts
  /// @throws InputError (a method other than morph; a list of offsets), and as compare()
  TemplateMapping(Engine& engine, const CompareInput& source, const CompareOptions& options, const Progress& progress);
  ~TemplateMapping();

  const TemplateSurface& surface() const;
  /// Means of each frame that is mapped from now on, whose causes are found as well; see Engine::contributions().
  /// @param weights [reading][vertex of the template] area; a vertex without a value in a frame does not count there
  void take_apart(std::vector<std::vector<double>> weights);
  /// Compares the kind of a frame's given map, vacuum or solvent, with that of the first frame this was called for.
  /// Frames that are mapped from now on are compared with it too.
  /// @param name of the frame, for messages
  /// @throws InputError (another kind, unless the options trust maps), and as compare()
  void check_kind(const CompareInput& frame, const std::string& name, const Progress& progress);
  /// The same by another engine, for another thread; it takes over take_apart() and check_kind().
  /// @throws as the constructor
  std::unique_ptr<TemplateMapping> beside(Engine& engine, const Progress& progress) const;
  /// @param frame has a map
  /// @throws as compare(), Engine::contributions()
  TemplateFrame map(const CompareInput& frame, const Progress& progress);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace espdiff
