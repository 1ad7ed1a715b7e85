// preparation.cpp: compares a structure's atoms before and after PDB2PQR.
#include "prepare/charges/preparation.h"

#include <algorithm>
#include <map>
#include <set>

#include "align/protonation.h"
#include "align/residue_charges.h"
#include "align/residue_names.h"
#include "base/error.h"
#include "prepare/charges/caps.h"
#include "prepare/charges/modified_residues.h"
#include "prepare/charges/open_babel.h"

namespace espdiff {
namespace {

bool is_hydrogen(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

/// Heavy atoms by residue: normalized names, and the number of hydrogens.
struct ResidueAtoms {
  std::vector<std::string> heavy;
  std::set<std::string> normalized;
  std::size_t n_hydrogens = 0;
};

/// Molecules under one chain's name can have numbers in common.
std::pair<ResidueKey, char> key_with_letter(const Residue& residue) {
  return {key_of(residue), residue_letter(residue.name)};
}

std::map<std::pair<ResidueKey, char>, ResidueAtoms> atoms_by_residue(const Molecule& molecule) {
  std::map<std::pair<ResidueKey, char>, ResidueAtoms> all;
  for (const Atom& atom : molecule.atoms) {
    const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
    ResidueAtoms& of = all[key_with_letter(residue)];
    if (is_hydrogen(atom)) {
      ++of.n_hydrogens;
      continue;
    }
    of.heavy.push_back(atom.name);
    of.normalized.insert(normalized_atom_name(atom.name, residue_letter(residue.name)));
  }
  return all;
}

std::string joined(const std::vector<std::string>& words, std::size_t most = 6) {
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), most); ++i) text += (text.empty() ? "" : ", ") + words[i];
  return words.size() > most ? text + " and " + std::to_string(words.size() - most) + " more" : text;
}

/// The names in `a` that are not in `b`.
std::vector<std::string> missing_in(const ResidueAtoms& a, const ResidueAtoms& b, char letter) {
  std::vector<std::string> missing;
  for (const std::string& name : a.heavy) {
    if (b.normalized.count(normalized_atom_name(name, letter)) == 0) missing.push_back(name);
  }
  return missing;
}

/// Atoms without charge, by residue.
struct Uncharged {
  std::vector<std::string> in_words;
  std::vector<UnchargedResidue> residues;
  std::size_t n_atoms = 0;
  std::string first_atom;

  /// @param is_whole whether no atom of the residue gets a charge
  void add(const Residue& residue, const std::vector<std::string>& atoms, bool is_whole, bool can_be_made) {
    if (n_atoms == 0) first_atom = atoms.front();
    in_words.push_back(residue_in_words(residue));
    residues.push_back({residue, is_whole ? std::vector<std::string>() : atoms, can_be_made});
    n_atoms += atoms.size();
  }
};

/// PARSE has RNA, TYL06 is AMBER's with other radii; the others have no nucleotides or no DNA.
bool has_nucleotides(const std::string& force_field) {
  return force_field == "amber" || force_field == "tyl06" || force_field == "charmm";
}

[[noreturn]] void refuse(const Molecule& before, const std::string& force_field, const Uncharged& uncharged) {
  // All of them, so that one command can be right for all.
  constexpr std::size_t kMostNamed = 12;
  const Message lack = std::to_string(uncharged.n_atoms) +
                       (uncharged.n_atoms == 1 ? " atom gets no charge" : " atoms get no charges") +
                       " from PDB2PQR's force field " + force_field + ": " + joined(uncharged.in_words, kMostNamed) +
                       " (first atom " + uncharged.first_atom + ")";
  throw UnchargedError(before.name, lack, uncharged_remedy(uncharged.residues, force_field), uncharged.residues.front(),
                       uncharged.residues);
}

/// "(AP5,SO4)"
std::string name_selection(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "(" : ",") + name;
  return text + ")";
}

/// What --leave-out is to drop: ligands and ions by name, of usual residues, which have their name in common with
/// others, only what gets no charge.
struct Selected {
  std::set<std::string> names, all_names;
  std::string atoms;
  std::size_t n = 0;

  void add(const UnchargedResidue& residue, bool is_usual) {
    ++n;
    all_names.insert(residue.name);
    if (is_usual)
      atoms += (atoms.empty() ? "" : " ") + atom_selection(residue, residue.atoms);
    else
      names.insert(residue.name);
  }
  std::string selection() const {
    const std::string by_name = names.empty() ? "" : name_selection(names);
    return by_name + (by_name.empty() || atoms.empty() ? "" : " ") + atoms;
  }
};

/// Null where there is no atom of the name.
const Vec3d* position_of(const Molecule& molecule, const std::vector<std::size_t>& atoms, const char* name) {
  for (const std::size_t i : atoms) {
    if (normalized_atom_name(molecule.atoms[i].name) == name) return &molecule.positions[i];
  }
  return nullptr;
}

