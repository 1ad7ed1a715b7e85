// series.h: many targets compared with one source.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "compare/result.h"

namespace espdiff {

struct CompareInput;
struct CompareOptions;

/// What a series hands from one step to the next, all in the source's principal frame. Angstrom.
struct SeriesState {
  std::vector<Vec3f> mapped;  ///< [vertex] the last step's mapped surface
  std::vector<Vec3d> target;  ///< [atom of the source] where the last target's counterpart lay; NaN where there is none

  /// By the morph, whose mesh grows on its way.
  struct Morph {
    std::vector<Vec3f> source;  ///< [vertex] where it comes from
    std::vector<Triangle> triangles;
    std::vector<float> unmatched;    ///< [triangle] nonzero: lost in this step or one before
    std::vector<float> path_length;  ///< [vertex] length of its way so far
    Molecule target;                 ///< the last target
    /// Shares of the source's area without counterpart: on the last target, and where the surface came from the source
    /// last.
    double unmatched_share = 0, unmatched_share_at_start = 0;
  };
  std::optional<Morph> morph;  ///< nothing by the method deform
};

/// Many targets compared with one source, whose surface is made and regularized once, for the first of them, and whose
/// potential is computed once.
class Series {
 public:
  /// Keeps references to all but the options.
  Series(Engine& engine, const CompareInput& source, const CompareOptions& options);
  ~Series();

  /// Compares the source with one target. `start` kPrevious goes on from the last step's mapping; CompareResult::start
  /// says where that was done, and after an error or a cancellation the next step starts from the source.
  ///
  /// By deform, where the last mapping converged and its target lies nearer to this one than the source does (RMSD of
  /// the paired atoms, as superposed). The internal force is measured from the source's shape in both cases.
  ///
  /// By the morph, where the last target lies less than half as far as the source, and the surface has lost at most
  /// 0.5 % of the source's area since it came from there. Its surface then travels on with the atoms from the last
  /// target to this one: the correspondence is composed of small steps. Path lengths add up; edges that were halved
  /// stay halved; what the surface lost on the way stays without counterpart until a step starts from the source again.
  /// What settle() left out beyond that is about one target alone, and not carried on. A surface that starts from the
  /// source again jumps to the counterparts of the direct way.
  /// @throws as compare()
  CompareResult step(const CompareInput& target, StartFrom start, const Progress& progress);

  /// What the next step may start from; nothing when that is the source.
  std::optional<SeriesState> state() const;
  /// Goes on from a state() of an equal series: the next step then gives the same bits as there.
  /// @throws InputError when the state is of another source (told by the numbers of atoms or, at the next step, of
  /// vertices)
  void restore(SeriesState state);

 private:
  struct Steps;
  std::unique_ptr<Steps> steps_;
};

}  // namespace espdiff
