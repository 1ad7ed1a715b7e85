// caps.cpp: the charges of caps, and what stands for them in PDB2PQR's file.
#include "prepare/charges/caps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "align/protonation.h"
#include "align/residue_names.h"
#include "io/molecules/select_atoms.h"
#include "prepare/charges/modified_residues.h"
#include "prepare/charges/preparation.h"

namespace espdiff {
namespace {

/// Longer than a bond of carbon and nitrogen, shorter than any other distance.
constexpr double kCapBond_A = 1.8;
constexpr double kNitrogenHydrogen_A = 1.01;

struct Parameters {
  double charge, radius;
};

/// Net charges of the methyl groups, whose hydrogens may be missing; each of their hydrogens has its own.
struct CapCharges {
  Parameters acetyl_methyl, acetyl_hydrogen, carbon, oxygen;
  Parameters amide_nitrogen, amide_hydrogen, amide_methyl, methyl_hydrogen;
  Parameters end_nitrogen, end_hydrogen;  ///< of the amide without a methyl group
};

/// PARSE.DAT (the amide is that of asparagine), CHARMM.DAT with the patch CT2, and AMBER.DAT of PDB2PQR.
const CapCharges& charges_of(const std::string& force_field) {
  static const CapCharges parse{{0, 2.0},   {0, 0},   {0.55, 1.7}, {-0.55, 1.4}, {-0.4, 1.5},
                                {0.4, 1.0}, {0, 2.0}, {0, 0},      {-0.78, 1.5}, {0.39, 1.0}},
      charmm{{0, 2.06},      {0.09, 1.32}, {0.51, 2.0},  {-0.51, 1.7},  {-0.47, 1.85},
             {0.31, 0.2245}, {0.16, 2.06}, {0.09, 1.32}, {-0.62, 1.85}, {0.31, 0.2245}},
      amber{{-0.0293, 1.908}, {0.1123, 1.487}, {0.5972, 1.908}, {-0.5679, 1.6612}, {-0.4157, 1.824},
            {0.2719, 0.6},    {0.1438, 1.908}, {0.0976, 1.387}, {-0.463, 1.824},   {0.2315, 0.6}};
  return force_field == "parse" ? parse : force_field == "charmm" ? charmm : amber;
}

bool is_any_hydrogen(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

std::optional<std::size_t> cap_atom(const Molecule& molecule, const std::vector<std::size_t>& atoms,
                                    std::string_view name) {
  const auto found =
      std::find_if(atoms.begin(), atoms.end(), [&](std::size_t i) { return molecule.atoms[i].name == name; });
  return found == atoms.end() ? std::nullopt : std::optional<std::size_t>(*found);
}

bool are_bound(const Molecule& molecule, const std::vector<std::size_t>& atoms, const char* name,
               const std::vector<std::size_t>& others, const char* other) {
  const auto a = cap_atom(molecule, atoms, name), b = cap_atom(molecule, others, other);
  return a && b && norm(molecule.positions[*a] - molecule.positions[*b]) <= kCapBond_A;
}

Vec3d direction_of(const Vec3d& v) { return (1 / norm(v)) * v; }

/// Where the hydrogens of a cap's nitrogen lie: opposite to the methyl carbon and the carbonyl, or in its plane.
std::vector<Vec3d> places_at_nitrogen(const Molecule& cap, std::size_t nitrogen, const Molecule& molecule) {
  const Vec3d n = cap.positions[nitrogen];
  const auto nearest = [&](const Vec3d& place, const char* name) {
    const Vec3d* best = nullptr;
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      if (molecule.atoms[i].name != name || norm(molecule.positions[i] - place) > kCapBond_A) continue;
      if (best == nullptr || norm(molecule.positions[i] - place) < norm(*best - place)) best = &molecule.positions[i];
    }
    return best;
  };
  const Vec3d* const carbon = nearest(n, "C");
  if (carbon == nullptr) return {};
  const Vec3d to_carbon = direction_of(*carbon - n);
  if (cap.residues.front().name == "NME") {
    const Vec3d* const methyl = nearest(n, "CH3");
    if (methyl == nullptr) return {};
    return {n - kNitrogenHydrogen_A * direction_of(to_carbon + direction_of(*methyl - n))};
  }
  const Vec3d* const oxygen = nearest(*carbon, "O");
  if (oxygen == nullptr) return {};
  const Vec3d along = *oxygen - *carbon, across = direction_of(along - dot(along, to_carbon) * to_carbon);
  const double sine = std::sqrt(0.75);
  return {n - kNitrogenHydrogen_A * (0.5 * to_carbon + sine * across),
          n - kNitrogenHydrogen_A * (0.5 * to_carbon - sine * across)};
}

/// Takes the file's hydrogens at nitrogen if their number is right, otherwise makes them.
void complete_hydrogens(Molecule& cap, const Molecule& molecule) {
  const auto nitrogen = cap_atom(cap, atoms_of_residues(cap)[0], "N");
  if (!nitrogen) return;
  const std::vector<Vec3d> places = places_at_nitrogen(cap, *nitrogen, molecule);
  std::vector<bool> keep;
  for (std::size_t i = 0; i < cap.size(); ++i)
    keep.push_back(!is_any_hydrogen(cap.atoms[i]) ||
                   norm(cap.positions[i] - cap.positions[*nitrogen]) > kCapBond_A * 0.75);
  const auto n_given = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), false));
  if (places.empty() || n_given == places.size()) return;
  cap = keep_atoms(cap, keep);
  for (std::size_t k = 0; k < places.size(); ++k) {
    Atom hydrogen;
    hydrogen.name = places.size() == 1 ? "H" : "HN" + std::to_string(k + 1);
    hydrogen.element = "H";
    hydrogen.residue = 0;
    cap.atoms.push_back(hydrogen);
    cap.positions.push_back(places[k]);
    cap.radii.push_back(0);
    cap.charges.push_back(0);
  }
}

