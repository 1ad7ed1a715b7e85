// planted_inputs.cpp: how often the checks of charges, composition and geometry see an error planted into a structure,
// and how often they refuse a right one; the tables of bench/study_notes.md. bench/planted_inputs makes its structures.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "align/pair_residues.h"
#include "base/error.h"
#include "certificate/result.h"
#include "input_checks/charge_warnings.h"
#include "input_checks/composition_warnings.h"
#include "input_checks/geometry_warnings.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/structure_file.h"
#include "motions/common_frame.h"
#include "options/options.h"

namespace {

using namespace espdiff;
using MoleculePair = std::pair<Molecule, Molecule>;
using Random = std::mt19937;

/// @returns whether the structure allows the error
using Plant = std::function<bool(MoleculePair&, Random&)>;

struct Kind {
  std::string name;
  Plant plant;
};

/// What the checks say of a pair.
struct Outcome {
  bool refuses = false, warns = false;
  bool unrelated = false;  ///< nothing pairs, which no check of these sees
  std::vector<std::string> texts;
  double ms = 0;
};

Outcome check(const MoleculePair& pair) {
  AlignedStates aligned;
  CompareOptions options;
  std::vector<Warning> warnings;
  Outcome outcome;
  try {
    aligned = align(pair.first, pair.second, options);
  } catch (const Error& error) {
    return {true, true, true, {std::string("refused: ") + error.what()}, 0};
  }
  const auto begun = std::chrono::steady_clock::now();
  const ResidueView source(pair.first), target(pair.second);
  check_geometry("source", source, warnings);
  check_geometry("target", target, warnings);
  check_charges("source", source, warnings);
  check_charges("target", target, warnings);
  check_paired_charges(source, target, aligned.alignment.pairing, warnings);
  for (Warning& warning : composition_warnings(pair.first, pair.second, {}, aligned.alignment, {}, {}))
    warnings.push_back(warning);
  outcome.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  for (const Warning& warning : warnings) {
    outcome.refuses = outcome.refuses || warning.refuses;
    outcome.texts.push_back((warning.refuses ? "REFUSED " : "warned ") + warning.text.plain());
  }
  outcome.warns = !warnings.empty();
  return outcome;
}

bool is_light(const Atom& atom) { return atom.element == "H"; }

std::vector<std::size_t> amino_acids(const Molecule& molecule) {
  const ResidueView view(molecule);
  std::vector<std::size_t> residues;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    if (view.kinds[r] == ResidueKind::kAminoAcid && view.atoms[r].size() > 4) residues.push_back(r);
  }
  return residues;
}

template <typename T>
const T& any_of(const std::vector<T>& values, Random& random) {
  return values[random() % values.size()];
}

void scale_charges(Molecule& molecule, float factor) {
  for (float& q : molecule.charges) q *= factor;
}

/// The charges move by n places along the file.
void shift_charges(Molecule& molecule, std::size_t n) {
  std::rotate(molecule.charges.begin(), molecule.charges.begin() + static_cast<std::ptrdiff_t>(n),
              molecule.charges.end());
}

bool charge_one_residue(Molecule& molecule, Random& random, float factor, bool charged_only) {
  const ResidueView view(molecule);
  std::vector<std::size_t> candidates;
  for (const std::size_t r : amino_acids(molecule)) {
    double net = 0;
    for (const std::size_t i : view.atoms[r]) net += static_cast<double>(molecule.charges[i]);
    if (!charged_only || std::fabs(net) > 0.5) candidates.push_back(r);
  }
  if (candidates.empty()) return false;
  for (const std::size_t i : view.atoms[any_of(candidates, random)]) molecule.charges[i] *= factor;
  return true;
}

Molecule kept(const Molecule& molecule, const std::function<bool(std::size_t)>& keep) {
  std::vector<bool> flags;
  for (std::size_t i = 0; i < molecule.size(); ++i) flags.push_back(keep(i));
  return keep_atoms(molecule, flags);
}

void add_residue(Molecule& molecule, const std::string& name, const std::vector<std::pair<std::string, Vec3d>>& atoms,
                 const std::vector<float>& charges) {
  molecule.residues.push_back({name, molecule.residues.front().chain, 9001, ' '});
  for (std::size_t k = 0; k < atoms.size(); ++k) {
    const std::string element =
        atoms[k].first == "ZN" || atoms[k].first == "FE" ? atoms[k].first : atoms[k].first.substr(0, 1);
    molecule.atoms.push_back({atoms[k].first, element, static_cast<std::int32_t>(molecule.residues.size() - 1), true});
    molecule.positions.push_back(atoms[k].second);
    molecule.radii.push_back(1.7F);
    molecule.charges.push_back(charges[k]);
  }
}

