// select_atoms.cpp: gemmi's selections on our molecules.
#include "io/molecules/select_atoms.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/molecule/water.h"
#include "io/molecules/selected_numbers.h"
#include "io/text/text_cursor.h"
#ifdef ESPDIFF_HAVE_GEMMI
#define USE_STD_SNPRINTF  // gemmi 0.5 then needs no stb_sprintf.h, which gemmi-dev lacks
#include <gemmi/select.hpp>
#endif

namespace espdiff {
namespace {

/// [residue] whether it is an amino acid or a nucleotide, by its backbone atoms.
std::vector<bool> polymer_residues(const Molecule& molecule) {
  std::vector<std::set<std::string>> names(molecule.residues.size());
  for (const Atom& atom : molecule.atoms) names[static_cast<std::size_t>(atom.residue)].insert(atom.name);
  std::vector<bool> polymer;
  for (const std::set<std::string>& has : names) {
    const bool amino_acid = has.count("CA") > 0 && (has.count("N") > 0 || has.count("C") > 0);
    polymer.push_back(amino_acid || has.count("C3'") > 0 || has.count("C3*") > 0);
  }
  return polymer;
}

}  // namespace

std::string describe_chains(const Molecule& molecule) {
  constexpr std::size_t kMostChains = 12, kMostLigands = 6;
  struct Chain {
    int first = 0, last = 0, n = 0;
    std::vector<std::string> others;
  };
  std::vector<std::string> order;
  std::map<std::string, Chain> chains;
  const std::vector<bool> polymer = polymer_residues(molecule);
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    const Residue& residue = molecule.residues[r];
    const auto [entry, is_new] = chains.try_emplace(residue.chain);
    if (is_new) order.push_back(residue.chain);
    Chain& chain = entry->second;
    if (!polymer[r]) {
      if (std::find(chain.others.begin(), chain.others.end(), residue.name) == chain.others.end())
        chain.others.push_back(residue.name);
      continue;
    }
    if (chain.n++ == 0) chain.first = chain.last = residue.number;
    chain.first = std::min(chain.first, residue.number);
    chain.last = std::max(chain.last, residue.number);
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(order.size(), kMostChains); ++i) {
    const Chain& chain = chains[order[i]];
    std::string content = chain.n == 0 ? "" : std::to_string(chain.first) + "-" + std::to_string(chain.last);
    for (std::size_t k = 0; k < std::min(chain.others.size(), kMostLigands); ++k)
      content += (content.empty() ? "" : ", ") + chain.others[k];
    text +=
        (text.empty() ? "" : ", ") + (order[i].empty() ? "no chain name" : "chain " + order[i]) + " (" + content + ")";
  }
  return order.size() > kMostChains ? text + " and " + std::to_string(order.size() - kMostChains) + " more" : text;
}

#ifdef ESPDIFF_HAVE_GEMMI

namespace {

/// A selection by gemmi, but for residues' numbers, which are ours.
struct ParsedSelection {
  gemmi::Selection rest;
  std::vector<SelectedNumbers> numbers;

  bool matches(const gemmi::Chain& chain, const gemmi::Residue& as_gemmi, const Residue& residue) const {
    return rest.matches(chain) && rest.matches(as_gemmi) &&
           (numbers.empty() || std::any_of(numbers.begin(), numbers.end(),
                                           [&](const SelectedNumbers& range) { return range.has(residue); }));
  }
};

ParsedSelection parsed(const std::string& part, const std::string& option_name) {
  SplitSelection split = split_numbers(part, option_name);
  ParsedSelection selection{{}, std::move(split.numbers)};
  try {
    selection.rest = gemmi::Selection(split.rest);
  } catch (const std::exception&) {
    throw InputError(option(option_name) + ": " + in_quotes(part) +
                     " is not a selection such as //A, //A/10-20, (AP5,CL) or //A;polymer (gemmi's syntax: "
                     "/model/chains/residues/atoms)");
  }
  const gemmi::Selection& rest = selection.rest;
  if (rest.mdl != 0 || !rest.altlocs.all || !rest.atom_inequalities.empty())
    throw InputError(option(option_name) + ": " + in_quotes(part) +
                     " selects by model, alternate location, occupancy or B factor, which are not known here; select "
                     "by chain, residue, atom or element");
  if (!rest.from_seqid.empty() || !rest.to_seqid.empty())
    throw InputError(option(option_name) + ": " + in_quotes(part) +
                     " has residue numbers behind names; give them before: 10-20(ALA)");
  return selection;
}

}  // namespace

