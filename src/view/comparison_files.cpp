// comparison_files.cpp: reads what a scene needs of a comparison.
#include "view/comparison_files.h"

#include "base/error.h"

namespace espdiff {
namespace {

bool draws_source_shape(const Scene& scene) { return scene.layout != Layout::kTurned || scene.morph < 1; }

bool draws_maps(const Scene& scene) {
  return !scene.isopotentials.empty() || scene.n_field_lines > 0 || scene.slice.has_value();
}

}  // namespace

bool shows_potentials(const Scene& scene) {
  return scene.layout != Layout::kTurned ||
         (scene.array != RenderArray::kDisplacement && scene.array != RenderArray::kResidue &&
          scene.array != RenderArray::kPlain);
}

ComparisonFiles read_comparison(const std::string& vtp_path, const Scene& scene) {
  ComparisonFiles files;
  files.surface = read_surface_file(vtp_path);
  files.surface.values(scene.array);
  files.record = read_run_record(vtp_path);
  if (draws_source_shape(scene)) {
    if (files.surface.source_positions.empty())
      throw InputError(vtp_path + ": no point array 'source_position'; the source's shape cannot be drawn without it");
    if (!files.record.found) {
      throw InputError(files.record.path +
                       ": no such file; the superposition in it is needed to draw the source's shape beside the "
                       "target's (linked and split layouts, morphs)");
    }
  }
  if (scene.layout != Layout::kTurned) {
    files.surface.values(RenderArray::kSource);
    files.surface.values(RenderArray::kTarget);
  }
  const bool needs_maps = (shows_potentials(scene) && !scene.per_vertex) || draws_maps(scene);
  if (needs_maps) files.maps = read_map_pair(files.record, files.surface);
  if (draws_maps(scene) && !files.maps.complete()) {
    throw InputError("isopotential surfaces, field lines and slices need the maps: " + files.maps.why_not);
  }
  return files;
}

}  // namespace espdiff
