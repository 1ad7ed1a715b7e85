// scene.h: all parameters of a picture except the files; the content of a scene file (JSON).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text/option_row.h"
#include "base/vector.h"
#include "scene/colour_scale.h"

namespace espdiff {

/// turned: the same surface from several sides. linked: source, target and difference with one camera. split: the
/// source left and the target right of a line.
enum class Layout { kTurned, kLinked, kSplit };

enum class MoleculeStyle { kNone, kCartoon, kSticks, kLines };

/// The camera, in the target's frame; Angstrom.
struct CameraView {
  Vec3d centre{}, toward_viewer{0, 0, 1}, up{0, 1, 0};
  double half_height_A = 0;  ///< half the height shown
};

struct Scene {
  RenderArray array = RenderArray::kDifference;
  std::string field;  ///< drawn in the place of the potential; empty for the potential
  ScaleRange range;
  /// > 0: end of the scale of both potentials in the layout `linked`; 0: automatic, over both
  double potential_limit = 0;
  std::string colours = "red-blue";  ///< or cool-warm, purple-orange
  std::string unit;                  ///< of the potential; the file's when empty
  bool per_vertex = false;           ///< interpolate the vertices' values instead of looking up the maps
  bool fade = true;                  ///< fainter where the slip is larger
  OpacityScale opacity;

  Layout layout = Layout::kTurned;
  int width = 1800;   ///< pixels, 400 to 6000
  int height = 1100;  ///< pixels, 400 to 6000
  int n_views = 2;    ///< of the layout `turned`, each rotated about the vertical by a full turn / n_views; 1 to 4
  std::string title;  ///< above the views; empty for none
  bool legend = true;
  bool axes = false;   ///< directions of the target's x, y and z in each view
  double morph = 1;    ///< 0 draws the surface on the source, 1 on the target
  double split = 0.5;  ///< position of the dividing line of the layout `split`, as a fraction of the width

  std::optional<CameraView> camera;   ///< automatic when empty
  double turn_deg = 0, tilt_deg = 0;  ///< rotation from there: to the right, upward
  double zoom = 1;

  bool surface = true;
  MoleculeStyle molecule = MoleculeStyle::kNone;
  double around_A = 0;  ///< ligands, ions and water within this distance of the protein; 0: none
  /// A reading of the comparison's causes: the source's molecule is coloured by contribution, the reading's patch
  /// outlined, the largest labelled; empty: none. Its surface is translucent unless an opacity is given.
  std::string causes;
  std::string focus;                  ///< the region or fixed patch that the camera looks at; empty for none
  int n_labels = 0;                   ///< number of labelled residues, those with the largest mean |difference|
  std::vector<double> isopotentials;  ///< surfaces of equal potential, of the target's map
  std::vector<double> offsets_A;      ///< offset surfaces, at these distances outside the molecular surface
  int n_field_lines = 0;
  std::optional<double> slice;  ///< plane through the target's map across the view: 0 front, 1 back
};

/// All settings of a scene that are options of `render` and `view`; each is one row, and an entry of scene files too.
const std::vector<OptionRow<Scene>>& scene_options();

/// A scene as JSON, including the defaults.
std::string scene_json(const Scene& scene);

/// Reads a scene file; missing entries are taken from `defaults`.
/// @throws IoError, FormatError (not JSON, an unknown key, a value of the wrong type)
Scene read_scene(const std::string& path, const Scene& defaults);

/// @throws InputError for values out of range, with the limits
void check(const Scene& scene);

}  // namespace espdiff
