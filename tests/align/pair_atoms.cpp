// pair_atoms.cpp: pairing of atoms, on made molecules and on real pairs.
#include "align/pair_atoms.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.h"
#include "made_molecule.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::MadeMolecule;
using espdiff_test::message_of;

namespace {

/// The pairs as "RES1:NAME=RES2:NAME" words.
std::string written(const AtomPairing& pairing, const Molecule& source, const Molecule& target) {
  const auto label = [](const Molecule& molecule, std::size_t i) {
    const Atom& atom = molecule.atoms[i];
    const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
    return residue.chain + std::to_string(residue.number) + ":" + atom.name;
  };
  std::string text;
  for (const auto& [a, b] : pairing.pairs)
    text += (text.empty() ? "" : " ") + label(source, a) + "=" + label(target, b);
  return text;
}

bool has_pair(const AtomPairing& pairing, const Molecule& source, const Molecule& target, const std::string& word) {
  return (" " + written(pairing, source, target) + " ").find(" " + word + " ") != std::string::npos;
}

const char* const kSequence = "MKTAYIAKQRQISFVKSHFSRQLEERLGLIEVQ";

}  // namespace

TEST_CASE("the same atoms in the same order pair one to one under any chain names") {
  MadeMolecule a, b;
  a.peptide("A", 1, "MKT");
  b.peptide("X", 1, "MKT");
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(pairing.method == "same order");
  CHECK(pairing.pairs.size() == 15);
  CHECK(pairing.n_aligned_residues == 3);
  CHECK(pairing.n_substituted_residues == 0);
  for (const auto& [i, j] : pairing.pairs) CHECK(i == j);
}

TEST_CASE("spellings of one residue or atom do not break the order") {
  MadeMolecule a, b;
  a.residue("", 1, "HSD", {"N", "HN", "CA", "1HB"});
  b.residue("A", 1, "HIS", {"N", "H", "CA", "HB1"});
  CHECK(pair_atoms(a.molecule, b.molecule).method == "same order");
}

TEST_CASE("with different residue numbers the order alone is not trusted") {
  MadeMolecule a, b;
  a.peptide("A", 1, "MKTAYIAK");
  b.peptide("A", 101, "MKTAYIAK");
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(pairing.method == "sequence alignment");
  CHECK(pairing.pairs.size() == a.molecule.size());
}

TEST_CASE("a substituted residue pairs backbone and C-beta only") {
  MadeMolecule a, b;
  a.peptide("A", 1, kSequence);
  b.peptide("A", 1, kSequence);
  a.residue("A", 34, "PHE", {"N", "H", "CA", "HA", "CB", "HB2", "CG", "CD1", "C", "O"});
  b.residue("A", 34, "TYR", {"N", "HN", "CA", "HA", "CB", "HB2", "CG", "CD1", "OH", "C", "OT1", "OT2"});
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(pairing.n_aligned_residues == 34);
  CHECK(pairing.n_substituted_residues == 1);
  CHECK(pairing.pairs.size() == 33 * 5 + 7);
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A34:H=A34:HN"));
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A34:O=A34:OT1"));
  CHECK_FALSE(has_pair(pairing, a.molecule, b.molecule, "A34:CG=A34:CG"));
}

TEST_CASE("a substituted residue pairs by its number where the files list their residues in different orders") {
  const std::vector<int> order = {7, 2, 11, 0, 9, 4, 13, 6, 1, 8, 3, 10, 5, 12, 14};
  const std::string sequence = "MKTAYIAKQRQISFV", mutant = "MKTAYIAWQRQISFV";
  MadeMolecule a, b;
  a.peptide("A", 1, sequence);
  for (const int place : order) b.peptide("A", 1 + place, mutant.substr(static_cast<std::size_t>(place), 1));
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(pairing.method == "names of residues");
  CHECK(pairing.n_aligned_residues == 15);
  CHECK(pairing.n_substituted_residues == 1);
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A8:CB=A8:CB"));
}

