// aromatic.cpp: the field of aromatic rings.
#include <set>
#include <string>

#include "align/residue_names.h"
#include "field/field.h"

namespace espdiff {
namespace {

const std::set<std::string>& ring_atoms(char letter) {
  static const std::set<std::string> none, six = {"CG", "CD1", "CD2", "CE1", "CE2", "CZ"},
                                           his = {"CG", "ND1", "CD2", "CE1", "NE2"},
                                           trp = {"CG", "CD1", "CD2", "NE1", "CE2", "CE3", "CZ2", "CZ3", "CH2"},
                                           base = {"N1", "C2", "N3", "C4", "C5", "C6", "N7", "C8", "N9"};
  switch (letter) {
    case 'F':
    case 'Y': return six;
    case 'H': return his;
    case 'W': return trp;
    case 'a':
    case 'c':
    case 'g':
    case 't':
    case 'u': return base;
    default: return none;
  }
}

/// A ring's hydrogens count with it.
std::vector<float> values_of(const Molecule& molecule) {
  std::vector<float> values;
  for (const Atom& atom : molecule.atoms) {
    const char letter = residue_letter(molecule.residues[static_cast<std::size_t>(atom.residue)].name);
    const bool is_in_ring = ring_atoms(letter).count(normalized_atom_name(atom.name, letter)) > 0;
    values.push_back(is_hydrogen(atom) ? kNoValue : is_in_ring ? 1.0F : 0.0F);
  }
  give_to_hydrogens(molecule, values);
  return values;
}

}  // namespace

FieldKind aromatic_kind() {
  return kind_of_atoms({"aromatic", "Aromatic rings", "", false},
                       "Share of the density around a point that is of aromatic rings, of amino acids and nucleotides",
                       "IUPAC-IUB, Abbreviations and symbols for the description of the conformation of polypeptide "
                       "chains, Biochemistry 9, 3471 (1970), for the atoms' names",
                       values_of);
}

}  // namespace espdiff
