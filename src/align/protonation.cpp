// protonation.cpp: hydrogens by name, and disulfides by distance.
#include "align/protonation.h"

#include <algorithm>
#include <string_view>

#include "align/residue_names.h"

namespace espdiff {
namespace {

/// Normalized names of a residue's atoms.
struct Names {
  std::vector<std::string> all{};

  std::size_t count(std::string_view name) const {
    return std::find(all.begin(), all.end(), name) != all.end() ? 1 : 0;
  }
};

/// [residue]
std::vector<Names> names_of_residues(const Molecule& molecule) {
  std::vector<Names> names(molecule.residues.size());
  for (const Atom& atom : molecule.atoms)
    names[static_cast<std::size_t>(atom.residue)].all.push_back(normalized_atom_name(atom.name));
  return names;
}

bool has_hydrogens(const Names& names) {
  return std::any_of(names.all.begin(), names.all.end(), [](const std::string& name) { return name[0] == 'H'; });
}

/// [residue] whether its SG is bonded to another one.
std::vector<bool> disulfides(const Molecule& molecule) {
  constexpr double kLongest_A = 2.5;
  std::vector<std::size_t> sulfurs;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (molecule.atoms[i].name == "SG") sulfurs.push_back(i);
  }
  std::vector<bool> bonded(molecule.residues.size(), false);
  for (const std::size_t i : sulfurs) {
    for (const std::size_t j : sulfurs) {
      if (i != j && norm(molecule.positions[i] - molecule.positions[j]) < kLongest_A)
        bonded[static_cast<std::size_t>(molecule.atoms[i].residue)] = true;
    }
  }
  return bonded;
}

std::string state_of(char letter, const Names& has, bool bonded) {
  const auto n_of = [&](std::initializer_list<const char*> names) {
    return std::count_if(names.begin(), names.end(), [&](const char* name) { return has.count(name) > 0; });
  };
  switch (letter) {
    case 'D': return n_of({"HD1", "HD2"}) > 0 ? "ASH" : "ASP";
    case 'E': return n_of({"HE1", "HE2"}) > 0 ? "GLH" : "GLU";
    case 'H': return n_of({"HD1", "HE2"}) == 2 ? "HIP" : has.count("HD1") > 0 ? "HID" : "HIE";
    case 'K': return n_of({"HZ1", "HZ2", "HZ3"}) == 2 ? "LYN" : "LYS";
    case 'Y': return n_of({"HH"}) > 0 ? "TYR" : "TYM";
    case 'C': return n_of({"HG", "HG1"}) > 0 ? "CYS" : bonded ? "CYX" : "CYM";
    case 'R': return n_of({"HE", "HH11", "HH12", "HH21", "HH22"}) == 4 ? "AR0" : "ARG";
    default: return {};
  }
}

/// Which charged end of a chain the residue is.
std::string end_of_chain(const Names& has) {
  if (has.count("OXT") > 0) return "C-terminus";
  return has.count("H2") > 0 && (has.count("H3") > 0 || has.count("H1") > 0) ? "N-terminus" : "within the chain";
}

std::vector<std::string> states_of(const Molecule& molecule, const std::vector<Names>& names) {
  const std::vector<bool> bonded = disulfides(molecule);
  std::vector<std::string> states;
  for (std::size_t r = 0; r < names.size(); ++r) {
    const char letter = names[r].count("CA") > 0 ? residue_letter(molecule.residues[r].name) : '?';
    states.push_back(has_hydrogens(names[r]) ? state_of(letter, names[r], bonded[r]) : std::string());
  }
  return states;
}

}  // namespace

std::vector<std::string> protonation_states(const Molecule& molecule) {
  return states_of(molecule, names_of_residues(molecule));
}

std::string describe_protonation(const std::string& state) {
  if (state == "ASH" || state == "GLH" || state == "HIP") return "protonated";
  if (state == "LYN" || state == "AR0") return "neutral";
  if (state == "CYM" || state == "TYM") return "deprotonated";
  return {};
}

std::string residue_in_words(const Residue& residue) {
  std::string text = residue.name + " " + std::to_string(residue.number);
  if (residue.insertion_code != ' ') text += residue.insertion_code;
  return residue.chain.empty() ? text : text + " of chain " + residue.chain;
}

std::vector<ProtonationDifference> protonation_differences(const Molecule& source, const Molecule& target,
                                                           const std::vector<std::int32_t>& target_of) {
  const std::vector<Names> source_names = names_of_residues(source), target_names = names_of_residues(target);
  const std::vector<std::string> of_source = states_of(source, source_names),
                                 of_target = states_of(target, target_names);
  std::vector<ProtonationDifference> differences;
  for (std::size_t r = 0; r < target_of.size(); ++r) {
    if (target_of[r] < 0) continue;
    const auto t = static_cast<std::size_t>(target_of[r]);
    if (!has_hydrogens(source_names[r]) || !has_hydrogens(target_names[t])) continue;
    if (source_names[r].count("CA") == 0 || target_names[t].count("CA") == 0) continue;
    if (same_residue_name(source.residues[r].name, target.residues[t].name) && of_source[r] != of_target[t])
      differences.push_back({r, t, of_source[r], of_target[t]});
    const std::string source_end = end_of_chain(source_names[r]), target_end = end_of_chain(target_names[t]);
    if (source_end != target_end) differences.push_back({r, t, source_end, target_end});
  }
  return differences;
}

std::string in_words(const ProtonationDifference& difference, const Molecule& source) {
  return residue_in_words(source.residues[difference.source]) + ": " + difference.source_state + " in the source, " +
         difference.target_state + " in the target";
}

Message protonation_warning(const std::vector<ProtonationDifference>& differences, const Molecule& source) {
  constexpr std::size_t kMost = 4;
  std::string list;
  for (std::size_t i = 0; i < differences.size() && i < kMost; ++i)
    list += (i == 0 ? "" : "; ") + in_words(differences[i], source);
  if (differences.size() > kMost) list += "; and " + std::to_string(differences.size() - kMost) + " more";
  return std::to_string(differences.size()) + (differences.size() == 1 ? " residue differs" : " residues differ") +
         " in protonation, which makes a difference by itself: " + list + "; " + switched_on("same-protonation") +
         " gives prepared states the source's";
}

}  // namespace espdiff