void add_protonation(const Molecule& after, Preparation& preparation) {
  const std::vector<std::string> states = protonation_states(after);
  const auto atoms = atoms_of_residues(after);
  for (std::size_t r = 0; r < states.size(); ++r) {
    if (!is_known_amino_acid(after.residues[r].name) || !foreign_atoms(after, r, atoms[r]).empty()) continue;
    const std::string meaning = describe_protonation(states[r]);
    const bool is_histidine = states[r] == "HID" || states[r] == "HIE";
    if (meaning.empty() && !is_histidine) continue;
    preparation.protonation.push_back(residue_in_words(after.residues[r]) + ": " + states[r] +
                                      (meaning.empty() ? "" : " (" + meaning + ")"));
  }
}

}  // namespace

Message uncharged_remedy(const std::vector<UnchargedResidue>& residues, const std::string& force_field) {
  Selected all, others;  // those that Open Babel cannot make
  bool all_nucleotides = !has_nucleotides(force_field), any_usual = false;
  for (const UnchargedResidue& residue : residues) {
    const char letter = residue_letter(residue.name);
    const bool is_nucleotide = letter >= 'a' && letter <= 'z',
               is_usual = is_nucleotide || is_known_amino_acid(residue.name);
    all_nucleotides = all_nucleotides && is_nucleotide;
    all.add(residue, is_usual);
    if (residue.can_be_made || (!is_usual && !is_ion_name(residue.name))) continue;
    others.add(residue, is_usual);
    any_usual = any_usual || is_usual;
  }
  if (all_nucleotides) {
    const Message amber = option("force-field", "amber");
    return Message("; take a force field that has nucleotides (" + amber + "), or drop them (" +
                   option("leave-out", name_selection(all.all_names)) + ")")
        .set_next({"", {{"force-field", "amber"}}});
  }
  NextCommand next;
  Message remedy = "; ";
  const bool has_open_babel = !find_open_babel().empty();
  if (others.n < residues.size()) {
    remedy += "let Open Babel make them" +
              (has_open_babel ? std::string() : ", which is not there: " + std::string(kOpenBabelRemedy)) + " (" +
              option("ligands", "auto") + "), give a MOL2 file of each with hydrogens (" + option("ligand", "FILE") +
              "), ";
    if (!has_open_babel) next.before = "apt install openbabel && ";
    next.options.push_back({"ligands", "auto"});
  } else {
    remedy += "give ";
  }
  if (others.n > 0) next.options.push_back({"leave-out", others.selection()});
  remedy += "charges for all atoms (" + option("topology", "FILE") + ", " + option("charges-from", "FILE") +
            " or a PQR), " + (any_usual ? "complete these residues, or leave these atoms out" : "or drop them") + " (" +
            option("leave-out", all.selection()) + ")";
  return remedy.set_next(next);
}

std::string atom_selection(const Residue& residue, const std::vector<std::string>& names) {
  std::string text = "//" + (residue.chain.empty() ? "*" : residue.chain) + "/" + std::to_string(residue.number);
  if (residue.insertion_code != ' ') text += std::string(".") + residue.insertion_code;
  for (const std::string& name : names) text += (&name == &names.front() ? "/" : ",") + name;
  return text;
}

std::vector<std::size_t> pieces_of_chains(const Molecule& molecule) {
  // Of a bond, then of what lies around it where the phosphate was left out or atoms are missing.
  struct Reach {
    const char *before, *after;
    double longest_A;
  };
  constexpr Reach kReaches[] = {{"C", "N", 2.5}, {"O3'", "P", 2.5}, {"O3'", "O5'", 4}, {"C3'", "C5'", 6.5}};
  struct Last {
    std::size_t residue = 0;
    ResidueKind kind = ResidueKind::kOther;
    std::size_t piece = 0;
  };
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  const auto is_bound = [&](std::size_t before, std::size_t after) {
    for (const Reach& reach : kReaches) {
      const Vec3d *const a = position_of(molecule, atoms[before], reach.before), *const b =
                                                                                     position_of(molecule, atoms[after],
                                                                                                 reach.after);
      if (a != nullptr && b != nullptr) return norm(*a - *b) <= reach.longest_A;
    }
    return true;
  };
  std::map<std::string, Last> chains;
  std::vector<std::size_t> pieces;
  for (std::size_t r = 0; r < kinds.size(); ++r) {
    const std::string& name = molecule.residues[r].name;
    const ResidueKind kind = is_cap_name(name)             ? ResidueKind::kAminoAcid
                             : residue_letter(name) == '?' ? ResidueKind::kOther
                                                           : kinds[r];
    Last& last = chains[molecule.residues[r].chain];
    if (kind != ResidueKind::kOther) {
      // A break of a protein is a missing loop unless its numbers begin anew.
      const bool falls = molecule.residues[r].number < molecule.residues[last.residue].number;
      const bool begins =
          last.kind != ResidueKind::kOther &&
          (kind != last.kind || ((kind == ResidueKind::kNucleotide || falls) && !is_bound(last.residue, r)));
      last = {r, kind, last.piece + (begins ? 1 : 0)};
    }
    pieces.push_back(last.piece);
  }
  return pieces;
}

