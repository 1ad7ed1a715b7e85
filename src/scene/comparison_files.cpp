// comparison_files.cpp: reads the files of a comparison that a scene needs.
#include "scene/comparison_files.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "io/files/read_csv.h"
#include "io/structures/structure_file.h"

namespace espdiff {
namespace {

bool draws_source_shape(const Scene& scene) { return scene.layout != Layout::kTurned || scene.morph < 1; }

bool reads_maps(const Scene& scene) {
  return !scene.isopotentials.empty() || scene.n_field_lines > 0 || scene.slice.has_value() || !scene.offsets_A.empty();
}

bool draws_molecules(const Scene& scene) {
  return scene.molecule != MoleculeStyle::kNone || scene.around_A > 0 || scene.n_labels > 0 || !scene.causes.empty() ||
         !scene.focus.empty();
}

Molecule read_molecule(const RunRecord& record, const RecordedInput& input, bool with_water) {
  return read_compared(record, input, with_water, "; compare again, or draw without the molecule and labels");
}

/// A file may hold several models, and older records do not say which was compared, so the surface must fit the model
/// read.
void check_model(const SurfaceFile& surface, const Molecule& source, const std::string& path) {
  if (surface.source_positions.empty() || surface.residue_index.empty()) return;
  constexpr std::size_t kStride = 23;
  constexpr double kFar_A = 10;
  std::size_t n = 0, n_far = 0;
  for (std::size_t v = 0; v < surface.source_positions.size(); v += kStride) {
    const auto residue = static_cast<std::int32_t>(surface.residue_index[v]);
    if (residue < 0) continue;
    double nearest = 1e9;
    for (std::size_t a = 0; a < source.atoms.size(); ++a) {
      if (source.atoms[a].residue == residue)
        nearest = std::min(nearest, norm(source.positions[a] - surface.source_positions[v]));
    }
    ++n;
    n_far += nearest > kFar_A ? 1 : 0;
  }
  if (10 * n_far > n) {
    throw InputError(path + ": its model is not the one that was compared; draw without the molecule and labels");
  }
}

void read_molecules(ComparisonFiles& files, const Scene& scene) {
  const RunRecord& record = files.record;
  const auto superposed = [&](Molecule molecule) {
    for (Vec3d& p : molecule.positions) p = record.source_to_target.apply(p);
    return molecule;
  };
  if (!files.source_molecule || !files.target_molecule) {
    const Molecule source = read_molecule(record, record.source, false);
    check_model(files.surface, source, record.source.path);
    files.target_molecule = read_molecule(record, record.target, false);
    files.source_molecule = superposed(source);
  }
  if (scene.around_A > 0 && !files.source_surroundings) {
    files.target_surroundings = read_molecule(record, record.target, true);
    files.source_surroundings = superposed(read_molecule(record, record.source, true));
  }
}

std::string causes_path(const std::string& vtp_path) {
  return std::filesystem::path(vtp_path).replace_extension(".causes.csv").string();
}

/// @throws IoError, FormatError; InputError that lists the readings of the file
ReadingCauses read_causes(const std::string& path, const std::string& reading) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw InputError(path + ": no such file; compare with " + option("causes", reading) + " first");
  const CsvTable table = read_csv(path);
  ReadingCauses causes{reading, {}, {}, {}};
  const std::string word = "difference [";
  const auto is_difference = [&](const std::string& column) { return column.rfind(word, 0) == 0; };
  const auto difference = std::find_if(table.columns.begin(), table.columns.end(), is_difference);
  if (difference == table.columns.end()) throw FormatError(path, 1, "it has no column of differences; compare again");
  causes.unit = difference->substr(word.size(), difference->size() - word.size() - 1);
  const auto value = static_cast<std::size_t>(difference - table.columns.begin());
  const std::size_t name = table.require("reading"), chain = table.require("chain"),
                    number = table.require("residue_number"), insertion = table.require("insertion_code"),
                    residue = table.require("residue_name");
  std::string all;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::vector<std::string>& cells = table.rows[row];
    if (row == 0 || cells[name] != table.rows[row - 1][name]) all += (row == 0 ? "" : ", ") + cells[name];
    if (cells[name] != reading || cells[number].empty()) continue;
    causes.residues.push_back({cells[residue], cells[chain], static_cast<std::int32_t>(table.number(row, number)),
                               cells[insertion].empty() ? ' ' : cells[insertion].front()});
    causes.differences.push_back(table.number(row, value));
  }
  if (causes.residues.empty()) throw InputError(path + ": has no reading '" + reading + "'; it has " + all);
  return causes;
}

}  // namespace

