// read_pdb.cpp: PDB files through gemmi: alternate locations, short and broken lines, models, elements.
#include "base/error.h"
#include "io/structures/structure_file.h"
#include "io/structures/structure_text.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

#ifndef ESPDIFF_HAVE_GEMMI
TEST_CASE("read_pdb: a build without gemmi says so") {
  const ScratchFolder scratch;
  const std::string path =
      scratch.write("a.pdb", "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n");
  CHECK(message_of([&] { read_structure(path); }) ==
        path +
            ": this is a PDB file, and this build lacks the PDB and mmCIF reader; build espdiff with gemmi (Debian: "
            "gemmi-dev), or give a PQR file");
}
#else

namespace {

struct PdbLine {
  const char* record = "ATOM";
  const char* name = " CA ";
  char location = ' ';
  const char* residue = "ALA ";
  char chain = 'A';
  int number = 1;
  char insertion = ' ';
  double x = 0;
  double occupancy = 1;
  const char* element = " C";
};

std::string text_of(const PdbLine& a) {
  char line[100];
  std::snprintf(line, sizeof line, "%-6s%5d %4s%c%4s%c%4d%c   %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n", a.record, 7,
                a.name, a.location, a.residue, a.chain, a.number, a.insertion, a.x, 2.0, 3.0, a.occupancy, 5.0,
                a.element);
  return line;
}

Molecule molecule_of_pdb(const std::string& text, const StructureOptions& options = {}) {
  return structure_of("a.pdb", text, options);
}

std::string pdb_error(const std::string& text) { return structure_error("a.pdb", text); }

std::vector<double> xs(const Molecule& m) {
  std::vector<double> x;
  for (const Vec3d& p : m.positions) x.push_back(p.x);
  return x;
}

using Xs = std::vector<double>;

}  // namespace

TEST_CASE("read_pdb: one atom, all of it") {
  const Molecule m = molecule_of_pdb(text_of({"HETATM", "FE  ", ' ', "HEM ", 'B', -3, 'C', -12.5, 1, "FE"}));
  REQUIRE(m.size() == 1);
  CHECK(m.positions[0] == Vec3d{-12.5, 2, 3});
  CHECK(m.atoms[0].name == "FE");
  CHECK(m.atoms[0].element == "Fe");
  CHECK(m.atoms[0].hetero);
  CHECK(m.residues[0].name == "HEM");
  CHECK(m.residues[0].chain == "B");
  CHECK(m.residues[0].number == -3);
  CHECK(m.residues[0].insertion_code == 'C');
  CHECK(m.radii[0] == 2.44F);
  CHECK(m.radii_origin == ValueOrigin::kElement);
  CHECK(m.charges.empty());
}

TEST_CASE("read_pdb: the location of highest occupancy, the first on ties, other atoms untouched") {
  const std::string shared = text_of({"ATOM", " N  ", ' ', "SER ", 'A', 1, ' ', 1});
  const auto pair = [](double occupancy_a, double occupancy_b) {
    return text_of({"ATOM", " CB ", 'A', "SER ", 'A', 1, ' ', 2, occupancy_a}) +
           text_of({"ATOM", " CB ", 'B', "SER ", 'A', 1, ' ', 3, occupancy_b}) +
           text_of({"ATOM", " OG ", 'A', "SER ", 'A', 1, ' ', 4, occupancy_a, " O"}) +
           text_of({"ATOM", " OG ", 'B', "SER ", 'A', 1, ' ', 5, occupancy_b, " O"});
  };
  CHECK(xs(molecule_of_pdb(shared + pair(0.6, 0.4))) == Xs{1, 2, 4});
  CHECK(xs(molecule_of_pdb(shared + pair(0.4, 0.6))) == Xs{1, 3, 5});
  CHECK(xs(molecule_of_pdb(shared + pair(0.5, 0.5))) == Xs{1, 2, 4});
}

