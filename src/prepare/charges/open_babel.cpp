// open_babel.cpp: writes a ligand as PDB, runs Open Babel on it, and takes bonds, hydrogens and charges from its MOL2.
#include "prepare/charges/open_babel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "io/files/run_program.h"
#include "io/files/temporary_folder.h"
#include "io/molecules/elements.h"
#include "io/molecules/select_atoms.h"
#include "io/molecules/write_pdb.h"
#include "io/structures/read_mol2.h"
#include "prepare/charges/place_hydrogens.h"

namespace espdiff {

const char* const kOpenBabelRemedy = "install it (Debian: openbabel)";

namespace {

constexpr double kLigandTimeLimitSeconds = 300;
/// PDB and MOL2 have three and four decimals.
constexpr double kReturnedPlace_A = 0.01;

/// A name for the n-th added hydrogen that the residue does not have.
std::string hydrogen_name(std::set<std::string>& taken) {
  for (int n = 1;; ++n) {
    std::string name = "H" + std::to_string(n);
    if (taken.insert(name).second) return name;
  }
}

/// The ligand under a name and a number that fit the columns of PDB.
std::string ligand_as_pdb(Molecule ligand) {
  ligand.residues.front() = {"LIG", "A", 1, ' '};
  for (Atom& atom : ligand.atoms) atom.hetero = true;
  std::ostringstream text;
  write_pdb(text, ligand, std::vector<double>(ligand.size(), 0), {});
  return text.str();
}

/// A MOL2 file is the way on, or to leave the residue out, which is the next command.
template <class Error = InputError>
Error refused(const Molecule& ligand, const std::string& problem) {
  const std::string selection = "(" + ligand.residues.front().name + ")";
  return Error(Message(problem + "; give a MOL2 file of it with hydrogens (" + option("ligand", "FILE") +
                       "), or leave it out (" + option("leave-out", selection) + ")")
                   .set_next({"", {{"leave-out", selection}}}));
}

Mol2File run_open_babel(const std::string& program, const Molecule& ligand, const LigandBonds* bonds, double ph,
                        const std::string& what, const Progress& progress) {
  const TemporaryFolder folder;
  ProgramCall call;
  call.words = {program,
                bonds != nullptr ? "-imol" : "-ipdb",
                bonds != nullptr ? folder.write("ligand.mol", molfile_text(ligand, *bonds))
                                 : folder.write("ligand.pdb", ligand_as_pdb(ligand)),
                "-omol2",
                "-O",
                folder.file("ligand.mol2"),
                "-p",
                formatted("%g", ph),
                "--partialcharge",
                "gasteiger"};
  call.folder = folder.path();
  call.time_limit_s = kLigandTimeLimitSeconds;
  call.while_running = [&] { progress.check_cancelled(); };
  const ProgramResult result = run_program(call);
  std::error_code ignored;
  const auto n_bytes = std::filesystem::file_size(folder.file("ligand.mol2"), ignored);
  if (result.status != 0 || ignored || n_bytes == 0)
    throw refused<DeviceError>(ligand, what + ": Open Babel cannot prepare it");
  return read_mol2(folder.file("ligand.mol2"));
}

bool is_proton_of(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

/// Whether the file begins with the ligand's atoms, and adds hydrogens only.
bool continues(const Molecule& ligand, const Mol2File& mol2) {
  if (mol2.atoms.size() < ligand.size()) return false;
  for (std::size_t i = 0; i < mol2.atoms.size(); ++i) {
    const bool is_hydrogen = mol2.atoms[i].element == "H";
    if (i >= ligand.size() ? !is_hydrogen
                           : norm(mol2.atoms[i].position - ligand.positions[i]) > kReturnedPlace_A ||
                                 is_hydrogen != is_proton_of(ligand.atoms[i]))
      return false;
  }
  return true;
}

Molecule without_hydrogens(const Molecule& ligand) {
  std::vector<bool> keep;
  for (const Atom& atom : ligand.atoms) keep.push_back(!is_proton_of(atom));
  return keep_atoms(ligand, keep);
}

/// Takes a proton away from each of these atoms that has one; the others get equal shares of the charge that is left.
void deprotonate(const std::vector<bool>& atoms, Mol2File& mol2, std::vector<Mol2Bond>& bonds) {
  for (std::size_t h = mol2.atoms.size(); h-- > atoms.size();) {
    const auto bond = std::find_if(bonds.begin(), bonds.end(), [&](const Mol2Bond& b) { return b.a == h || b.b == h; });
    if (bond == bonds.end() || !atoms[std::min(bond->a, bond->b)]) continue;
    const double left = mol2.atoms[h].charge - 1;
    bonds.erase(bond);
    for (Mol2Bond& other : bonds) {
      if (other.a > h) --other.a;
      if (other.b > h) --other.b;
    }
    mol2.atoms.erase(mol2.atoms.begin() + static_cast<std::ptrdiff_t>(h));
    for (Mol2Atom& atom : mol2.atoms) atom.charge += left / static_cast<double>(mol2.atoms.size());
  }
}

/// The ligand with the hydrogens that the file adds, at places of our own.
ChargedLigand with_hydrogens(const Molecule& ligand, const LigandBonds* known, Mol2File mol2,
                             const Molecule& surroundings) {
  std::vector<Mol2Bond> bonds = read_mol2_bonds(mol2);
  if (known != nullptr) deprotonate(acylated_amidines(ligand, *known), mol2, bonds);
  drop_impossible_hydrogens(mol2, bonds, ligand.size());
  const std::vector<Vec3d> places = place_hydrogens(mol2, bonds, ligand.size(), surroundings);
  ChargedLigand charged;
  Molecule& molecule = charged.molecule;
  molecule = ligand;
  molecule.charges.clear();
  molecule.radii.clear();
  std::set<std::string> taken;
  for (const Atom& atom : ligand.atoms) taken.insert(atom.name);
  for (std::size_t i = 0; i < mol2.atoms.size(); ++i) {
    const Mol2Atom& atom = mol2.atoms[i];
    if (i >= ligand.size()) {
      molecule.atoms.push_back({hydrogen_name(taken), atom.element, 0, true});
      molecule.positions.push_back(places[i - ligand.size()]);
    }
    molecule.radii.push_back(static_cast<float>(element_radius(molecule.atoms[i].element)));
    molecule.charges.push_back(static_cast<float>(atom.charge));
    charged.net_charge += atom.charge;
  }
  charged.n_hydrogens_added = mol2.atoms.size() - ligand.size();
  return charged;
}

}  // namespace

std::string find_open_babel() {
  const char* const named = std::getenv("ESPDIFF_OBABEL");
  return find_program(named != nullptr && *named != '\0' ? named : "obabel");
}

LigandSupport ligand_support() {
  const std::string program = find_open_babel();
  if (program.empty())
    return {false, std::string("no program `obabel` on PATH, which charges ligands; ") + kOpenBabelRemedy};
  return {true, program + (has_monomer_library() ? ", with bonds of CCP4's library"
                                                 : std::string("; without CCP4's library of bonds it guesses them; ") +
                                                       kMonomerLibraryRemedy)};
}

ChargedLigand charge_by_open_babel(const Molecule& ligand, const Molecule& molecule, double ph,
                                   const LigandBonds* bonds, const Progress& progress) {
  const std::string what = molecule.name + ": " + residue_label(ligand.residues.front());
  const std::string program = find_open_babel();
  if (program.empty())
    throw DeviceError(what + ": Open Babel, which makes its hydrogens and charges, is not there; " + kOpenBabelRemedy);
  const Mol2File mol2 = run_open_babel(program, ligand, bonds, ph, what, progress);
  if (continues(ligand, mol2)) return with_hydrogens(ligand, bonds, mol2, molecule);
  const Molecule heavy = without_hydrogens(ligand);
  if (heavy.size() > 0 && heavy.size() < ligand.size()) {
    const Mol2File anew = run_open_babel(program, heavy, nullptr, ph, what, progress);
    if (continues(heavy, anew)) {
      ChargedLigand charged = with_hydrogens(heavy, nullptr, anew, molecule);
      charged.n_hydrogens_replaced = ligand.size() - heavy.size();
      return charged;
    }
  }
  throw refused(ligand, what + ": Open Babel returned other atoms than it got");
}

}  // namespace espdiff