TEST_CASE("pairs ascend in the source atom and use each atom once") {
  MadeMolecule a, b;
  a.peptide("A", 1, "MKTAYIAKQRQ");
  b.peptide("A", 3, "TAYWAKQRQIS");
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(std::is_sorted(pairing.pairs.begin(), pairing.pairs.end()));
  std::vector<std::size_t> targets;
  for (std::size_t k = 0; k < pairing.pairs.size(); ++k) {
    targets.push_back(pairing.pairs[k].second);
    if (k > 0) CHECK(pairing.pairs[k].first > pairing.pairs[k - 1].first);
  }
  std::sort(targets.begin(), targets.end());
  CHECK(std::adjacent_find(targets.begin(), targets.end()) == targets.end());
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A3:CA=A3:CA"));
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A6:CB=A6:CB"));
}

// ubq.pdb against ubq.pqr of the real inputs: the same positions, named by CHARMM and by PDB.
TEST_CASE("hydrogens that two schemes number differently pair by name, then in order") {
  MadeMolecule a, b;
  a.residue("A", 1, "LEU", {"N", "CA", "HB1", "HB2", "CB", "C"});
  b.residue("A", 1, "LEU", {"N", "CA", "CB", "HB3", "HB2", "C"});
  CHECK(written(pair_atoms(a.molecule, b.molecule), a.molecule, b.molecule) ==
        "A1:N=A1:N A1:CA=A1:CA A1:HB1=A1:HB3 A1:HB2=A1:HB2 A1:CB=A1:CB A1:C=A1:C");
}

TEST_CASE("a hydrogen that only one side has does not shift the others") {
  MadeMolecule a, b;
  a.residue("A", 1, "LYS", {"N", "CA", "C", "NZ", "HZ1", "HZ2", "HZ3"});
  b.residue("A", 1, "LYN", {"N", "CA", "C", "NZ", "HZ2", "HZ3"});
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(pairing.n_substituted_residues == 0);
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A1:HZ2=A1:HZ2"));
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A1:HZ3=A1:HZ3"));
  CHECK(pairing.pairs.size() == 6);
}

TEST_CASE("atoms of one name pair in file order, as many as both sides have") {
  MadeMolecule a, b;
  a.residue("A", 1, "SER", {"N", "CA", "CB", "CB", "OG", "OG", "OG"});
  b.residue("A", 1, "SER", {"N", "CA", "CB", "OG", "OG"});
  CHECK(pair_atoms(a.molecule, b.molecule).pairs.size() == 5);
}

TEST_CASE("chains pair by sequence, and by name where sequences agree") {
  const std::string other = "GSHMWDPCLLNEVTYRWQGHPDFNACKEWG";
  MadeMolecule a, b;
  a.peptide("A", 1, kSequence);
  a.peptide("B", 1, other);
  b.peptide("H", 1, other.substr(2));
  b.peptide("L", 1, kSequence);
  AtomPairing pairing = pair_atoms(a.molecule, b.molecule);
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A1:CA=L1:CA"));
  CHECK(has_pair(pairing, a.molecule, b.molecule, "B3:CA=H1:CA"));
  CHECK(pairing.n_aligned_residues == 33 + 28);

  // A dimer whose chains lack some residues: the longer match is A with B, but the names decide otherwise.
  const std::string full = kSequence;
  MadeMolecule c, d;
  c.peptide("A", 1, full);
  c.peptide("B", 1, full.substr(0, 32));
  d.peptide("A", 1, full.substr(0, 32));
  d.peptide("B", 1, full);
  pairing = pair_atoms(c.molecule, d.molecule);
  CHECK(has_pair(pairing, c.molecule, d.molecule, "A5:CA=A5:CA"));
  CHECK(has_pair(pairing, c.molecule, d.molecule, "B5:CA=B5:CA"));
}

