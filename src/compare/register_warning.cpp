// register_warning.cpp: finds pairs of residues that are shifted along the chain.
#include <map>

#include "align/pair_residues.h"
#include "base/residue_label.h"
#include "compare/input_warnings.h"
#include "compare/nearest_point.h"
#include "compare/paired_residues.h"
#include "compare/short_numbers.h"

namespace espdiff {
namespace {

/// A residue lies on another one if their C-alpha or P atoms are nearer than this: half the distance of neighbours.
constexpr double kSamePlace_A = 1.9;
/// A chance arrangement puts a few percent of the residues on others at any one shift.
constexpr double kMostShifted = 0.2;

struct Trace {
  std::vector<std::size_t> residues;
  std::vector<Vec3d> places;

  explicit Trace(const ResidueView& view) {
    for (std::size_t r = 0; r < view.kinds.size(); ++r) {
      if (view.kinds[r] != ResidueKind::kAminoAcid && view.kinds[r] != ResidueKind::kNucleotide) continue;
      for (const std::size_t i : view.atoms[r]) {
        const std::string& name = view.molecule->atoms[i].name;
        if (name != "CA" && name != "P") continue;
        residues.push_back(r);
        places.push_back(view.molecule->positions[i]);
        break;
      }
    }
  }
};

}  // namespace

void check_register(const ResidueView& source, const ResidueView& target, const CompareResult& result,
                    std::vector<Warning>& warnings) {
  const std::vector<std::int32_t> partner = paired_residues(*source.molecule, *target.molecule, result.pairing);
  const Trace from(source), to(target);
  if (to.places.empty()) return;
  const NearestPoint nearest(to.places);
  std::map<std::ptrdiff_t, std::size_t> votes;
  std::size_t n = 0;
  for (std::size_t k = 0; k < from.residues.size(); ++k) {
    const std::int32_t own = partner[from.residues[k]];
    if (own < 0) continue;
    ++n;
    const Vec3d p = result.source_to_target.apply(from.places[k]);
    const std::size_t there = nearest(p), residue = to.residues[there];
    if (static_cast<std::int32_t>(residue) == own || norm(to.places[there] - p) > kSamePlace_A) continue;
    if (target.molecule->residues[residue].chain != target.molecule->residues[static_cast<std::size_t>(own)].chain)
      continue;
    ++votes[static_cast<std::ptrdiff_t>(residue) - own];
  }
  std::ptrdiff_t shift = 0;
  std::size_t most = 0;
  for (const auto& [offset, count] : votes) {
    if (count <= most) continue;
    most = count;
    shift = offset;
  }
  if (n == 0 || static_cast<double>(most) <= kMostShifted * static_cast<double>(n)) return;
  const auto size = static_cast<std::size_t>(shift < 0 ? -shift : shift);
  warnings.push_back({std::to_string(most) + " of " + std::to_string(n) + " residues lie on the residue " +
                          std::to_string(size) + (shift > 0 ? " after" : " before") +
                          " their partner in the chain: the alignment or the numbering is shifted",
                      true});
}

}  // namespace espdiff