std::vector<int> focused_residues(const RunRecord& record, const Scene& scene) {
  if (scene.focus.empty()) return {};
  const std::string patch = "patch ";
  for (const std::string& name : {scene.focus, patch + scene.focus}) {
    const auto found = record.parts.find(name);
    if (found != record.parts.end() && !found->second.empty()) return found->second;
  }
  std::string names;
  for (const auto& [part, residues] : record.parts) {
    const std::string name = part.rfind(patch, 0) == 0 ? part.substr(patch.size()) : part;
    names += (names.empty() ? "" : ", ") + name;
  }
  throw InputError(option("focus", scene.focus) + " is no part of the result, which has " +
                   (names.empty() ? "none; compare with " + option("region", "SELECTION") : names));
}

std::vector<int> outlined_residues(const RunRecord& record, const Scene& scene) {
  if (!scene.focus.empty()) return focused_residues(record, scene);
  const auto found = record.parts.find("region");
  return found == record.parts.end() ? std::vector<int>() : found->second;
}

std::vector<std::string> files_of(const ComparisonFiles& files) {
  const RunRecord& r = files.record;
  return {files.surface.path,
          r.path,
          r.source.path,
          r.target.path,
          r.source_map.path,
          r.target_map.path,
          causes_path(files.surface.path)};
}

bool shows_potentials(const Scene& scene) {
  return scene.layout != Layout::kTurned ||
         (scene.array != RenderArray::kDisplacement && scene.array != RenderArray::kResidue &&
          scene.array != RenderArray::kPlain && scene.array != RenderArray::kSlip && scene.array != RenderArray::kWhy);
}

ComparisonFiles read_comparison(const std::string& vtp_path, const Scene& scene) {
  ComparisonFiles files;
  files.surface = read_surface_file(vtp_path, scene.field);
  files.surface.values(scene.array);
  files.record = read_run_record(vtp_path);
  const bool needs_maps =
      (shows_potentials(scene) && !scene.per_vertex && files.surface.field.empty()) || reads_maps(scene);
  if (needs_maps) files.maps = read_map_pair(files.record, files.surface);
  read_missing_files(files, scene);
  return files;
}

void read_missing_files(ComparisonFiles& files, const Scene& scene) {
  const SurfaceFile& surface = files.surface;
  surface.values(scene.array);
  if (draws_source_shape(scene)) {
    if (surface.source_positions.empty()) {
      throw InputError(surface.path +
                       ": no point array 'source_position'; the source's shape cannot be drawn without it");
    }
    if (!files.record.found) {
      throw InputError(files.record.path +
                       ": no such file; the superposition in it is needed to draw the source's shape beside the "
                       "target's (linked and split layouts, morphs)");
    }
  }
  if (scene.layout != Layout::kTurned) {
    surface.values(RenderArray::kSource);
    surface.values(RenderArray::kTarget);
  }
  if (reads_maps(scene) && !files.maps.complete()) {
    throw InputError("isopotential and offset surfaces, field lines and slices need the maps: " + files.maps.why_not);
  }
  focused_residues(files.record, scene);
  if (draws_molecules(scene)) read_molecules(files, scene);
  if (scene.causes.empty()) {
    files.causes.reset();
  } else if (!files.causes || files.causes->reading != scene.causes) {
    files.causes = read_causes(causes_path(surface.path), scene.causes);
  }
}

}  // namespace espdiff