TEST_CASE("a file without chain names pairs with one that has them, with continuous or restarted numbers") {
  const std::string second = "GSHMWDPCLLNEVTYRWQGHPDFNACKEWG";
  MadeMolecule named, continued, restarted;
  named.peptide("A", 1, kSequence);
  named.peptide("B", 1, second);
  continued.peptide("", 1, kSequence + second);
  restarted.peptide("", 1, kSequence);
  restarted.peptide("", 1, second);
  named.residue("B", 31, "LYS", {"N", "CA"});  // breaks the same order
  for (const MadeMolecule* plain : {&continued, &restarted}) {
    CHECK(pair_atoms(named.molecule, plain->molecule).n_aligned_residues == 33 + 30);
    CHECK(pair_atoms(plain->molecule, named.molecule).n_aligned_residues == 33 + 30);
  }
}

TEST_CASE("by number, ligands and ions pair by name with the closest number, waters not at all") {
  MadeMolecule a, b;
  a.peptide("A", 1, "MKTAYIAKQRQ");
  a.residue("A", 201, "NA", {"NA"});
  a.residue("A", 301, "NA", {"NA"});
  a.residue("A", 401, "DMS", {"S", "O", "C1", "C2"});
  a.residue("A", 501, "HOH", {"O"});
  b.peptide("B", 1, "MKTAYIAKQRQI");
  b.residue("B", 205, "NA", {"NA"});
  b.residue("B", 301, "NA", {"NA"});
  b.residue("C", 401, "DSS", {"S", "O", "C1", "C2"});
  b.residue("C", 9, "DMS", {"S", "O", "C1"});
  b.residue("B", 501, "HOH", {"O"});
  const AtomPairing pairing = pair_atoms(a.molecule, b.molecule, PairOthers::kByNumber);
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A301:NA=B301:NA"));
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A201:NA=B205:NA"));
  CHECK(has_pair(pairing, a.molecule, b.molecule, "A401:S=C9:S"));
  CHECK(pairing.pairs.size() == 11 * 5 + 2 + 3);
}

TEST_CASE("molecules with nothing in common are refused, with counts, examples and the remedy") {
  MadeMolecule protein("prot.pqr"), ligand("lig.pqr");
  protein.peptide("A", 7, kSequence);
  ligand.residue("", 108, "DMS", {"S", "O", "C1", "C2"});
  CHECK_THROWS_AS(pair_atoms(protein.molecule, ligand.molecule), InputError);
  const std::string message = message_of([&] { pair_atoms(protein.molecule, ligand.molecule); });
  for (const char* part :
       {"only 0 atoms", "source prot.pqr: 165 atoms in 33 residues (such as MET 7 of chain A, LYS 8",
        "target lig.pqr: 4 atoms in 1 residues (such as DMS 108)", "no residues pair", "align none"}) {
    CHECK_MESSAGE(message.find(part) != std::string::npos, part, " not in: ", message);
  }
  CHECK(message.find('\n') == std::string::npos);
}

TEST_CASE("unrelated chains stay unpaired, though some alignment always exists") {
  MadeMolecule a, b;
  a.peptide("A", 1, kSequence);
  b.peptide("A", 1, "GGWPNDGHCGWPNDGHCPGWPNDCHGGWPNDGHC");
  // Short stretches like this occur in many chains.
  b.peptide("B", 1, "SHFSK");
  CHECK(message_of([&] { pair_atoms(a.molecule, b.molecule); }).find("no residues pair") != std::string::npos);
}

TEST_CASE("residues that correspond but share no atom names are named in the message") {
  MadeMolecule a, b;
  for (int i = 1; i <= 10; ++i) {
    a.residue("A", i, "TRP", {"Q1", "Q2"});
    b.residue("A", i, "TRP", {"B1", "B2"});
  }
  const std::string message = message_of([&] { pair_atoms(a.molecule, b.molecule); });
  CHECK(message.find(
            "10 residues pair, but hardly any of their atom names (Q1 of TRP 1 of chain A against B1 of TRP 1") !=
        std::string::npos);
}