TEST_CASE("read_pdb: locations are chosen per residue, not per atom, and no atom gets lost") {
  // B wins by its mean; CG has no B and keeps its best.
  const std::string text = text_of({"ATOM", " CB ", 'A', "SER ", 'A', 1, ' ', 1, 0.5}) +
                           text_of({"ATOM", " CB ", 'B', "SER ", 'A', 1, ' ', 2, 0.4}) +
                           text_of({"ATOM", " OG ", 'A', "SER ", 'A', 1, ' ', 3, 0.1}) +
                           text_of({"ATOM", " OG ", 'B', "SER ", 'A', 1, ' ', 4, 0.9}) +
                           text_of({"ATOM", " CG ", 'A', "SER ", 'A', 1, ' ', 5, 0.1}) +
                           text_of({"ATOM", " CG ", 'C', "SER ", 'A', 1, ' ', 6, 0.2});
  CHECK(xs(molecule_of_pdb(text)) == Xs{2, 4, 6});
}

TEST_CASE("read_pdb: a residue that is another in part of the crystal") {
  const std::string text = text_of({"ATOM", " N  ", 'A', "SER ", 'A', 1, ' ', 1, 0.3}) +
                           text_of({"ATOM", " N  ", 'B', "THR ", 'A', 1, ' ', 2, 0.7}) +
                           text_of({"ATOM", " CA ", 'A', "SER ", 'A', 1, ' ', 3, 0.3}) +
                           text_of({"ATOM", " CA ", 'B', "THR ", 'A', 1, ' ', 4, 0.7});
  const Molecule m = molecule_of_pdb(text);
  CHECK(xs(m) == Xs{2, 4});
  REQUIRE(m.residues.size() == 1);
  CHECK(m.residues[0].name == "THR");
}

TEST_CASE("read_pdb: an atom given twice at one place counts once, two atoms of one name count twice") {
  const PdbLine atom;
  PdbLine moved = atom;
  moved.x = 1;
  CHECK(xs(molecule_of_pdb(text_of(atom) + text_of(atom) + text_of(moved))) == Xs{0, 1});
}

TEST_CASE("read_pdb: file order stays, though gemmi gathers residues") {
  const std::string text = text_of({"ATOM", " N  ", ' ', "SER ", 'A', 1, ' ', 1}) +
                           text_of({"ATOM", " N  ", ' ', "SER ", 'B', 1, ' ', 2}) +
                           text_of({"ATOM", " H  ", ' ', "SER ", 'A', 1, ' ', 3, 1, " H"});
  const Molecule m = molecule_of_pdb(text);
  CHECK(xs(m) == Xs{1, 2, 3});
  CHECK(m.atoms[2].residue == 0);
  CHECK(m.residues.size() == 2);
}

TEST_CASE("read_pdb: more atoms than five digits count") {
  std::string text;
  for (int i = 0; i < 100010; ++i) {
    text += text_of({"ATOM", " CA ", ' ', "ALA ", static_cast<char>('A' + i / 9999), i % 9999, ' ', i * 0.01});
  }
  const Molecule m = molecule_of_pdb(text);
  REQUIRE(m.size() == 100010);
  CHECK(m.positions[100000].x == 1000.0);
  CHECK(m.positions[100009].x == 1000.09);
}

TEST_CASE("read_pdb: elements from their columns, else from the name and residue") {
  const auto element = [](const PdbLine& line) { return molecule_of_pdb(text_of(line)).atoms[0].element; };
  CHECK(element({"ATOM", "CA  ", ' ', "ALA ", 'A', 1, ' ', 0, 1, "  "}) == "C");  // name in the wrong column
  CHECK(element({"HETATM", "CA  ", ' ', " CA ", 'A', 1, ' ', 0, 1, "  "}) == "Ca");
  CHECK(element({"ATOM", " CA ", ' ', "ALA ", 'A', 1, ' ', 0, 1, "CA"}) == "Ca");  // the columns win
  CHECK(element({"ATOM", "HG11", ' ', "VAL ", 'A', 1, ' ', 0, 1, "  "}) == "H");
  CHECK(element({"ATOM", " D1 ", ' ', "LIG ", 'A', 1, ' ', 0, 1, " D"}) == "D");
}

