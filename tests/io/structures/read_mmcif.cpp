// read_mmcif.cpp: mmCIF files through gemmi.
#include "base/error.h"
#include "io/structures/structure_file.h"
#include "io/structures/structure_text.h"
#include "support/test_data.h"

#ifdef ESPDIFF_HAVE_GEMMI

using namespace espdiff;
using namespace espdiff_test;

namespace {

const std::string kMmcifHead =
    "data_TEST\n#\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
    "_atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.pdbx_PDB_ins_code\n"
    "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n"
    "_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n_atom_site.pdbx_PDB_model_num\n";

const std::string kRows =
    "ATOM 1 N N . ALA A ? 1.0 2.0 3.0 1.0 5 7 X 1\n"
    "ATOM 2 C CA A ALA A ? 1.5 2.0 3.0 0.4 5 7 X 1\n"
    "ATOM 3 C CA B ALA A ? 1.6 2.0 3.0 0.6 5 7 X 1\n"
    "ATOM 4 N N . GLY B Q 4.0 2.0 3.0 1.0 5 8 Y 1\n"
    "HETATM 5 ZN ZN . ZN C ? 5.0 2.0 3.0 1.0 5 9 X 1\n"
    "HETATM 6 O O . HOH D ? 6.0 2.0 3.0 1.0 5 10 X 1\n"
    "ATOM 1 N N . ALA A ? 11.0 2.0 3.0 1.0 5 7 X 2\n";

Molecule molecule_of_mmcif(const std::string& text, const StructureOptions& options = {}) {
  return structure_of("a.cif", text, options);
}

std::string mmcif_error(const std::string& text) { return structure_error("a.cif", text); }

}  // namespace

TEST_CASE("read_mmcif: PyMOL's files, without numbers of authors, have those of the sequence") {
  std::string head = kMmcifHead;
  head.replace(head.find("auth_seq_id"), 11, "label_seq_id");
  const Molecule m = molecule_of_mmcif(head + kRows);
  REQUIRE(m.size() == 4);
  CHECK(m.residues[0].number == 7);
  CHECK(m.residues[1].number == 8);
  CHECK(m.residues[1].chain == "Y");
  head.replace(head.find("_atom_site.label_seq_id\n"), 24, "_atom_site.other\n");
  CHECK(mmcif_error(head + kRows).find("mmCIF without the column _atom_site.auth_seq_id") != std::string::npos);
}

TEST_CASE("read_mmcif: author's names, file order, locations, models, filters") {
  const Molecule m = molecule_of_mmcif(kMmcifHead + kRows);
  REQUIRE(m.size() == 4);
  CHECK(m.positions[0] == Vec3d{1, 2, 3});
  CHECK(m.positions[1].x == 1.6);
  CHECK(m.positions[2].x == 4.0);
  CHECK(m.positions[3].x == 5.0);
  REQUIRE(m.residues.size() == 3);
  CHECK(m.residues[0].chain == "X");
  CHECK(m.residues[0].number == 7);
  CHECK(m.residues[0].insertion_code == ' ');
  CHECK(m.residues[1].insertion_code == 'Q');
  CHECK(m.atoms[3].element == "Zn");
  CHECK(m.atoms[3].hetero);
  CHECK(m.radii_origin == ValueOrigin::kElement);
  StructureOptions options;
  options.model = 2;
  CHECK(molecule_of_mmcif(kMmcifHead + kRows, options).positions[0].x == 11.0);
  options.model = 1;
  options.include_hetero = false;
  CHECK(molecule_of_mmcif(kMmcifHead + kRows, options).size() == 3);
  const ScratchFolder scratch;
  CHECK(count_models(scratch.write("a.cif", kMmcifHead + kRows)) == 2);
}

