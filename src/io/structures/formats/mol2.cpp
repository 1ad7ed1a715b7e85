// mol2.cpp: Tripos MOL2 files as a format of structures, with the charges that they have. Their molecules are models.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "io/molecules/molecule_builder.h"
#include "io/structures/read_mol2.h"
#include "io/structures/structure_format.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

/// "ALA" and 12 of "ALA12"; the substructure's own number where the name has none, or is one of other digits ("DA5" is
/// a nucleotide's 5' end, and "0SB" a residue).
struct Mol2Residue {
  std::string name;
  int number = 0;
};

Mol2Residue residue_of(const Mol2Atom& atom) {
  constexpr std::size_t kMostDigits = 9;
  const std::string& whole = atom.substructure_name;
  const std::size_t end = whole.find_last_not_of("0123456789") + 1, n_digits = whole.size() - end;
  Mol2Residue residue{whole.empty() || whole == "****" ? "LIG" : whole, atom.substructure};
  if (n_digits == 0 || n_digits > kMostDigits || end == 0) return residue;
  const std::string name = whole.substr(0, end);
  const int number = std::stoi(whole.substr(end));
  const bool is_end = number == 3 || number == 5;
  if (number == atom.substructure || (is_standard_residue(name) && !(is_end && name.size() < 3))) return {name, number};
  return residue;
}

/// The element of Tripos' types ("C.ar", "Cl"). Those of force fields ("ca", "HC") say less than the atom's name.
std::string element_of(const Mol2Atom& atom) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const std::string& e = atom.element;
  const bool is_symbol =
      !e.empty() && e[0] >= 'A' && e[0] <= 'Z' && (e.size() == 1 || (e.size() == 2 && is_lower(e[1])));
  return is_symbol && e != "Du" ? e : std::string();
}

/// Files of small molecules repeat names ("C", "C", "H"). Within such a residue atoms are named by element and place.
void make_names_unique(std::vector<AtomEntry>& atoms) {
  std::map<std::pair<int, std::string>, std::vector<std::size_t>> residues;
  for (std::size_t i = 0; i < atoms.size(); ++i)
    residues[{atoms[i].residue_number, atoms[i].residue_name + '\n' + atoms[i].chain}].push_back(i);
  for (const auto& [name, list] : residues) {
    std::set<std::string> names;
    for (const std::size_t i : list) names.insert(atoms[i].name);
    if (names.size() == list.size()) continue;
    for (std::size_t k = 0; k < list.size(); ++k) {
      AtomEntry& atom = atoms[list[k]];
      atom.name = (atom.element.empty() ? atom.name : atom.element) + std::to_string(k + 1);
    }
  }
}

std::vector<AtomEntry> entries_of(const Mol2Molecule& molecule) {
  std::vector<AtomEntry> entries;
  for (const Mol2Atom& atom : molecule.atoms) {
    const Mol2Residue residue = residue_of(atom);
    const auto chain = molecule.chains.find(atom.substructure);
    AtomEntry entry;
    entry.name = atom.name;
    entry.element = element_of(atom);
    entry.residue_name = residue.name;
    entry.residue_number = residue.number;
    if (chain != molecule.chains.end()) entry.chain = chain->second;
    entry.position = atom.position;
    entry.line = atom.line;
    entries.push_back(std::move(entry));
  }
  make_names_unique(entries);
  return entries;
}

/// Whether each atom has a charge, and not all are zero, which is how some programs write that there are none.
bool has_charges(const Mol2Molecule& molecule) {
  const auto has = [](const Mol2Atom& atom) { return atom.has_charge; };
  const auto is_charged = [](const Mol2Atom& atom) { return atom.charge != 0; };
  return molecule.has_charges && std::all_of(molecule.atoms.begin(), molecule.atoms.end(), has) &&
         std::any_of(molecule.atoms.begin(), molecule.atoms.end(), is_charged);
}

class Mol2Models : public StructureModels {
 public:
  explicit Mol2Models(FileContent file) : path_(file.path) {
    unify_line_ends(file.content);
    molecules_ = mol2_molecules(path_, file.content, file.content.size());
  }

  int n_models() const override { return static_cast<int>(molecules_.size()); }

  long line_of(int model, const Residue& residue) const override {
    for (const Mol2Atom& atom : at(model).atoms) {
      const Mol2Residue own = residue_of(atom);
      if (own.name == residue.name && own.number == residue.number) return atom.line;
    }
    return 0;
  }

  Molecule read(const StructureOptions& options) const override {
    if (!options.assembly.empty())
      throw InputError(path_ + ": is a MOL2 file, which describes no assemblies; leave " + option("assembly") +
                       " out, or give the PDB or mmCIF entry");
    const Mol2Molecule& model = at(options.model);
    const bool is_charged = has_charges(model);
    MoleculeBuilder builder(path_, options);
    const std::vector<AtomEntry> entries = entries_of(model);
    std::vector<float> charges;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!builder.wants(entries[i].residue_name, false)) continue;
      builder.add(entries[i]);
      if (is_charged) charges.push_back(charge_of(model.atoms[i]));
    }
    Molecule molecule = builder.finish();
    molecule.charges = std::move(charges);
    return molecule;
  }

 private:
  const Mol2Molecule& at(int model) const {
    if (model >= 1 && model <= n_models()) return molecules_[static_cast<std::size_t>(model - 1)];
    throw InputError(path_ + ": there is no model " + std::to_string(model) + "; the file has " +
                     std::to_string(n_models()));
  }

  float charge_of(const Mol2Atom& atom) const {
    if (std::abs(atom.charge) <= kLargestCharge) return static_cast<float>(atom.charge);
    throw FormatError(path_, atom.line,
                      "charge of atom '" + atom.name + "' is " + formatted(atom.charge) +
                          "; elementary charges between -1e6 and 1e6 were expected");
  }

  std::string path_;
  std::vector<Mol2Molecule> molecules_;
};

}  // namespace

StructureFormat mol2_format() {
  return {"MOL2", [](std::string_view, FileKind kind) { return kind == FileKind::kMol2; },
          [](FileContent file) -> std::unique_ptr<StructureModels> {
            return std::make_unique<Mol2Models>(std::move(file));
          }};
}

}  // namespace espdiff
