// state_report.cpp: preparations in words.
#include "report/state_report.h"

#include <algorithm>
#include <sstream>

#include "base/formatted.h"
#include "certificate/result.h"
#include "io/files/sha256.h"
#include "io/molecules/write_pqr.h"
#include "prepare/load_state.h"
#include "prepare/make_whole.h"
#include "report/sections/provenance.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

std::string joined(const std::vector<std::string>& items, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < items.size() && i < most; ++i) text += (text.empty() ? "" : "; ") + items[i];
  return items.size() > most ? text + "; and " + std::to_string(items.size() - most) + " more" : text;
}

void note_state(CompareResult& result, const std::string& role, const StateOrigin& state) {
  if (state.n_border_bonds > 0)
    result.inputs.warnings.push_back({"the " + role + " " + made_whole_in_words(state.n_border_bonds)});
  const std::string label = "Charges, " + role;
  for (const ChargeFile& file : state.charge_files) {
    if (file.use != "ligand") result.inputs.lines.emplace_back(label, "of " + file.path);
  }
  if (!state.preparation) return;
  const Preparation& p = *state.preparation;
  std::string text = p.program + (p.force_field == "none" ? "" : ", " + p.force_field) + ", pH " +
                     formatted("%g", p.ph) + ": " + std::to_string(p.n_hydrogens_added) + " hydrogens added";
  if (!p.added.empty())
    text += ", " + std::to_string(p.added.size()) + (p.added.size() == 1 ? " residue" : " residues") + " repaired";
  result.inputs.lines.emplace_back(label, text);
  constexpr std::size_t kMostGroups = 8;
  for (std::size_t i = 0; i < std::min(p.groups.size(), kMostGroups); ++i)
    result.inputs.lines.emplace_back(i == 0 ? "Beside the chains, " + role : "", p.groups[i]);
  if (p.groups.size() > kMostGroups)
    result.inputs.lines.emplace_back("", "and " + std::to_string(p.groups.size() - kMostGroups) + " more");
  for (std::size_t i = 0; i < p.notes.size(); ++i)
    result.inputs.lines.emplace_back(i == 0 ? "Notes, " + role : "", p.notes[i]);
  for (const std::string& warning : p.warnings) result.inputs.warnings.push_back({"of the " + role + ", " + warning});
  if (!p.topology_beside.empty())
    result.inputs.warnings.push_back({"charges of the " + role + ": " + option(role + "-topology", p.topology_beside) +
                                      " takes those of the file beside it instead of PDB2PQR's"});
  if (!p.gaps.empty())
    result.inputs.warnings.push_back({"the " + role + " lacks residues " + joined(p.gaps, 4) +
                                      "; they are not modelled, and chain ends there stay uncharged"});
}

}  // namespace

std::vector<InputFile> state_inputs(const std::string& role, const InputFile& file, const LoadedState& state) {
  std::vector<InputFile> inputs{file};
  for (const ChargeFile& charges : state.charge_files)
    inputs.push_back({role + "_" + charges.use, charges.path,
                      charges.sha256.empty() ? sha256_of_file(charges.path) : charges.sha256});
  return inputs;
}

std::vector<KeptFile> kept_structure(const std::string& role, const LoadedState& state) {
  if (!state.is_changed) return {};
  std::ostringstream content;
  write_pqr(content, state.molecule);
  return {{role, "." + role + ".pqr", content.str()}};
}

void note_states(CompareResult& result, const StateOrigin& source, const StateOrigin& target,
                 const std::string& radii_note) {
  note_state(result, "source", source);
  note_state(result, "target", target);
  if (!radii_note.empty()) result.inputs.lines.emplace_back("Radii", radii_note);
  double ms = 0;
  for (const StateOrigin* state : {&source, &target}) {
    if (state->preparation) ms += 1000 * state->preparation->seconds;
  }
  if (ms == 0) return;
  result.time_ms.insert(result.time_ms.begin(), {"prepare", ms});
  for (auto& [stage, time] : result.time_ms) {
    if (stage == "total") time += ms;
  }
}

}  // namespace espdiff