TEST_CASE("the choice of atoms to align") {
  MadeMolecule a;
  a.peptide("A", 1, "MKT");
  a.residue("A", 9, "CA", {"CA"});
  const AtomPairing pairing = pair_atoms(a.molecule, a.molecule);
  CHECK(select_pairs(pairing, a.molecule, AlignAtoms::kAll).size() == 16);
  CHECK(select_pairs(pairing, a.molecule, AlignAtoms::kBackbone).size() == 12);
  CHECK(select_pairs(pairing, a.molecule, AlignAtoms::kCAlpha).size() == 3);  // not the calcium
  CHECK(select_pairs(pairing, a.molecule, AlignAtoms::kNone).empty());

  MadeMolecule rna;
  rna.residue("A", 1, "A", {"P", "O5*", "C5*", "C4*", "C3*", "O3*", "N9"});
  const AtomPairing own = pair_atoms(rna.molecule, rna.molecule);
  CHECK(select_pairs(own, rna.molecule, AlignAtoms::kBackbone).size() == 6);
  CHECK(message_of([&] { select_pairs(own, rna.molecule, AlignAtoms::kCAlpha); }) ==
        "align ca selects 0 of 7 paired atoms, at least 3 are needed; use align all (7 pairs), align backbone (6 "
        "pairs), "
        "or align none");
}

TEST_CASE("the choice of atoms survives writing and reading") {
  for (const AlignAtoms atoms : {AlignAtoms::kAll, AlignAtoms::kBackbone, AlignAtoms::kCAlpha, AlignAtoms::kNone}) {
    CHECK(parse_align_atoms(to_string(atoms)) == atoms);
  }
  CHECK(message_of([] { parse_align_atoms("CA"); }) ==
        "unknown choice of atoms to align 'CA'; use all, backbone, ca or none");
}

// They paired by their order in the file: 9.2 kT/e, called trustworthy, where nothing differs.
TEST_CASE("short chains pair by equal names, then by their arrangement, whatever their order in the file") {
  const auto peptides = [](const std::vector<std::pair<std::string, int>>& name_and_place) {
    MadeMolecule made;
    for (const auto& [name, place] : name_and_place) {
      const std::size_t first = made.molecule.size();
      made.peptide(name, 1, "AAAA");
      for (std::size_t i = first; i < made.molecule.size(); ++i) {
        const double t = static_cast<double>(i - first);
        made.molecule.positions[i] = {t, 8.0 * place * place, 0.1 * (i % 2 == 0 ? 1 : 0) + 5.0 * place};
      }
    }
    return made.molecule;
  };
  const Molecule abc = peptides({{"A", 0}, {"B", 1}, {"C", 3}});
  const auto chain_of_a = [&](const Molecule& target) {
    const AtomPairing pairing = pair_atoms(abc, target);
    CHECK(pairing.pairs.size() == abc.size());
    const Atom& partner = target.atoms[pairing.pairs.front().second];
    return target.residues[static_cast<std::size_t>(partner.residue)].chain;
  };
  CHECK(chain_of_a(peptides({{"B", 1}, {"A", 0}, {"C", 3}})) == "A");
  CHECK(chain_of_a(peptides({{"A", 1}, {"B", 0}, {"C", 3}})) == "B");
  CHECK(chain_of_a(peptides({{"C", 3}, {"A", 1}, {"B", 0}})) == "B");
}

TEST_CASE("more chains than can be compared with each other are refused by their number") {
  MadeMolecule many("many.pdb"), other("other.pdb");
  for (int i = 0; i < 10001; ++i) {
    many.residue(std::to_string(i), 1, "GLY", {"CA"});
    other.residue(std::to_string(i), 2, "GLY", {"CA"});
  }
  CHECK(message_of([&] { pair_atoms(many.molecule, other.molecule); }) ==
        "many.pdb has 10001 chains and other.pdb 10001, and each is compared with each (limit 1e8 pairs of chains); "
        "choose some by select, or give the residues of a chain one chain name and rising numbers");
}
