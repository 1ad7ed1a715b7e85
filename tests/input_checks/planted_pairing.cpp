// planted_pairing.cpp: wrong and right correspondences made from two copies of a protein.
#include "input_checks/planted_pairing.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>

#include "align/chain_links.h"
#include "align/geometry/superpose.h"
#include "base/error.h"
#include "input_checks/input_warnings.h"
#include "motions/common_frame.h"
#include "options/options.h"

namespace espdiff_test {
namespace {

using namespace espdiff;
using MoleculePair = std::pair<Molecule, Molecule>;

std::vector<std::size_t> trace_residues(const Molecule& molecule) {
  const ResidueView view(molecule);
  std::vector<std::size_t> residues;
  for (const auto& chain : chain_links(view).chains) {
    for (const std::size_t r : chain) {
      if (trace_atom(view, r) >= 0) residues.push_back(r);
    }
  }
  return residues;
}

std::map<std::string, std::size_t> atoms_by_name(const ResidueView& view, std::size_t residue) {
  std::map<std::string, std::size_t> atoms;
  for (const std::size_t i : view.atoms[residue]) atoms.emplace(view.molecule->atoms[i].name, i);
  return atoms;
}

bool is_main_chain(const std::string& name) {
  return name == "N" || name == "CA" || name == "C" || name == "O" || name == "OXT";
}

/// Exchanges the side chains of `n` pairs of residues of one type with the same atoms, spread over the molecule.
int exchange_side_chains(Molecule& molecule, int n, std::size_t start) {
  const ResidueView view(molecule);
  const std::vector<std::size_t> residues = trace_residues(molecule);
  std::vector<bool> used(molecule.residues.size(), false);
  int done = 0;
  for (std::size_t k = 0; k < residues.size() && done < n; ++k) {
    const std::size_t a = residues[(start + 7 * k) % residues.size()];
    const auto of_a = atoms_by_name(view, a);
    if (used[a] || of_a.size() < 6) continue;
    for (std::size_t j = 0; j < residues.size(); ++j) {
      const std::size_t b = residues[(start + 7 * k + 40 + j) % residues.size()];
      if (b == a || used[b] || molecule.residues[a].name != molecule.residues[b].name) continue;
      const auto of_b = atoms_by_name(view, b);
      const bool alike =
          of_a.size() == of_b.size() && std::equal(of_a.begin(), of_a.end(), of_b.begin(),
                                                   [](const auto& x, const auto& y) { return x.first == y.first; });
      if (!alike) continue;
      for (const auto& [name, i] : of_a) {
        if (!is_main_chain(name)) std::swap(molecule.positions[i], molecule.positions[of_b.at(name)]);
      }
      used[a] = used[b] = true;
      ++done;
      break;
    }
  }
  return done;
}

double ca_distance(const Molecule& molecule, std::size_t a, std::size_t b) {
  const ResidueView view(molecule);
  return norm(molecule.positions[static_cast<std::size_t>(trace_atom(view, a))] -
              molecule.positions[static_cast<std::size_t>(trace_atom(view, b))]);
}

/// The first stretch at or after `from` whose C-alpha atoms at a distance of `apart` residues all lie `least` to `most`
/// A apart; its number of residues is at least `length`. Returns the end of the list where there is none.
std::size_t find_stretch(const Molecule& molecule, const std::vector<std::size_t>& residues, std::size_t from,
                         std::size_t length, std::size_t apart, double least, double most) {
  std::size_t n = 0;
  for (std::size_t k = from; k + apart < residues.size(); ++k) {
    const double d = ca_distance(molecule, residues[k], residues[k + apart]);
    n = d >= least && d <= most ? n + 1 : 0;
    if (n + apart >= length) return k + apart + 1 - length;
  }
  return residues.size();
}

/// Slides the residues of a stretch by `shift` along the chain; beside it the shift fades over four residues.
void slide(Molecule& molecule, const std::vector<std::size_t>& residues, std::size_t first, std::size_t length,
           double shift) {
  const Molecule before = molecule;
  const ResidueView view(before);
  for (std::size_t k = first - 4; k < first + length + 4; ++k) {
    const double ramp = k < first             ? static_cast<double>(k + 5 - first) / 5
                        : k >= first + length ? static_cast<double>(first + length + 4 - k) / 5
                                              : 1;
    const double there = static_cast<double>(k) + shift * ramp;
    const auto low = static_cast<std::size_t>(std::floor(there));
    const double part = there - std::floor(there);
    const auto here = atoms_by_name(view, residues[k]), a = atoms_by_name(view, residues[low]),
               b = atoms_by_name(view, residues[low + 1]);
    const auto moved_to = [&](const std::string& name) {
      return (1 - part) * before.positions[a.at(name)] + part * before.positions[b.at(name)];
    };
    for (const auto& [name, i] : here) {
      const bool known = a.count(name) != 0 && b.count(name) != 0 && (is_main_chain(name) || name == "CB");
      molecule.positions[i] =
          known ? moved_to(name) : before.positions[i] + moved_to("CA") - before.positions[here.at("CA")];
    }
  }
}

/// Turns atoms about an axis through a point.
void turn(Molecule& molecule, const std::function<bool(std::size_t)>& chosen, const Vec3d& centre, Vec3d axis,
          double degrees) {
  Screw screw;
  screw.axis = (1 / norm(axis)) * axis;
  screw.angle = degrees * kPi / 180;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (chosen(static_cast<std::size_t>(molecule.atoms[i].residue)))
      molecule.positions[i] = centre + screw.apply(molecule.positions[i] - centre, 1) - screw.apply({0, 0, 0}, 1);
  }
}

Vec3d centre_of(const Molecule& molecule, const std::function<bool(std::size_t)>& chosen) {
  Vec3d sum{};
  double n = 0;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (!chosen(static_cast<std::size_t>(molecule.atoms[i].residue))) continue;
    sum += molecule.positions[i];
    ++n;
  }
  return (1 / n) * sum;
}