TEST_CASE("read_pdb: residue names of four letters, chain names of two") {
  const Molecule m = molecule_of_pdb(text_of({"ATOM", " P  ", ' ', "POPC", 'M', 1, ' ', 0, 1, " P"}) +
                                     text_of({"ATOM", " CA ", ' ', "ALAB", 'C', 1, ' ', 0, 1, " C"}) +
                                     text_of({"ATOM", " OH2", ' ', "TIP3", 'W', 1, ' ', 0, 1, " O"}));
  REQUIRE(m.residues.size() == 2);
  CHECK(m.residues[0].name == "POPC");
  CHECK(m.residues[0].chain == "M");
  CHECK(m.residues[1].name == "ALA");
  CHECK(m.residues[1].chain == "BC");
}

TEST_CASE("read_pdb: lines that gemmi would read as something else are refused") {
  const std::string good = text_of({});
  const auto with = [&](std::size_t column, const std::string& field) {
    std::string line = good;
    return "REMARK\n" + line.replace(column - 1, field.size(), field);
  };
  CHECK(
      pdb_error(with(31, "     nan")) ==
      "a.pdb:2: the x coordinate (columns 31 to 38) is 'nan'; a finite number was expected; are the columns shifted?");
  CHECK(pdb_error(with(39, "********")).find("a.pdb:2: the y coordinate (columns 39 to 46) is '********'") == 0);
  CHECK(pdb_error(with(47, "        ")).find("a.pdb:2: the z coordinate (columns 47 to 54) is ''") == 0);
  CHECK(pdb_error(with(30, " 1.000 2.000")).find("a.pdb:2: the x coordinate") == 0);
  CHECK(pdb_error(with(23, "****")) ==
        "a.pdb:2: the residue number (columns 23 to 26) is '****'; an integer was expected");
  CHECK(molecule_of_pdb(with(23, "    ")).residues.back().number == 0);  // as some write ligands
  CHECK(pdb_error(with(29, "\t")).find("a.pdb:2: a PDB atom line has a tab") == 0);
  CHECK(pdb_error(good + good.substr(0, 50) + "\n") ==
        "a.pdb:2: a PDB atom line has 50 columns; at least 54 were expected (z ends there); complete the line");
  CHECK_THROWS_AS(molecule_of_pdb(with(31, "     nan")), FormatError);
}

TEST_CASE("read_pdb: what follows the coordinates may be missing or odd") {
  const std::string line = text_of({}).substr(0, 54);
  CHECK(xs(molecule_of_pdb(line + "\n" + text_of({"ATOM", " CB ", ' ', "ALA ", 'A', 1, ' ', 4}))) == Xs{0, 4});
  CHECK(xs(molecule_of_pdb(line)) == Xs{0});                                  // and no newline at the end
  CHECK(xs(molecule_of_pdb(text_of({}).substr(0, 78) + "x+\r\n")) == Xs{0});  // a charge that gemmi refuses
}

TEST_CASE("read_pdb: of two residues in one place one is read, with the atoms that both share (1EJG's PRO/SER 22)") {
  const auto atom = [](const char* name, char location, const char* residue, double x, double occupancy) {
    return text_of({"ATOM", name, location, residue, 'A', 22, ' ', x, occupancy});
  };
  const std::string text = atom(" N  ", ' ', "PRO ", 0, 1) + atom(" CA ", 'A', "PRO ", 1, 0.4) +
                           atom(" CD ", 'A', "PRO ", 2, 0.4) + atom(" CA ", 'B', "SER ", 3, 0.6) +
                           atom(" OG ", 'B', "SER ", 4, 0.6);
  const Molecule m = molecule_of_pdb(text);
  CHECK(xs(m) == Xs{0, 3, 4});
  for (const Residue& residue : m.residues) CHECK(residue.name == "SER");
  CHECK(m.residues.size() == 1);
  // One number twice without locations is two residues.
  CHECK(molecule_of_pdb(atom(" CA ", ' ', "PRO ", 1, 1) + atom(" CA ", ' ', "SER ", 3, 1)).residues.size() == 2);
}