/// Sets the group of a heavy atom: its hydrogens, and what remains of its net charge.
void charge_group(Molecule& cap, const char* name, const Parameters& heavy, const Parameters& hydrogen,
                  bool heavy_is_group) {
  const auto center = cap_atom(cap, atoms_of_residues(cap)[0], name);
  if (!center) return;
  double rest = heavy.charge;
  for (std::size_t i = 0; i < cap.size(); ++i) {
    if (!is_any_hydrogen(cap.atoms[i]) || norm(cap.positions[i] - cap.positions[*center]) > kCapBond_A * 0.75) continue;
    cap.charges[i] = static_cast<float>(hydrogen.charge);
    cap.radii[i] = static_cast<float>(hydrogen.radius);
    rest -= heavy_is_group ? hydrogen.charge : 0;
  }
  cap.charges[*center] = static_cast<float>(rest);
  cap.radii[*center] = static_cast<float>(heavy.radius);
}

void charge_cap(Molecule& cap, const Molecule& molecule, const CapCharges& q) {
  const std::string name = cap.residues.front().name;
  if (name == "ACE") {
    charge_group(cap, "CH3", q.acetyl_methyl, q.acetyl_hydrogen, true);
    charge_group(cap, "C", q.carbon, q.acetyl_hydrogen, false);
    charge_group(cap, "O", q.oxygen, q.acetyl_hydrogen, false);
    return;
  }
  complete_hydrogens(cap, molecule);
  const bool is_end = name == "NH2";
  charge_group(cap, "N", is_end ? q.end_nitrogen : q.amide_nitrogen, is_end ? q.end_hydrogen : q.amide_hydrogen, false);
  charge_group(cap, "CH3", q.amide_methyl, q.methyl_hydrogen, true);
}

bool is_cap(const Molecule& molecule, std::size_t residue, GroupSource source) {
  return source == GroupSource::kCap || (source == GroupSource::kNone && is_cap_name(molecule.residues[residue].name));
}

}  // namespace

bool is_cap_name(const std::string& residue_name) {
  return residue_name == "ACE" || residue_name == "NME" || residue_name == "NH2";
}

void name_caps(Molecule& molecule, Preparation& preparation) {
  constexpr std::pair<std::string_view, const char*> kNames[] = {
      {"NHE", "NH2"}, {"NMA", "NME"}, {"N-M", "NME"}, {"CBX", "NME"}};
  for (Residue& residue : molecule.residues) {
    for (const auto& [name, usual] : kNames) {
      if (residue.name != name) continue;
      preparation.renamed.push_back(residue_in_words(residue) + " as " + usual);
      residue.name = usual;
      break;
    }
  }
  for (Atom& atom : molecule.atoms) {
    const std::string& name = molecule.residues[static_cast<std::size_t>(atom.residue)].name;
    if ((name == "ACE" || name == "NME") && (atom.name == "CA" || (atom.name == "C" && name == "NME")))
      atom.name = "CH3";
  }
}

