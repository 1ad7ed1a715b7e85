// ligand.cpp: matches residues with MOL2 files by atom names, and superposes the files on them.
#include "prepare/charges/ligand.h"

#include <algorithm>
#include <set>
#include <string>

#include "align/geometry/superpose.h"
#include "align/residue_names.h"
#include "base/error.h"
#include "io/molecules/molecule_builder.h"
#include "io/structures/read_component.h"

namespace espdiff {
namespace {

bool describes(const Mol2File& ligand, const Molecule& molecule, const std::vector<std::size_t>& atoms) {
  return std::all_of(atoms.begin(), atoms.end(), [&](std::size_t i) {
    const Atom& atom = molecule.atoms[i];
    if (atom.element == "H" || atom.element == "D") return true;
    return std::any_of(ligand.atoms.begin(), ligand.atoms.end(),
                       [&](const Mol2Atom& other) { return other.name == atom.name; });
  });
}

/// The file's hydrogens that the residue lacks, at the residue.
std::vector<Mol2Atom> missing_hydrogens(const Mol2File& ligand, const Molecule& molecule,
                                        const std::vector<std::size_t>& atoms) {
  std::set<std::string> names;
  std::vector<Vec3d> of_file, of_residue;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::size_t i : atoms) {
    names.insert(molecule.atoms[i].name);
    for (const Mol2Atom& other : ligand.atoms) {
      if (other.name != molecule.atoms[i].name) continue;
      pairs.emplace_back(of_file.size(), of_residue.size());
      of_file.push_back(other.position);
      of_residue.push_back(molecule.positions[i]);
    }
  }
  std::vector<Mol2Atom> missing;
  for (const Mol2Atom& atom : ligand.atoms) {
    if (atom.element == "H" && names.count(atom.name) == 0) missing.push_back(atom);
  }
  if (missing.empty()) return missing;
  const RigidTransform to_residue = superpose(of_file, of_residue, pairs).transform;
  for (Mol2Atom& atom : missing) atom.position = to_residue.apply(atom.position);
  return missing;
}

}  // namespace

std::vector<Mol2File> read_ligands(const std::vector<std::string>& paths) {
  std::vector<Mol2File> ligands;
  for (const std::string& path : paths) {
    if (!is_component_path(path)) ligands.push_back(read_mol2(path));
  }
  return ligands;
}

std::vector<std::int32_t> ligands_of_residues(const Molecule& molecule, const std::vector<Mol2File>& ligands) {
  const auto atoms = atoms_of_residues(molecule);
  const std::vector<ResidueKind> kinds = residue_kinds(molecule, atoms);
  std::vector<std::int32_t> ligand_of;
  for (std::size_t r = 0; r < atoms.size(); ++r) {
    const auto found = std::find_if(ligands.begin(), ligands.end(),
                                    [&](const Mol2File& ligand) { return describes(ligand, molecule, atoms[r]); });
    const bool is_other = kinds[r] == ResidueKind::kOther && !atoms[r].empty();
    ligand_of.push_back(is_other && found != ligands.end() ? static_cast<std::int32_t>(found - ligands.begin()) : -1);
  }
  return ligand_of;
}

Molecule add_ligand_hydrogens(const Molecule& molecule, const std::vector<Mol2File>& ligands,
                              const std::vector<std::int32_t>& ligand_of) {
  const auto atoms = atoms_of_residues(molecule);
  Molecule complete = molecule;
  for (std::size_t r = 0; r < ligand_of.size(); ++r) {
    if (ligand_of[r] < 0) continue;
    const Mol2File& ligand = ligands[static_cast<std::size_t>(ligand_of[r])];
    for (const Mol2Atom& atom : missing_hydrogens(ligand, molecule, atoms[r])) {
      if (complete.atoms.size() == kMostAtoms)
        throw InputError(ligand.path + ": with its hydrogens " + molecule.name + " has more than " +
                         std::to_string(kMostAtoms) + " atoms, which is the most that are read");
      complete.atoms.push_back({atom.name, atom.element, static_cast<std::int32_t>(r), true});
      complete.positions.push_back(atom.position);
      complete.radii.push_back(0);
    }
  }
  return complete;
}

}  // namespace espdiff