TEST_CASE("read_mmcif: coordinates that are no numbers are refused with line and value") {
  CHECK(mmcif_error(kMmcifHead +
                    "ATOM 1 N N . ALA A ? 1.0 2.0 3.0 1.0 5 7 X 1\nATOM 2 C CA . ALA A ? 1.5 nan 3.0 1.0 5 7 X 1\n") ==
        "a.cif:21: _atom_site.Cartn_y of atom 2 is 'nan'; a finite number was expected");
  CHECK(mmcif_error(kMmcifHead + "ATOM 1 N N . ALA A ? 1.0 2.0 ? 1.0 5 7 X 1\n") ==
        "a.cif:20: _atom_site.Cartn_z of atom 1 is '?'; a finite number was expected");
}

TEST_CASE("read_mmcif: errors of gemmi's are told in our words, with the line") {
  const std::string row = "ATOM 1 N N . ALA A ? 1.0 2.0 3.0 1.0 5 7 X 1\n", head = "a.cif:2: not valid CIF: ";
  CHECK(mmcif_error("data_X\n_a.b 'x\n") == head + "a value in single quotes is not closed on its line");
  CHECK(mmcif_error("data_X\n_a.b \"x\n") == head + "a value in double quotes is not closed on its line");
  CHECK(mmcif_error("data_X\n_a.b\n;x\n") ==
        "a.cif:4: not valid CIF: a text field is not closed by a line that begins with ';'");
  CHECK(mmcif_error("data_X\nsave_ _a.b 1\n") == head + "a save frame has no name");
  CHECK(mmcif_error("data_X\nx\n") == head + "a tag with its value, or a loop, was expected");
  CHECK(mmcif_error("data_X\n_a.b 1\n_a.b 2\n") == "a.cif:3: not valid CIF: the tag '_a.b' is given twice");
  CHECK(mmcif_error("data_X\n_a.b 1\ndata_X\n_a.b 2\n") == "a.cif: not valid CIF: two data blocks are named 'X'");
  CHECK(mmcif_error(kMmcifHead + row + "data_Y\n_atom_site.id 1\n") ==
        "a.cif: the mmCIF cannot be read: two data blocks have atoms; keep one");
  std::string coded = kMmcifHead + row;
  CHECK(mmcif_error(coded.replace(coded.rfind(" . ALA"), 3, " AB ")) ==
        "a.cif: the mmCIF cannot be read: an alternate location or insertion code is 'AB'; one letter was expected");
  std::string without = kMmcifHead + row;
  CHECK(mmcif_error(without.replace(without.find("label_comp_id"), 13, "label_comp_ix")) ==
        "a.cif: the mmCIF cannot be read: the column _atom_site.label_comp_id is missing");
}

TEST_CASE("read_mmcif: bad syntax, no atoms, missing columns, missing model") {
  CHECK(mmcif_error(kMmcifHead + "ATOM 1 N N\n") ==
        "a.cif:3: not valid CIF: the values of a loop do not fill its columns");
  CHECK(mmcif_error("data_X\n_a.b 1\n_c.d\n") == "a.cif:3: not valid CIF: _c.d has no value");
  CHECK(
      mmcif_error("data_X\n_cell.length_a 1\n") ==
      "a.cif: mmCIF without the column _atom_site.id (no atoms at all); give a macromolecular mmCIF with coordinates");
  const ScratchFolder folder;
  const std::string path = folder.write("small.cif", "data_X\nloop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.25\n");
  CHECK(message_of([&] { read_structure(path); }) ==
        path + ": is the CIF of a crystal of small molecules, whose atoms lie in fractions of its cell; `obabel " +
            path + " -O " + folder.file("small.mol2") + "` writes them with charges; give that");
  CHECK(
      mmcif_error("data_ATP\nloop_\n_chem_comp_atom.comp_id\n_chem_comp_atom.atom_id\nATP PG\n") ==
      "a.cif: describes chemical components (_chem_comp_atom), no structure; give a structure that contains them, with "
      "this file for their bonds (ligand FILE), or a MOL2 file: `obabel LIGAND.sdf -O LIGAND.mol2` writes one");
  std::string without = kMmcifHead + "ATOM 1 N N . ALA A ? 1.0 2.0 3.0 1.0 5 7 X 1\n";
  without.replace(without.find("auth_seq_id"), 11, "auth_seq_ix");
  CHECK(mmcif_error(without).find("a.cif: mmCIF without the column _atom_site.auth_seq_id;") == 0);
  CHECK(mmcif_error(kMmcifHead + "ATOM 1 N N . ALA A ? 1.0 2.0 3.0 1.0 5 7a1b X 1\n") ==
        "a.cif:20: _atom_site.auth_seq_id of atom 1 is '7a1b'; an integer below 2^31 in size was expected");
  StructureOptions options;
  options.model = 3;
  CHECK(message_of([&] {
          molecule_of_mmcif(kMmcifHead + kRows, options);
        }).find("a.cif: model 3 was asked for, but the file has models 1 to 2") != std::string::npos);
}

