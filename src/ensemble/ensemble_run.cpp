// ensemble_run.cpp: the missing frames, written in their order.
#include "ensemble/ensemble_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/molecule/residue_label.h"
#include "base/not_a_number.h"
#include "compare/template_mapping.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/frames/map_frames.h"
#include "field/field_kinds.h"
#include "io/files/check_outputs.h"
#include "matrix/matrix_run.h"
#include "options/options.h"
#include "statistics/surface/mesh_graph.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Frames of a shard: a contiguous range; sizes differ by at most one.
std::pair<std::size_t, std::size_t> shard_range(std::size_t n, const Shard& shard) {
  const auto count = static_cast<std::size_t>(shard.count), index = static_cast<std::size_t>(shard.index) - 1;
  return {n * index / count, n * (index + 1) / count};
}

void refuse_other_plan(const EnsembleFile& file, const EnsemblePlan& plan) {
  const std::string difference = plan_difference(file.plan(), plan);
  if (!difference.empty())
    throw InputError(file.path() + " is of another run: " + difference + "; " + switched_on("overwrite") +
                     " begins anew");
}

/// Opens the run's file, or makes it.
EnsembleFile open_file(const std::string& path, const EnsemblePlan& plan, const TemplateSurface& surface,
                       const EnsembleRun& run) {
  if (run.resume && run.overwrite)
    throw InputError(option("resume") + " and " + option("overwrite") + " exclude each other; leave one out");
  const bool exists = fs::exists(path);
  if (exists && !run.resume && !run.overwrite) {
    const EnsembleFile readable(path, false);  // what cannot be continued is refused with its own remedy
    throw InputError("the ensemble file " + path + " exists; " + switched_on("resume") + " continues it, " +
                     switched_on("overwrite") + " begins anew");
  }
  if (exists && run.resume) {
    EnsembleFile file(path, true);
    refuse_other_plan(file, plan);
    if (file.n_vertices() != surface.positions.size())
      throw InputError(path + " has a template of " + std::to_string(file.n_vertices()) +
                       " vertices, and this one has " + std::to_string(surface.positions.size()) + "; " +
                       switched_on("overwrite") + " begins anew");
    return file;
  }
  EnsembleFile::create(path, plan, surface);
  return {path, true};
}

double mean_over_area(const std::vector<float>& values, const MeshGraph& graph) {
  double sum = 0, area = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!std::isfinite(values[v])) continue;
    sum += graph.area[v] * static_cast<double>(values[v]);
    area += graph.area[v];
  }
  return sum / area;
}

EnsembleFrame numbers_of(const TemplateFrame& frame, const std::vector<float>& values, const MeshGraph& graph) {
  return {frame.rmsd_A,
          frame.unmatched_template,
          frame.unmatched_frame,
          frame.distance_A,
          frame.same_residue_area_fraction,
          mean_over_area(values, graph),
          frame.trustworthy,
          frame.reason};
}

/// A group in vacuum against one in water is refused before the work: by the first frame of each.
/// @returns the bytes of the largest map
std::size_t check_kinds(TemplateMapping& mapping, const EnsemblePlan& plan, const EnsembleRun& run,
                        const std::function<HeldInput(std::size_t)>& read, const Progress& progress) {
  std::string before;
  std::size_t first = 0, largest = 0;
  for (const EnsembleReplicate& replicate : plan.replicates) {
    if (replicate.group != before && replicate.n_frames > 0) {
      const std::string name = plan.name_of(first);
      try {
        const HeldInput frame = read(first);
        if (frame.input.map != nullptr) largest = std::max(largest, sizeof(float) * frame.input.map->values.size());
        mapping.check_kind(frame.input, name, progress);
      } catch (const InputError& error) {
        // A frame that cannot be read is told when its turn comes.
        if (!run.skip_errors) throw InputError(name + ": " + error.message());
      }
    }
    before = replicate.group;
    first += replicate.n_frames;
  }
  return largest;
}

/// The run's file, then one for each field.
std::vector<EnsembleFile> open_files(const EnsemblePlan& plan, const TemplateSurface& surface,
                                     const CompareOptions& options, const EnsembleRun& run, EnsembleReport& report) {
  report.path = ensemble_path(run.output, run.shard);
  std::vector<EnsembleFile> files;
  files.push_back(open_file(report.path, plan, surface, run));
  for (FieldDescription& field : describe(make_fields(options.fields))) {
    EnsemblePlan of_field = plan;
    of_field.n_fields = options.fields.size();
    of_field.potential = field.quantity.label;
    of_field.potential_unit = field.quantity.unit;
    report.field_paths.push_back(ensemble_path(field_prefix(run.output, field.quantity.name), run.shard));
    of_field.field = std::move(field);
    files.push_back(open_file(report.field_paths.back(), of_field, surface, run));
  }
  return files;
}

void write_frame(std::vector<EnsembleFile>& files, std::size_t f, const TemplateFrame& frame, const MeshGraph& graph) {
  for (std::size_t k = 0; k < files.size(); ++k) {
    const std::vector<float>& values = k == 0 ? frame.potential : frame.fields[k - 1];
    if (!files[k].has(f)) files[k].write(f, values, numbers_of(frame, values, graph), frame.trusted);
  }
}

void add_times(std::vector<std::pair<std::string, double>>& sums,
               const std::vector<std::pair<std::string, double>>& times) {
  for (const auto& [stage, ms] : times) {
    const std::string name = stage;
    const auto known = std::find_if(sums.begin(), sums.end(), [&](const auto& entry) { return entry.first == name; });
    if (known == sums.end()) {
      sums.emplace_back(stage, ms);
    } else {
      known->second += ms;
    }
  }
}

}  // namespace