/// A place outside the molecule, 3 A from its outermost atom along an axis.
Vec3d outside(const Molecule& molecule) {
  Vec3d centre{};
  for (const Vec3d& p : molecule.positions) centre += p;
  centre = (1 / static_cast<double>(molecule.size())) * centre;
  Vec3d farthest = molecule.positions.front();
  for (const Vec3d& p : molecule.positions) {
    if (norm(p - centre) > norm(farthest - centre)) farthest = p;
  }
  return farthest + (3 / norm(farthest - centre)) * (farthest - centre);
}

/// A ring of 24 atoms around an iron, as a haem's.
void add_haem(Molecule& molecule, bool with_iron) {
  const Vec3d at = outside(molecule);
  std::vector<std::pair<std::string, Vec3d>> atoms;
  std::vector<float> charges;
  if (with_iron) {
    atoms.emplace_back("FE", at);
    charges.push_back(2);
  }
  for (int k = 0; k < 24; ++k) {
    const double angle = 2 * M_PI * (k / 2) / 12, radius = k % 2 == 0 ? 2.0 : 3.4;
    atoms.emplace_back((k % 2 == 0 ? "N" : "C") + std::to_string(k),
                       at + Vec3d{radius * std::cos(angle), radius * std::sin(angle), 0});
    charges.push_back(-4.0F / 24);
  }
  add_residue(molecule, "HEM", atoms, charges);
}

void add_ion(Molecule& molecule, const std::string& name, float charge) {
  add_residue(molecule, name, {{name, outside(molecule)}}, {charge});
}

/// A second copy of the molecule under another chain's name.
void add_copy(Molecule& molecule, const Vec3d& shift) {
  const std::size_t n_atoms = molecule.size(), n_residues = molecule.residues.size();
  for (std::size_t r = 0; r < n_residues; ++r) {
    molecule.residues.push_back(molecule.residues[r]);
    molecule.residues.back().chain += "z";
  }
  for (std::size_t i = 0; i < n_atoms; ++i) {
    molecule.atoms.push_back(molecule.atoms[i]);
    molecule.atoms.back().residue += static_cast<std::int32_t>(n_residues);
    molecule.positions.push_back(molecule.positions[i] + shift);
    molecule.radii.push_back(molecule.radii[i]);
    molecule.charges.push_back(molecule.charges[i]);
  }
}

bool is_backbone(const Atom& atom) {
  return atom.name == "N" || atom.name == "CA" || atom.name == "C" || atom.name == "O";
}

/// The side chains of two residues of one name change places.
bool exchange_side_chains(Molecule& molecule, Random& random) {
  const ResidueView view(molecule);
  std::map<std::string, std::vector<std::size_t>> by_name;
  for (const std::size_t r : amino_acids(molecule))
    by_name[molecule.residues[r].name + std::to_string(view.atoms[r].size())].push_back(r);
  std::vector<std::pair<std::size_t, std::size_t>> candidates;
  for (const auto& [name, residues] : by_name) {
    if (residues.size() > 1 && name.substr(0, 3) != "GLY" && name.substr(0, 3) != "ALA")
      candidates.emplace_back(residues[0], residues[1]);
  }
  if (candidates.empty()) return false;
  const auto [a, b] = any_of(candidates, random);
  for (std::size_t k = 0; k < view.atoms[a].size(); ++k) {
    const std::size_t i = view.atoms[a][k], j = view.atoms[b][k];
    if (!is_backbone(molecule.atoms[i])) std::swap(molecule.positions[i], molecule.positions[j]);
  }
  return true;
}

template <typename Change>
Plant to_target(Change change) {
  return [change](MoleculePair& pair, Random&) {
    change(pair.second);
    return true;
  };
}
template <typename Change>
Plant to_both(Change change) {
  return [change](MoleculePair& pair, Random&) {
    change(pair.first);
    change(pair.second);
    return true;
  };
}

void scale_positions(Molecule& molecule, double factor) {
  for (Vec3d& p : molecule.positions) p = factor * p;
}