TEST_CASE("read_mmcif: columns that may be missing: occupancy, alternate locations, B factors") {
  std::string head = kMmcifHead;
  for (const char* column : {"_atom_site.label_alt_id\n", "_atom_site.occupancy\n", "_atom_site.B_iso_or_equiv\n"})
    head.erase(head.find(column), std::string(column).size());
  const Molecule m = molecule_of_mmcif(head +
                                       "ATOM 1 N N ALA A ? 1.0 2.0 3.0 7 X 1\nATOM 2 C CA ALA A ? 1.5 2.0 3.0 7 X 1\n"
                                       "ATOM 1 N N ALA A ? 11.0 2.0 3.0 7 X 2\n");
  REQUIRE(m.size() == 2);
  CHECK(m.positions[1] == Vec3d{1.5, 2, 3});
  CHECK(m.atoms[1].name == "CA");
  CHECK(m.residues[0].number == 7);
  std::string without_occupancy = kMmcifHead;
  without_occupancy.erase(without_occupancy.find("_atom_site.occupancy\n"), 21);
  // Two locations without an occupancy are equal: the first counts.
  CHECK(molecule_of_mmcif(without_occupancy +
                          "ATOM 1 C CA A ALA A ? 1.5 2.0 3.0 5 7 X 1\nATOM 2 C CA B ALA A ? 1.6 2.0 3.0 5 7 X 1\n")
            .positions == std::vector<Vec3d>{{1.5, 2, 3}});
}

TEST_CASE("read_mmcif: a mistake in another category does no harm") {
  CHECK(molecule_of_mmcif(kMmcifHead + kRows +
                          "loop_\n_struct_conn.id\n_struct_conn.conn_type_id\n_struct_conn.ptnr1_label_comp_id\n"
                          "_struct_conn.ptnr2_label_comp_id\n_struct_conn.ptnr1_label_atom_id\n"
                          "_struct_conn.ptnr2_label_atom_id\n a b c d e f\n")
            .size() == 4);
}

TEST_CASE("read_mmcif: 1TCA, also under the name of a PDB file") {
  // awk '/^(ATOM|HETATM)/ && $6!="HOH"{n++; s+=$11} END{printf "%d %.3f\n",n,s}' 1TCA.cif
  for (const char* name : {"calb/1TCA.cif", "calb/1TCA.pdb"}) {
    const auto path = real_input(name);
    if (!path) return;
    const Molecule m = read_structure(*path);
    CHECK(m.size() == 2352);
    double x = 0;
    for (const Vec3d& p : m.positions) x += p.x;
    CHECK(x == doctest::Approx(-29201.329).epsilon(1e-9));
    CHECK(m.positions[0] == Vec3d{-19.022, -0.107, 12.906});
    CHECK(m.residues[0].name == "LEU");
    CHECK(m.residues[0].chain == "A");
  }
}

TEST_CASE("read_mmcif: the same entry as PDB gives the same atoms") {
  const auto cif = real_input("calb/1TCA.cif");
  if (!cif) return;
  const Molecule a = read_structure(*cif);
  const Molecule b = read_structure(*real_input("calb/1TCA_from_cif.pdb"));
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a.atoms[i].name == b.atoms[i].name);
    CHECK(a.atoms[i].element == b.atoms[i].element);
    CHECK(a.radii[i] == b.radii[i]);
    CHECK(norm(a.positions[i] - b.positions[i]) < 1e-9);
  }
}
#endif