std::string ensemble_path(const std::string& prefix, const Shard& shard) { return part_path(prefix, shard, ".h5"); }

EnsembleReport run_ensemble(Engine& engine, EnsemblePlan plan, const CompareInput& source,
                            const CompareOptions& options, const EnsembleRun& run,
                            const std::function<HeldInput(std::size_t)>& read, const Progress& progress) {
  for (const Residue& residue : source.molecule->residues) plan.residues.push_back(residue_label(residue));
  TemplateMapping mapping(engine, source, options, progress);
  const MeshGraph graph = make_mesh_graph(mapping.surface().positions, mapping.surface().triangles);
  const std::size_t bytes_of_map = plan.potential == "maps" ? check_kinds(mapping, plan, run, read, progress) : 0;
  EnsembleReport report;
  std::vector<EnsembleFile> all = open_files(plan, mapping.surface(), options, run, report);
  const auto [begin, end] = shard_range(plan.n_frames(), run.shard);
  std::vector<std::size_t> missing;
  for (std::size_t f = begin; f < end; ++f) {
    const bool is_there = std::all_of(all.begin(), all.end(), [f](const EnsembleFile& file) { return file.has(f); });
    if (!is_there) missing.push_back(f);
  }
  report.n_frames = end - begin;
  report.n_resumed = report.n_frames - missing.size();
  for (const EnsembleFile& file : all) report.n_damaged += file.n_damaged();
  const std::string what = plan.matrix == nullptr ? "frame" : "state";
  const Clock::time_point start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::size_t n_done = 0;
  const auto name_of = [&](std::size_t i) { return plan.name_of(missing[i]); };
  const Progress inner([&](const std::string& stage, double) {
    if (n_done == missing.size()) return;
    std::string text =
        what + " " + std::to_string(report.n_resumed + n_done + 1) + " of " + std::to_string(report.n_frames);
    if (n_done > 0)
      text += ", " + in_words(seconds() / static_cast<double>(n_done) * static_cast<double>(missing.size() - n_done)) +
              " left";
    const double share = static_cast<double>(report.n_resumed + n_done) / static_cast<double>(report.n_frames);
    progress.report(text + "; " + name_of(n_done) + ": " + (stage.empty() ? "read" : stage), share);
  });
  const auto done = [&](std::size_t i, const TemplateFrame& frame) {
    write_frame(all, missing[i], frame, graph);
    if (i == 0) report.notes = frame.field_notes;
    add_times(report.time_ms, frame.time_ms);
    ++n_done;
  };
  const auto failed = [&](std::size_t i, const Error& error) {
    if (!run.skip_errors || error.error_class() == ErrorClass::kIo)
      throw Error(error.error_class(), name_of(i) + ": " + error.message());
    for (EnsembleFile& file : all) {
      if (file.has(missing[i])) continue;
      file.write(missing[i], std::vector<float>(file.n_vertices(), std::numeric_limits<float>::quiet_NaN()),
                 {kNaN, 1, 1, kNaN, kNaN, kNaN, false, error.what()});
    }
    ++report.n_skipped;
    ++n_done;
  };
  try {
    inner.report("read", 0.0);
    map_frames({engine, mapping, missing.size(), source.molecule->size(), bytes_of_map,
                [&](std::size_t i) { return read(missing[i]); }},
               done, failed, inner);
  } catch (const Cancelled&) {
    throw Error(ErrorClass::kCancelled, "cancelled after " + std::to_string(report.n_resumed + n_done) + " of " +
                                            std::to_string(report.n_frames) + " " + what + "s, which " + report.path +
                                            " holds; " + switched_on("resume") + " continues");
  } catch (const Error&) {
    for (const EnsembleFile& file : all) {
      if (file.n_done() == 0) fs::remove(file.path());  // nothing is lost
    }
    throw;
  }
  for (EnsembleFile& file : all) file.finish();
  report.seconds = seconds();
  return report;
}

EnsembleReport merge_ensemble(const std::vector<std::string>& paths, const EnsembleRun& run) {
  EnsembleReport report;
  report.path = ensemble_path(run.output, {});
  check_outputs(paths, {report.path});
  if (fs::exists(report.path) && !run.overwrite)
    throw InputError("the ensemble file " + report.path + " exists; " + switched_on("overwrite") + " replaces it");
  std::vector<EnsembleFile> parts;
  for (const std::string& path : paths) {
    parts.emplace_back(path, false);
    const std::string difference = plan_difference(parts.back().plan(), parts.front().plan());
    if (!difference.empty())
      throw InputError(path + ": this is a part of another ensemble than " + paths.front() + ": " + difference);
  }
  const EnsemblePlan& plan = parts.front().plan();
  std::vector<const EnsembleFile*> holder(plan.n_frames(), nullptr);
  for (std::size_t f = 0; f < holder.size(); ++f) {
    for (const EnsembleFile& part : parts) {
      if (part.has(f)) holder[f] = &part;
    }
    if (holder[f] == nullptr)
      throw InputError("none of the files has frame " + std::to_string(f) + " (" + plan.name_of(f) +
                       "); resume the shard that lacks it, or name its file too");
  }
  EnsembleFile::create(report.path, plan, parts.front().surface(), [&](EnsembleFile& merged) {
    for (std::size_t f = 0; f < holder.size(); ++f) merged.copy(f, *holder[f]);
  });
  report.n_frames = report.n_resumed = holder.size();
  return report;
}

}  // namespace espdiff