/// Both copies in one molecule, the second under a name and with numbers of its own.
Molecule joined(const Molecule& a, const Molecule& b, const std::string& chain, int add) {
  Molecule both = a;
  const auto n = static_cast<std::int32_t>(a.residues.size());
  for (Residue residue : b.residues) {
    residue.chain = chain;
    residue.number += add;
    both.residues.push_back(residue);
  }
  for (Atom atom : b.atoms) {
    atom.residue += n;
    both.atoms.push_back(atom);
  }
  both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
  both.radii.insert(both.radii.end(), b.radii.begin(), b.radii.end());
  return both;
}

/// Some residues, in the order given, each under the name of a chain.
Molecule chosen_residues(const Molecule& molecule, const std::vector<std::pair<std::size_t, std::string>>& residues) {
  const ResidueView view(molecule);
  Molecule result;
  result.name = molecule.name;
  for (const auto& [r, chain] : residues) {
    result.residues.push_back(molecule.residues[r]);
    result.residues.back().chain = chain;
    for (const std::size_t i : view.atoms[r]) {
      result.atoms.push_back(molecule.atoms[i]);
      result.atoms.back().residue = static_cast<std::int32_t>(result.residues.size() - 1);
      result.positions.push_back(molecule.positions[i]);
      result.radii.push_back(molecule.radii[i]);
    }
  }
  return result;
}

/// Three equal peptides in different places. The second molecule lists them in another order, under their names or, for
/// `renamed`, under each other's.
MoleculePair peptides(const Molecule& molecule, std::size_t length, bool renamed) {
  const std::vector<std::size_t> residues = trace_residues(molecule);
  std::vector<std::pair<std::size_t, std::string>> all;
  for (std::size_t k = 0; k < length; ++k) all.emplace_back(residues[30 + k], "A");
  const Molecule one = chosen_residues(molecule, all);
  const auto at = [&](const std::string& chain, const Vec3d& shift) {
    Molecule moved = one;
    for (Vec3d& p : moved.positions) p += shift;
    for (Residue& residue : moved.residues) residue.chain = chain;
    return moved;
  };
  const auto together = [&](const Molecule& a, const Molecule& b, const Molecule& c) {
    return joined(joined(a, b, b.residues[0].chain, 0), c, c.residues[0].chain, 0);
  };
  const Vec3d second{0, 12, 0}, third{25, 3, 8};
  const Molecule source = together(at("A", {}), at("B", second), at("C", third));
  return {source, renamed ? together(at("A", second), at("B", {}), at("C", third))
                          : together(at("B", second), at("A", {}), at("C", third))};
}

/// Residues outside polymers of at least 20 atoms: cofactors.
std::vector<std::size_t> cofactors(const Molecule& molecule) {
  const ResidueView view(molecule);
  std::vector<std::size_t> found;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    if (view.kinds[r] == ResidueKind::kOther && view.atoms[r].size() >= 20) found.push_back(r);
  }
  return found;
}

}  // namespace