std::vector<bool> select_atoms(const Molecule& molecule, const std::string& text, const std::string& option_name) {
  std::vector<ParsedSelection> selections;
  for (const std::string_view part : split_words(text)) selections.push_back(parsed(std::string(part), option_name));
  if (selections.empty()) throw InputError(option(option_name) + ": an empty selection; name atoms, such as //A");
  const std::vector<bool> polymer = polymer_residues(molecule);
  // Chains and residues are tested once; [selection][residue]
  std::vector<std::vector<bool>> residue_matches(selections.size());
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    const Residue& residue = molecule.residues[r];
    gemmi::Chain chain(residue.chain);
    gemmi::Residue as_gemmi;
    as_gemmi.name = residue.name;
    as_gemmi.seqid = gemmi::SeqId(residue.number, residue.insertion_code);
    as_gemmi.entity_type = polymer[r]                    ? gemmi::EntityType::Polymer
                           : is_water_name(residue.name) ? gemmi::EntityType::Water
                                                         : gemmi::EntityType::NonPolymer;
    for (std::size_t s = 0; s < selections.size(); ++s)
      residue_matches[s].push_back(selections[s].matches(chain, as_gemmi, residue));
  }
  std::vector<bool> selected;
  for (const Atom& atom : molecule.atoms) {
    gemmi::Atom as_gemmi;
    as_gemmi.name = atom.name;
    as_gemmi.element = gemmi::Element(atom.element);
    bool is_selected = false;
    for (std::size_t s = 0; s < selections.size() && !is_selected; ++s)
      is_selected = residue_matches[s][static_cast<std::size_t>(atom.residue)] && selections[s].rest.matches(as_gemmi);
    selected.push_back(is_selected);
  }
  return selected;
}

#else

std::vector<bool> select_atoms(const Molecule&, const std::string& text, const std::string& option_name) {
  throw InputError(option(option_name) + ": " + in_quotes(text) +
                   ": this build lacks gemmi, which evaluates selections; build espdiff with it (Debian: gemmi-dev)");
}

#endif

std::vector<bool> select_some_atoms(const Molecule& molecule, const std::string& selection,
                                    const std::string& option_name) {
  std::vector<bool> selected = select_atoms(molecule, selection, option_name);
  if (std::find(selected.begin(), selected.end(), true) == selected.end())
    throw InputError(molecule.name + ": " + option(option_name) + " " + in_quotes(selection) +
                     " selects no atom; the file has " + describe_chains(molecule));
  return selected;
}

Molecule keep_atoms(const Molecule& molecule, const std::vector<bool>& keep) {
  Molecule kept;
  kept.name = molecule.name;
  kept.radii_origin = molecule.radii_origin;
  kept.left_out = molecule.left_out;
  kept.formulas = molecule.formulas;
  std::vector<std::int32_t> new_residue(molecule.residues.size(), -1);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (!keep[i]) continue;
    const auto old = static_cast<std::size_t>(molecule.atoms[i].residue);
    if (new_residue[old] < 0) {
      new_residue[old] = static_cast<std::int32_t>(kept.residues.size());
      kept.residues.push_back(molecule.residues[old]);
    }
    kept.atoms.push_back(molecule.atoms[i]);
    kept.atoms.back().residue = new_residue[old];
    kept.positions.push_back(molecule.positions[i]);
    if (!molecule.radii.empty()) kept.radii.push_back(molecule.radii[i]);
    if (!molecule.charges.empty()) kept.charges.push_back(molecule.charges[i]);
  }
  return kept;
}

void refuse_left_out(const std::string& name, std::size_t n_water, std::size_t n_hetero) {
  Message text = name + ": no atoms are left: ";
  NextCommand next;
  const auto add = [&](std::size_t n, const char* kind, const char* keeps) {
    if (n == 0) return;
    if (!next.options.empty()) text += " and ";
    text += std::to_string(n) + " are " + kind + ", which " + switched_on(keeps) + " keeps";
    next.options.push_back({keeps, "", true});
  };
  add(n_water, "water", "water");
  add(n_hetero, "HETATM records", "hetero");
  throw InputError(text.set_next(next));
}

Molecule keep_kinds(const Molecule& molecule, const StructureOptions& options) {
  std::vector<bool> keep;
  std::size_t n_water = 0;
  for (const Atom& atom : molecule.atoms) {
    const bool water = is_water_name(molecule.residues[static_cast<std::size_t>(atom.residue)].name);
    keep.push_back(water ? options.include_water : options.include_hetero || !atom.hetero);
    if (water) ++n_water;
  }
  if (std::find(keep.begin(), keep.end(), true) == keep.end())
    refuse_left_out(molecule.name, n_water, molecule.size() - n_water);
  return keep_atoms(molecule, keep);
}

Molecule without_repeated_atoms(const Molecule& molecule) {
  std::set<std::pair<std::int32_t, std::string>> seen;
  std::vector<bool> keep;
  for (const Atom& atom : molecule.atoms) keep.push_back(seen.emplace(atom.residue, atom.name).second);
  return keep_atoms(molecule, keep);
}

}  // namespace espdiff
