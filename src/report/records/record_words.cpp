// record_words.cpp: what a record says, in words.
#include "report/records/record_words.h"

#include <algorithm>
#include <cmath>

#include "align/compared_chains.h"
#include "align/geometry/chain_motions.h"
#include "base/formatted.h"
#include "base/molecule/structure_options.h"
#include "base/not_a_number.h"
#include "report/records/metrics.h"
#include "report/records/record.h"
#include "report/records/text_lines.h"

namespace espdiff {

using Json = Record::Json;

std::string input_in_words(const Record& record, const std::string& side) {
  const std::string name = record.text("/names/" + side);
  for (const Json& json : record.at("/inputs")) {
    const Record input(json);
    if (input.text("/role") == side || input.text("/role") == side + "_file")
      return with_model(name, input.count("/model"));
  }
  return name;
}

std::string paired_in_words(const Record& record) {
  std::string text = counted(record.count("/n_paired_atoms"), "atom") + ", by " + record.text("/superposition/pairing");
  const std::size_t n_substituted = record.count("/superposition/n_substituted_residues");
  if (n_substituted > 0)
    text += " (" + std::to_string(n_substituted) + " of " +
            counted(record.count("/superposition/n_aligned_residues"), "residue") + " substituted)";
  return text;
}

std::vector<std::pair<std::string, std::string>> chains_in_words(const Record& record) {
  std::vector<std::pair<std::string, std::string>> lines;
  std::vector<ComparedChains> compared;
  for (const Json& pair : record.at("/chains/compared")) {
    const Record r(pair);
    compared.push_back({r.text("/source"), r.text("/target"), r.count("/n_residues")});
  }
  const bool one = compared.size() == 1 && compared[0].source == compared[0].target;
  if (!one && !compared.empty()) lines.emplace_back("Chains", in_words(compared));
  std::vector<ChainMotion> motions;
  for (const Json& motion : record.at("/chains/motions")) {
    const Record r(motion);
    ChainMotion& m = motions.emplace_back();
    m.chain = r.text("/source");
    m.rotation_degrees = r.number("/rotation_degrees");
    m.shift_A = r.number("/shift_A");
    m.rmsd_A = r.number("/rmsd_A");
    m.own_rmsd_A = r.number("/own_rmsd_A");
  }
  if (!motions.empty()) lines.emplace_back("Chains moved", in_words(motions));
  for (const std::string side : {"source", "target"}) {
    std::string groups;
    for (const Json& group : record.at("/chains/copies/" + side)) {
      std::string names;
      for (const Json& name : group) names += (names.empty() ? "" : ", ") + Record(name).text("");
      groups += (groups.empty() ? "chains " : "; chains ") + names;
    }
    if (!groups.empty()) lines.emplace_back("Copies, " + side, groups + " repeat one sequence");
  }
  return lines;
}

std::string potential_in_words(const Record& record) {
  const std::string because = record.text("/potential/because");
  return record.text("/potential/label") + (because.empty() ? "" : " (" + because + ")");
}

std::string whole_surface_in_words(const Record& record) {
  const Metric& mean = *find_metric_or_null("mean_abs_difference");
  const std::string place = "/whole_surface/mean_abs_difference/";
  return "about " + formatted(mean, record.number(place + "estimate")) + ", at most " +
         formatted(mean, record.number(place + "at_most")) + " " + record.potential_unit();
}

std::string trusted_in_words(const Record& record) {
  return share_of(record.number("/certificate/trusted_area_fraction/source")) + " of the source's surface and " +
         share_of(record.number("/certificate/trusted_area_fraction/target")) + " of the target's";
}

std::string turned_share_in_words(const Record& record) {
  constexpr double kLeastNamedShare = 0.01;
  const double share = record.number("/certificate/turned_side_chains/of_trusted_area");
  return share >= kLeastNamedShare ? share_of(share) : "";
}

std::string turned_in_words(const Record& record) {
  const std::string share = turned_share_in_words(record);
  if (share.empty()) return "";
  constexpr std::size_t kMostNamed = 3;
  const std::vector<std::string> names = record.texts("/certificate/turned_side_chains/residues");
  std::string named;
  for (std::size_t k = 0; k < std::min(names.size(), kMostNamed); ++k) named += (k > 0 ? ", " : "") + names[k];
  if (names.size() > kMostNamed) named += " and " + std::to_string(names.size() - kMostNamed) + " more";
  const Metric& without = *find_metric_or_null("difference_without_turned");
  const double rest = record.has_potential() ? record.value_of(without) : kNaN;
  return share + " of the trusted area" +
         (std::isfinite(rest) ? " (without it " + formatted(without, rest) + " " + record.potential_unit() + ")" : "") +
         ": the residue is right, but not its face: " + named;
}

std::string unknown_signs(const Record& record) {
  std::string names;
  for (const Json& reading : record.at("/causes")) {
    if (Record(reading).flag("/side_chains/spans_zero"))
      names += (names.empty() ? "" : ", ") + Record(reading).text("/reading");
  }
  return names.empty() ? names
                       : "; the sign of the difference is not known (" + names +
                             "): with side chains in other places its interval spans zero";
}

std::vector<std::string> causes_in_words(const Record& reading) {
  std::vector<std::string> lines;
  for (const char* place : {"/in_words", "/certainty", "/side_chains/in_words", "/scan/in_words"}) {
    if (reading.has(place)) lines.push_back(reading.text(place));
  }
  const auto number = [&](const char* place) { return formatted("%.5g", reading.number(place)); };
  lines.push_back("check: the contributions add up to " + number("/sum_of_contributions/source") + " and " +
                  number("/sum_of_contributions/target") + ", the potentials there are " + number("/source") + " and " +
                  number("/target") + " " + reading.text("/unit"));
  return lines;
}

}  // namespace espdiff
