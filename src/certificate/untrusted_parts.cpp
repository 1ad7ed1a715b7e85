// untrusted_parts.cpp: names the parts of a surface that are not trusted, by runs of residues.
#include "certificate/untrusted_parts.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "align/chain_links.h"
#include "base/molecule/residue_label.h"
#include "base/molecule/secondary_structure.h"
#include "base/text/short_numbers.h"
#include "certificate/result.h"
#include "certificate/trusted_area.h"

namespace espdiff {
namespace {

constexpr double kLeastNamedArea_A2 = 10;
constexpr std::size_t kMostNamedParts = 6;
/// So many trusted residues between two that are not belong to the same part.
constexpr std::size_t kMostBetween = 1;

/// [residue] its area on the source by Why.
using AreaByWhy = std::array<double, kNumberOfWhys>;

double untrusted(const AreaByWhy& area) { return std::accumulate(area.begin() + 1, area.end(), 0.0); }

const char* in_words(std::size_t why) {
  switch (static_cast<Why>(why)) {
    case Why::kUnmatched: return "unmatched";
    case Why::kCorrupt: return "not on the target's surface";
    case Why::kUnpaired: return "without a partner";
    case Why::kSlipped: return "slipped off its atoms";
    case Why::kOtherResidue: return "on another residue";
    case Why::kDisagrees: return "its difference is not that of its own surfaces";
    case Why::kNoPotential: return "without a potential";
    case Why::kTurned: return "turned away from its atoms";
    case Why::kTrusted: break;
  }
  return "trusted";
}

struct UntrustedPart {
  std::size_t first = 0, last = 0;
  AreaByWhy area{};
};

std::vector<AreaByWhy> areas_by_residue(const MappedSurface& s, const SurfaceAreas& of_triangles,
                                        std::size_t n_residues) {
  std::vector<AreaByWhy> areas(n_residues, AreaByWhy{});
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const double third = of_triangles.source[t] / 3;
    for (const std::uint32_t c : s.triangles[t]) {
      if (s.residue[c] >= 0) areas[static_cast<std::size_t>(s.residue[c])][s.why[t]] += third;
    }
  }
  return areas;
}

/// Runs of residues of one chain whose surface is not trusted by more than half. A ligand is no part of a run.
std::vector<UntrustedPart> runs_of(const std::vector<AreaByWhy>& areas, const std::vector<ResidueRow>& rows,
                                   const Molecule& source) {
  const ResidueView view(source);
  std::vector<UntrustedPart> parts;
  for (const ResidueRow& row : rows) {
    const AreaByWhy& area = areas[row.residue];
    if (!(untrusted(area) > area[0])) continue;
    const bool goes_on = !parts.empty() && row.residue - parts.back().last <= kMostBetween + 1 &&
                         source.residues[parts.back().last].chain == source.residues[row.residue].chain &&
                         trace_atom(view, parts.back().last) >= 0 && trace_atom(view, row.residue) >= 0;
    if (!goes_on) parts.push_back({row.residue, row.residue, {}});
    parts.back().last = row.residue;
    for (std::size_t k = 0; k < area.size(); ++k) parts.back().area[k] += area[k];
  }
  return parts;
}

/// Helices, strands and loops of the source.
class SecondaryStructure {
 public:
  explicit SecondaryStructure(const Molecule& molecule)
      : backbone_(backbone_of(molecule)), folds_(assign_folds(molecule, backbone_)) {}

  /// "loop", "helix", "strand", or the two that most residues from first to last have: "loop and helix"; empty where
  /// most lack their backbone, so that no fold is known.
  std::string of(std::size_t first, std::size_t last) const {
    std::array<std::pair<std::size_t, const char*>, 3> counts = {{{0, "loop"}, {0, "helix"}, {0, "strand"}}};
    std::size_t known = 0;
    for (std::size_t r = first; r <= last; ++r) {
      if (!backbone_[r].complete()) continue;
      ++known;
      ++counts[static_cast<std::size_t>(folds_[r])].first;
    }
    if (2 * known <= last - first + 1) return "";
    std::stable_sort(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    const bool is_of_two = 4 * counts[1].first >= known;
    return counts[0].second + (is_of_two ? std::string(" and ") + counts[1].second : "");
  }

 private:
  std::vector<Backbone> backbone_;
  std::vector<Fold> folds_;
};

/// "loop GLY 47 to SER 51 of chain A"; "ALA 12 of chain A, in a helix".
std::string residues_in_words(const UntrustedPart& part, const Molecule& source, const SecondaryStructure& structure) {
  const std::string name = residue_label(source.residues[part.last]), fold = structure.of(part.first, part.last);
  if (part.first == part.last) return name + (fold.empty() ? "" : ", in a " + fold);
  Residue first = source.residues[part.first];
  first.chain.clear();
  return (fold.empty() ? "" : fold + " ") + residue_label(first) + " to " + name;
}

std::string named(const UntrustedPart& part, const Molecule& source, const SecondaryStructure& structure) {
  const auto most = std::max_element(part.area.begin() + 1, part.area.end()) - part.area.begin();
  return residues_in_words(part, source, structure) + " (" + short_number(untrusted(part.area)) +
         " A^2): " + in_words(static_cast<std::size_t>(most));
}

}  // namespace

std::vector<std::string> untrusted_parts(const MappedSurface& surface, const SurfaceAreas& areas,
                                         const std::vector<ResidueRow>& rows, const Molecule& source) {
  std::vector<UntrustedPart> parts = runs_of(areas_by_residue(surface, areas, source.residues.size()), rows, source);
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [](const UntrustedPart& part) { return untrusted(part.area) < kLeastNamedArea_A2; }),
              parts.end());
  std::stable_sort(parts.begin(), parts.end(), [](const UntrustedPart& a, const UntrustedPart& b) {
    return untrusted(a.area) > untrusted(b.area);
  });
  std::vector<std::string> names;
  if (parts.empty()) return names;
  const SecondaryStructure structure(source);
  for (std::size_t k = 0; k < std::min(parts.size(), kMostNamedParts); ++k)
    names.push_back(named(parts[k], source, structure));
  if (parts.size() > kMostNamedParts)
    names.push_back("and " + std::to_string(parts.size() - kMostNamedParts) + " smaller parts");
  return names;
}

}  // namespace espdiff