void round_positions(Molecule& molecule) {
  for (Vec3d& p : molecule.positions) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
}

void add_charge_kinds(std::vector<Kind>& kinds) {
  kinds.push_back({"charges in Amber's internal unit", to_target([](Molecule& m) { scale_charges(m, 18.2223F); })});
  kinds.push_back({"all signs turned", to_target([](Molecule& m) { scale_charges(m, -1); })});
  kinds.push_back({"a tenth of the charges", to_target([](Molecule& m) { scale_charges(m, 0.1F); })});
  kinds.push_back({"charges shifted by one atom", to_target([](Molecule& m) { shift_charges(m, 1); })});
  kinds.push_back({"charges shifted by one residue",
                   to_target([](Molecule& m) { shift_charges(m, atoms_of_residues(m).front().size()); })});
  kinds.push_back({"one residue's signs turned", [](MoleculePair& pair, Random& random) {
                     return charge_one_residue(pair.second, random, -1, false);
                   }});
  kinds.push_back({"one charged residue without charges", [](MoleculePair& pair, Random& random) {
                     return charge_one_residue(pair.second, random, 0, true);
                   }});
  kinds.push_back({"hydrogens deleted, charges kept",
                   to_both([](Molecule& m) { m = kept(m, [&](std::size_t i) { return !is_light(m.atoms[i]); }); })});
}

void add_composition_kinds(std::vector<Kind>& kinds) {
  const auto haems = [](bool of_target, bool iron_of_target) {
    return [=](MoleculePair& pair, Random&) {
      add_haem(pair.first, true);
      if (of_target) add_haem(pair.second, iron_of_target);
      return true;
    };
  };
  kinds.push_back({"haem's iron missing", haems(true, false)});
  kinds.push_back({"haem missing", haems(false, false)});
  const auto ions = [](const std::string& other, float charge) {
    return [=](MoleculePair& pair, Random&) {
      add_ion(pair.first, "ZN", 2);
      if (!other.empty()) add_ion(pair.second, other, charge);
      return true;
    };
  };
  kinds.push_back({"zinc missing", ions("", 0)});
  kinds.push_back({"zinc replaced by sodium", ions("NA", 1)});
  kinds.push_back({"ion of the other sign", ions("ZN", -2)});
}

void add_geometry_kinds(std::vector<Kind>& kinds) {
  kinds.push_back({"one state in nm", to_target([](Molecule& m) { scale_positions(m, 0.1); })});
  kinds.push_back({"both states in nm", to_both([](Molecule& m) { scale_positions(m, 0.1); })});
  kinds.push_back({"one state larger by 10 %", to_target([](Molecule& m) { scale_positions(m, 1.1); })});
  kinds.push_back({"both rounded to 1 A", to_both(round_positions)});
  kinds.push_back({"both rounded to 1 A, then moved", to_both([](Molecule& m) {
                     round_positions(m);
                     for (Vec3d& p : m.positions) p += Vec3d{0.3, 0.2, 0.1};
                   })});
  kinds.push_back({"backbone only on both sides",
                   to_both([](Molecule& m) { m = kept(m, [&](std::size_t i) { return is_backbone(m.atoms[i]); }); })});
  kinds.push_back({"C-alpha only on both sides",
                   to_both([](Molecule& m) { m = kept(m, [&](std::size_t i) { return m.atoms[i].name == "CA"; }); })});
  kinds.push_back({"a chain on top of itself", to_target([](Molecule& m) { add_copy(m, {0, 0, 0}); })});
  kinds.push_back({"both states in one file", to_target([](Molecule& m) { add_copy(m, {1.1, 0.9, 0.7}); })});
  kinds.push_back({"side chains exchanged",
                   [](MoleculePair& pair, Random& random) { return exchange_side_chains(pair.second, random); }});
  kinds.push_back({"a residue at one point", [](MoleculePair& pair, Random& random) {
                     const ResidueView view(pair.second);
                     const std::vector<std::size_t> residues = amino_acids(pair.second);
                     if (residues.empty()) return false;
                     const auto& atoms = view.atoms[any_of(residues, random)];
                     for (const std::size_t i : atoms) pair.second.positions[i] = pair.second.positions[atoms.front()];
                     return true;
                   }});
}