bool is_bound_as_cap(const Molecule& molecule, std::size_t residue,
                     const std::vector<std::vector<std::size_t>>& atoms) {
  const auto is_amino_acid = [&](std::size_t r) { return cap_atom(molecule, atoms[r], "CA").has_value(); };
  return (residue > 0 && is_amino_acid(residue - 1) &&
          are_bound(molecule, atoms[residue], "N", atoms[residue - 1], "C")) ||
         (residue + 1 < atoms.size() && is_amino_acid(residue + 1) &&
          are_bound(molecule, atoms[residue], "C", atoms[residue + 1], "N"));
}

Molecule with_bare_caps(const Molecule& molecule, const std::vector<GroupSource>& sources) {
  Molecule bare = molecule;
  std::vector<bool> keep(molecule.size(), true);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const auto r = static_cast<std::size_t>(molecule.atoms[i].residue);
    if (!is_cap(molecule, r, sources[r])) continue;
    // The one name of no amino acid that PDB2PQR takes for a cap at both ends, and that has no charges.
    bare.residues[r].name = "NH2";
    bare.atoms[i].hetero = true;
    keep[i] = !is_any_hydrogen(molecule.atoms[i]);
  }
  return std::find(keep.begin(), keep.end(), false) == keep.end() ? bare : keep_atoms(bare, keep);
}

void charge_caps(Molecule& prepared, const Molecule& before, const std::vector<GroupSource>& sources,
                 const Molecule& modified, const std::string& force_field) {
  const auto same = [](const Residue& a, const Residue& b) {
    return a.chain == b.chain && a.number == b.number && a.insertion_code == b.insertion_code;
  };
  const auto atoms = atoms_of_residues(before), atoms_modified = atoms_of_residues(modified);
  Molecule caps;
  for (std::size_t r = 0; r < sources.size(); ++r) {
    if (atoms[r].empty() || !is_cap(before, r, sources[r])) continue;
    if (sources[r] == GroupSource::kNone) {
      Molecule cap = residue_alone(before, r, atoms[r]);
      charge_cap(cap, before, charges_of(force_field));
      append_residue(caps, cap);
      continue;
    }
    for (std::size_t m = 0; m < modified.residues.size(); ++m) {
      if (same(modified.residues[m], before.residues[r]))
        append_residue(caps, residue_alone(modified, m, atoms_modified[m]));
    }
  }
  if (caps.residues.empty()) return;
  // In the order of the file, where a cap stands before or behind its chain.
  const auto atoms_prepared = atoms_of_residues(prepared), atoms_caps = atoms_of_residues(caps);
  Molecule all;
  all.name = prepared.name;
  all.radii_origin = prepared.radii_origin;
  all.left_out = prepared.left_out;
  std::vector<bool> is_taken(prepared.residues.size(), false);
  const auto take = [&](std::size_t p) {
    if (is_taken[p]) return;
    is_taken[p] = true;
    append_residue(all, residue_alone(prepared, p, atoms_prepared[p]));
  };
  for (const Residue& residue : before.residues) {
    const auto is_same = [&](const Residue& other) { return same(other, residue); };
    const auto cap = std::find_if(caps.residues.begin(), caps.residues.end(), is_same);
    const auto found = std::find_if(prepared.residues.begin(), prepared.residues.end(), is_same);
    if (cap != caps.residues.end()) {
      const auto c = static_cast<std::size_t>(cap - caps.residues.begin());
      append_residue(all, residue_alone(caps, c, atoms_caps[c]));
      if (found != prepared.residues.end())
        is_taken[static_cast<std::size_t>(found - prepared.residues.begin())] = true;
    } else if (found != prepared.residues.end()) {
      take(static_cast<std::size_t>(found - prepared.residues.begin()));
    }
  }
  for (std::size_t p = 0; p < prepared.residues.size(); ++p) take(p);
  prepared = std::move(all);
}

}  // namespace espdiff