std::vector<PlacedError> pairing_errors(const Molecule& a, const Molecule& b, std::size_t number) {
  std::vector<PlacedError> errors;
  const auto add = [&](const std::string& kind, const std::string& text, MoleculePair pair) {
    errors.push_back({kind, text, std::move(pair)});
  };
  for (const int n : {1, 2, 10}) {
    Molecule target = b;
    if (exchange_side_chains(target, n, 13 * number) == n)
      add("side chains exchanged, " + std::to_string(n) + (n == 1 ? " pair" : " pairs"), "in the places of others",
          {a, target});
  }
  const std::vector<std::size_t> residues = trace_residues(b);
  const std::size_t strand = find_stretch(b, residues, 10 + 5 * (number % 8), 8, 2, 6.0, 7.3);
  const std::size_t helix = find_stretch(b, residues, 10 + 5 * (number % 8), 10, 4, 5.6, 6.8);
  for (const int shift : {1, 2, 3}) {
    if (strand + 20 > residues.size()) break;
    Molecule target = b;
    slide(target, residues, strand, 8, shift);
    add("strand of 8 residues shifted by " + std::to_string(shift), "others than their partners", {a, target});
  }
  if (helix + 20 < residues.size()) {
    Molecule target = b;
    slide(target, residues, helix, 10, 2);
    add("helix of 10 residues shifted by 2", "others than their partners", {a, target});
    target = b;
    std::vector<bool> inside(b.residues.size(), false);
    for (std::size_t k = helix; k < helix + 10; ++k) inside[residues[k]] = true;
    const auto chosen = [&](std::size_t r) { return inside[r]; };
    const auto quarter = [&](std::size_t k) {
      return centre_of(b, [&](std::size_t r) { return r >= residues[k] && r < residues[k + 4]; });
    };
    turn(target, chosen, centre_of(b, chosen), quarter(helix + 6) - quarter(helix), 100);
    add("helix of 10 residues turned by 100 degrees", "others than their partners", {a, target});
  }
  const Molecule two_a = joined(a, b, a.residues[0].chain, 1000);
  add("break that both have alike: two chains of one name", "", {two_a, two_a});
  for (const std::size_t length : {3, 5, 9}) {
    const std::string size = std::to_string(length);
    add("peptides of " + size + " residues in another order", "=", peptides(a, length, false));
    add("peptides of " + size + " residues under each other's names", "=", peptides(a, length, true));
  }
  for (const std::size_t r : cofactors(a)) {
    const auto chosen = [&](std::size_t other) { return other == r; };
    Molecule target = a;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (static_cast<std::size_t>(a.atoms[i].residue) == r) target.positions[i] += Vec3d{2.0, 2.0, 2.07};
    }
    add("cofactor moved by 3.5 A", "lies otherwise in its site", {a, target});
    target = a;
    turn(target, chosen, centre_of(a, chosen), {0, 0, 1}, 180);
    add("cofactor turned by 180 degrees", "lies otherwise in its site", {a, target});
  }
  const Molecule dimer = joined(a, b, "second", 0);
  Molecule turned = dimer;
  const auto in_second = [&](std::size_t r) { return dimer.residues[r].chain == "second"; };
  turn(turned, in_second, centre_of(dimer, in_second), {1, 2, 3}, 20);
  add("chain of a dimer turned by 20 degrees", "by 20.0 degrees", {dimer, turned});
  return errors;
}

std::vector<std::string> warnings_of(const PlacedError& error, Alignment& alignment, double* seconds) {
  std::vector<std::string> texts;
  try {
    CompareOptions options;
    alignment = align(error.pair.first, error.pair.second, options).alignment;
    const std::clock_t start = std::clock();
    for (const Warning& warning : input_warnings(error.pair.first, error.pair.second, alignment))
      texts.push_back((warning.refuses ? "*" : "") + warning.text.plain());
    if (seconds != nullptr) *seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  } catch (const Error& refusal) {
    texts.push_back(std::string("*") + refusal.what());
  }
  return texts;
}

bool is_judged_rightly(const PlacedError& error, const Alignment& alignment, const std::vector<std::string>& warnings) {
  const bool refused =
      std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) { return text[0] == '*'; });
  if (error.text.empty()) return !refused;
  if (error.text == "=") return !refused && alignment.rmsd_A < 0.01;
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& text) { return text.find(error.text) != std::string::npos; });
}

}  // namespace espdiff_test
