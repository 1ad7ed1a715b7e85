// series.h: compares many targets with one source.
#pragma once

#include <memory>
#include <optional>

#include "base/handles.h"
#include "base/progress.h"
#include "compare/stages/series_state.h"
#include "mapping/start_from.h"

namespace espdiff {

struct CompareInput;
struct CompareOptions;
struct CompareResult;

/// Compares many targets with one source. The source's surface is built and regularized once, for the first target, and
/// its potential is computed once.
class Series {
 public:
  /// Keeps references to all arguments but the options.
  Series(Engine& engine, const CompareInput& source, const CompareOptions& options);
  ~Series();

  /// Compares the source with one target. With kPrevious the mapping continues from the last step's where that is
  /// possible; MappingReport::start reports it. After an error or a cancellation the next step starts from the source.
  ///
  /// By deform, it continues if the last mapping converged and its target is closer to this one than the source is
  /// (RMSD of the paired atoms, as superposed). The internal force is measured from the source's shape in both cases.
  ///
  /// By the morph, it continues if the last target is less than half as far as the source, and the surface has lost at
  /// most 0.5 % of the source's area since it left the source. The surface then moves with the atoms from the last
  /// target to this one, so the correspondence is composed of small steps. Path lengths add up, split edges stay split,
  /// and lost surface stays unmatched until a step starts from the source again. Triangles that find_matched_part()
  /// removed beyond that concern one target only and are not inherited. A surface that starts from the source again
  /// takes the correspondence of the direct mapping, which may jump. Only steps that start from the source are mapped
  /// twice where they slip (`--domains as-needed`; see choose_motions.h).
  /// @throws as compare()
  CompareResult step(const CompareInput& target, StartFrom start, const Progress& progress);

  /// A last step from the source. Surfaces and potentials are freed as soon as nothing asks for them; no other step can
  /// follow.
  CompareResult finish(const CompareInput& target, const Progress& progress);

  /// State for continuing with the next step; empty if that starts from the source.
  std::optional<SeriesState> state() const;
  /// Continues from a state() of an equal series: the next step gives the same bits as there.
  /// @throws InputError if the state is of another source (detected by the number of atoms or, at the next step, of
  /// vertices)
  void restore(SeriesState state);

 private:
  struct Steps;
  std::unique_ptr<Steps> steps_;
};

}  // namespace espdiff