/// The sample that a PQR gives for right pairs: itself, and itself turned with a little noise.
MoleculePair turned(const Molecule& molecule, Random& random) {
  MoleculePair pair{molecule, molecule};
  std::normal_distribution<double> noise(0, 0.02);
  for (Vec3d& p : pair.second.positions) p = Vec3d{-p.y + noise(random), p.x + noise(random), p.z + noise(random) + 5};
  return pair;
}

Molecule read(const std::string& path) {
  Molecule molecule = read_structure(path, {});
  molecule.name = path;
  return molecule;
}

void print_texts(const std::string& name, const Outcome& outcome) {
  for (const std::string& text : outcome.texts) std::fprintf(stderr, "%s: %s\n", name.c_str(), text.c_str());
}

/// What is counted of pairs.
struct Tally {
  std::size_t n = 0, refused = 0, warned = 0;
  double ms = 0, n_atoms = 0;

  Outcome add(const MoleculePair& pair) {
    Outcome outcome = check(pair);
    if (outcome.unrelated) return outcome;
    ++n;
    refused += outcome.refuses ? 1 : 0;
    warned += outcome.warns && !outcome.refuses ? 1 : 0;
    ms += outcome.ms;
    n_atoms += static_cast<double>(pair.first.size() + pair.second.size());
    return outcome;
  }
};

void print_row(const std::string& name, const Tally& tally) {
  std::printf("| %s | %zu | %zu | %zu | %zu |\n", name.c_str(), tally.n, tally.refused, tally.warned,
              tally.n - tally.refused - tally.warned);
}

/// An error planted into each structure; what the structure has by itself does not count.
Tally plant(const Kind& kind, const std::vector<Molecule>& molecules, Random& random) {
  Tally tally;
  for (const Molecule& molecule : molecules) {
    MoleculePair pair{molecule, molecule};
    if (!kind.plant(pair, random)) continue;
    const Outcome before = check({molecule, molecule}), outcome = check(pair);
    const bool is_new = std::any_of(outcome.texts.begin(), outcome.texts.end(), [&](const std::string& text) {
      return std::find(before.texts.begin(), before.texts.end(), text) == before.texts.end();
    });
    ++tally.n;
    tally.refused += outcome.refuses && is_new ? 1 : 0;
    tally.warned += !outcome.refuses && is_new ? 1 : 0;
    if (!is_new) std::fprintf(stderr, "MISSED %s in %s\n", kind.name.c_str(), molecule.name.c_str());
  }
  return tally;
}

Tally count_pairs(const std::vector<std::string>& files, bool tell) {
  Tally tally;
  for (std::size_t k = 0; k + 1 < files.size(); k += 2) {
    const Outcome outcome = tally.add({read(files[k]), read(files[k + 1])});
    if (tell) print_texts(files[k] + " / " + files[k + 1], outcome);
  }
  return tally;
}

}  // namespace

/// planted_inputs FILE.pqr ... [--fields A B A B ...] [--pairs A B A B ...]: errors are planted into each file; charges
/// of two force fields on the two sides of the first pairs; right pairs.
int main(int argc, char** argv) {
  std::map<std::string, std::vector<std::string>> words;
  std::string list;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--fields" || word == "--pairs") {
      list = word;
    } else {
      words[list].push_back(word);
    }
  }
  std::vector<Kind> kinds;
  add_charge_kinds(kinds);
  add_composition_kinds(kinds);
  add_geometry_kinds(kinds);
  Random random(20);
  std::vector<Molecule> molecules;
  for (const std::string& file : words[""]) molecules.push_back(read(file));
  std::printf("| planted error | cases | refused | warned only | missed |\n|---|---|---|---|---|\n");
  for (const Kind& kind : kinds) print_row(kind.name, plant(kind, molecules, random));
  print_row("charges of two force fields", count_pairs(words["--fields"], false));
  Tally right;
  for (const Molecule& molecule : molecules) {
    print_texts(molecule.name, right.add({molecule, molecule}));
    right.add(turned(molecule, random));
  }
  std::printf("\n| right pairs | cases | refused | warned only | nothing said |\n|---|---|---|---|---|\n");
  print_row("a structure with itself, and turned with 0.02 A of noise", right);
  const Tally real = count_pairs(words["--pairs"], true);
  print_row("two structures", real);
  std::printf("\n%.2f ms a thousand atoms\n", 1000 * (right.ms + real.ms) / (right.n_atoms + real.n_atoms));
  return 0;
}