TEST_CASE("read_pdb: filters") {
  const std::string text = text_of({}) + text_of({"HETATM", "ZN  ", ' ', " ZN ", 'A', 2, ' ', 1, 1, "ZN"}) +
                           text_of({"HETATM", " O  ", ' ', "DUM ", 'A', 3, ' ', 4, 1, " O"}) +
                           text_of({"HETATM", " O  ", ' ', "HOH ", 'A', 3, ' ', 2, 1, " O"});
  StructureOptions options;
  CHECK(xs(molecule_of_pdb(text, options)) == Xs{0, 1});
  options.include_hetero = false;
  CHECK(xs(molecule_of_pdb(text, options)) == Xs{0});
  options.include_hetero = options.include_water = true;
  CHECK(xs(molecule_of_pdb(text, options)) == Xs{0, 1, 2});
}

TEST_CASE("read_pdb: models") {
  const auto path = real_input("nmr/1l2y.pdb");
  if (!path) return;
  CHECK(count_models(*path) == 38);
  StructureOptions options;
  options.model = 2;
  const Molecule m = read_structure(*path, options);
  CHECK(m.size() == 304);
  CHECK(m.residues.size() == 20);
  CHECK(m.positions[0] == Vec3d{-6.919, 6.901, 0.917});  // awk '/^ATOM/ && ++n==305': model 1 has 304 atoms
  options.model = 39;
  CHECK(message_of([&] { read_structure(*path, options); }) ==
        *path + ": model 39 was asked for, but the file has models 1 to 38");
}

TEST_CASE("read_pdb: real files with alternate locations, ligands and waters") {
  // awk '/^(ATOM|HETATM)/ && substr($0,18,3)!="HOH"{k=substr($0,13,4) substr($0,18,10); if(!(k in s)){s[k];n++}}
  // END{print n}'
  const std::pair<const char*, std::size_t> files[] = {{"bad_parmed/2igd.pdb", 468}, {"fv_d13/1a2y.pdb", 2733},
                                                       {"fv_d13/1vfb.pdb", 3408},    {"tim/2YPI.pdb", 3784},
                                                       {"t4l/181L.pdb", 1305},       {"pqr_pdb2pqr/1AJJ.pdb", 285}};
  for (const auto& file : files) {
    const auto path = real_input(file.first);
    if (!path) return;
    CHECK_MESSAGE(read_structure(*path).size() == file.second, file.first);
  }
  const Molecule m = read_structure(*real_input("bad_parmed/2igd.pdb"));
  CHECK(m.atoms[4].name == "CB");
  CHECK(m.positions[4] == Vec3d{2.844, 3.092, 6.356});  // location A, occupancy 0.82
}

TEST_CASE("read_pdb: real files that are odd are read right or refused clearly") {
  const auto codes = real_input("bad_pdb/insertion-code.pdb");
  if (!codes) return;
  const Molecule m = read_structure(*codes);
  REQUIRE(m.residues.size() == 4);
  CHECK(m.residues[0].insertion_code == 'a');
  CHECK(m.residues[1].insertion_code == 'c');
  CHECK(m.residues[2].number == 3);
  CHECK(m.residues[3].insertion_code == ' ');

  const Molecule odd = read_structure(*real_input("bad_pdb/odd-start.pdb"));
  CHECK(odd.size() == 20);
  CHECK(odd.residues[0].name == "EST");
  CHECK(odd.residues[0].number == 600);

  const Molecule water = read_structure(*real_input("bad_pdb/short-atom.pdb"));
  CHECK(water.size() == 9);  // no residue names, so not known as water
  CHECK(water.residues.size() == 3);
  CHECK(water.atoms[1].element == "H");

  const auto mess = real_input("bad_biopython/a_structure.pdb");
  CHECK(message_of([&] { read_structure(*mess); }).find(*mess + ":20: an atom outside of MODEL ... ENDMDL") == 0);
}
#endif