std::vector<std::string> chain_gaps(const Molecule& molecule) {
  constexpr double kLongest_A = 2.5;
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  std::vector<std::string> gaps;
  for (std::size_t r = 0; r + 1 < molecule.residues.size(); ++r) {
    const Residue &a = molecule.residues[r], &b = molecule.residues[r + 1];
    if (a.chain != b.chain || kinds[r] != ResidueKind::kAminoAcid || kinds[r + 1] != ResidueKind::kAminoAcid) continue;
    const Vec3d *const c = position_of(molecule, atoms[r], "C"), *const n = position_of(molecule, atoms[r + 1], "N");
    if (c == nullptr || n == nullptr || norm(*c - *n) <= kLongest_A) continue;
    const auto short_name = [](const Residue& residue) {
      const std::string code = residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code);
      return residue.name + " " + std::to_string(residue.number) + code;
    };
    gaps.push_back("between " + short_name(a) + " and " + short_name(b) +
                   (a.chain.empty() ? "" : " of chain " + a.chain));
  }
  return gaps;
}

void require_known_names(const Molecule& before, const std::vector<GroupSource>& sources,
                         const std::vector<std::int32_t>& ligand_of, const std::string& force_field) {
  // CHARMM's list has more than chains; what it lacks is found afterwards.
  if (force_field == "charmm") return;
  const auto atoms = atoms_of_residues(before);
  const std::vector<ResidueKind> kinds = residue_kinds(before, atoms);
  Uncharged uncharged;
  for (std::size_t r = 0; r < kinds.size(); ++r) {
    const std::string& name = before.residues[r].name;
    const std::vector<std::string> foreign = foreign_atoms(before, r, atoms[r]);
    const bool is_known =
        kinds[r] == ResidueKind::kOther ? ligand_of[r] >= 0 || is_cap_name(name) || sources[r] != GroupSource::kNone
        : kinds[r] == ResidueKind::kAminoAcid
            ? sources[r] != GroupSource::kNone || ligand_of[r] >= 0 || (is_known_amino_acid(name) && foreign.empty())
            : kinds[r] != ResidueKind::kNucleotide || has_nucleotides(force_field) ||
                  (force_field == "parse" && name.front() != 'D' && name.front() != 'T');
    if (is_known || atoms[r].empty()) continue;
    std::vector<std::string> names = foreign;
    for (const std::size_t i : atoms[r]) {
      if (foreign.empty() && !is_hydrogen(before.atoms[i])) names.push_back(before.atoms[i].name);
    }
    if (!names.empty()) uncharged.add(before.residues[r], names, foreign.empty(), !foreign.empty());
  }
  if (uncharged.n_atoms > 0) refuse(before, force_field, uncharged);
}

void compare_with_input(const Molecule& before, const Molecule& after, Preparation& preparation) {
  const auto of_before = atoms_by_residue(before), of_after = atoms_by_residue(after);
  Uncharged uncharged;
  static const ResidueAtoms none;
  for (const Residue& residue : before.residues) {
    const ResidueAtoms& given = of_before.at(key_with_letter(residue));
    const auto found = of_after.find(key_with_letter(residue));
    const ResidueAtoms& got = found == of_after.end() ? none : found->second;
    const char letter = residue_letter(residue.name);
    std::vector<std::string> missing = missing_in(given, got, letter), extra = missing_in(got, given, letter);
    // Within a chain no residue has a second oxygen.
    const auto is_end = [](const std::string& name) { return normalized_atom_name(name) == "OXT"; };
    if (found != of_after.end() && std::any_of(missing.begin(), missing.end(), is_end)) {
      preparation.removed.push_back("OXT of " + residue_in_words(residue));
      missing.erase(std::remove_if(missing.begin(), missing.end(), is_end), missing.end());
    }
    if (!missing.empty()) uncharged.add(residue, missing, found == of_after.end(), false);
    if (!extra.empty()) preparation.added.push_back(joined(extra) + " of " + residue_in_words(residue));
    preparation.n_hydrogens_added += got.n_hydrogens > given.n_hydrogens ? got.n_hydrogens - given.n_hydrogens : 0;
  }
  if (uncharged.n_atoms > 0) refuse(before, preparation.force_field, uncharged);
  preparation.n_atoms_before = before.size();
  preparation.n_atoms = after.size();
  preparation.net_charge = 0;
  for (const float q : after.charges) preparation.net_charge += static_cast<double>(q);
  preparation.gaps = chain_gaps(before);
  add_protonation(after, preparation);
}

}  // namespace espdiff
