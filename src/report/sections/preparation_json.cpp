// preparation_json.cpp: the lists of a preparation.
#include "report/sections/preparation_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/formatted.h"
#include "prepare/charges/preparation.h"
#include "prepare/load_state.h"
#include "prepare/make_whole.h"

namespace espdiff {
namespace {

void labelled_line(std::ostream& out, const std::string& label, const std::string& text) {
  constexpr std::size_t kHeadingWidth = 16;
  out << label << std::string(label.size() < kHeadingWidth ? kHeadingWidth - label.size() : 1, ' ') << text << '\n';
}

/// The first label stands before the first line only.
void list(std::ostream& out, const std::string& label, const std::vector<std::string>& items) {
  for (std::size_t i = 0; i < items.size(); ++i) labelled_line(out, i == 0 ? label : "", items[i]);
}

}  // namespace

nlohmann::ordered_json preparation_json(const Preparation& p) {
  nlohmann::ordered_json json;
  json["program"] = p.program;
  json["force_field"] = p.force_field;
  json["ph"] = p.ph;
  json["ligands"] = p.ligands;
  json["n_atoms_before"] = p.n_atoms_before;
  json["n_atoms"] = p.n_atoms;
  json["n_hydrogens_added"] = p.n_hydrogens_added;
  json["net_charge"] = p.net_charge;
  json["added"] = p.added;
  json["removed"] = p.removed;
  json["renamed"] = p.renamed;
  json["protonation"] = p.protonation;
  json["groups"] = p.groups;
  json["warnings"] = p.warnings;
  json["notes"] = p.notes;
  if (!p.topology_beside.empty()) json["topology_beside"] = p.topology_beside;
  json["gaps"] = p.gaps;
  json["from_cache"] = p.from_cache;
  json["seconds"] = p.seconds;
  return json;
}

void print_preparation(std::ostream& out, const LoadedState& state) {
  if (state.n_border_bonds > 0) labelled_line(out, "cell", "the molecule " + made_whole_in_words(state.n_border_bonds));
  if (!state.preparation) return;
  const Preparation& p = *state.preparation;
  labelled_line(out, "prepared by",
                p.program + (p.force_field == "none" ? "" : ", force field " + p.force_field) + ", pH " +
                    formatted("%g", p.ph) + (p.propka ? " (PROPKA)" : "") + (p.from_cache ? ", from the cache" : ""));
  labelled_line(out, "atoms",
                std::to_string(p.n_atoms) + " (" + std::to_string(p.n_atoms_before) + " before, " +
                    std::to_string(p.n_hydrogens_added) + " hydrogens added)");
  list(out, "added", p.added);
  list(out, "removed", p.removed);
  list(out, "renamed", p.renamed);
  list(out, "protonation", p.protonation);
  list(out, "beside chains", p.groups);
  list(out, "warning", p.warnings);
  list(out, "note", p.notes);
  if (!p.topology_beside.empty())
    labelled_line(out, "not taken", "the charges of " + p.topology_beside + ", which lists the file's atoms");
  list(out, "missing", p.gaps);
  labelled_line(out, "net charge", formatted("%.4f", std::round(1e4 * p.net_charge) / 1e4 + 0.0) + " e");
}

}  // namespace espdiff
