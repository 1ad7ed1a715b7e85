// write_cif.cpp: values are quoted where CIF asks for it, and a written file is read back.
#include "io/molecules/write_cif.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

Molecule two_residues() {
  Molecule molecule;
  molecule.residues = {{"ALA", "A", 5, ' '}, {"LIG", "A", 7, 'B'}};
  molecule.atoms = {{"CA", "C", 0, false}, {"O5'", "O", 1, true}};
  molecule.positions = {{1, 2, 3}, {-4.5, 5, 6}};
  return molecule;
}

}  // namespace

TEST_CASE("a value of a CIF file is quoted where it could be taken for something else") {
  CHECK(cif_value("CA") == "CA");
  CHECK(cif_value("") == "?");
  CHECK(cif_value("two words") == "'two words'");
  CHECK(cif_value("O5'") == "\"O5'\"");
  CHECK(cif_value("_name") == "'_name'");
  CHECK(cif_value("data_x") == "'data_x'");
  CHECK(cif_value("?") == "'?'");
  CHECK(cif_value("both ' and \"") == "\n;both ' and \"\n;");
  CHECK(cif_value("a\nb") == "a?b");
  CHECK(cif_name("mean slip [A]") == "mean_slip__A_");
}

TEST_CASE("a written mmCIF file has names, positions and values") {
  const ScratchFolder folder;
  std::ostringstream text;
  write_cif(text, "two", two_residues(), {0.25, std::nan("")}, {"a note"}, {{"_espdiff_x", {"a b"}, {{"1 2"}}}});
  CHECK(text.str().find("_espdiff_x.a_b\n'1 2'\n") != std::string::npos);
  CHECK(text.str().find("HETATM 2 O \"O5'\" . LIG A 2 . B -4.500 5.000 6.000 1.00 ? 7 A 1\n") != std::string::npos);
#ifdef ESPDIFF_HAVE_GEMMI
  const Molecule read = read_structure(folder.write("two.cif", text.str()));
  REQUIRE(read.size() == 2);
  CHECK(read.atoms[0].b_factor == doctest::Approx(0.25));
  CHECK(read.atoms[1].name == "O5'");
  CHECK(read.residues[1].insertion_code == 'B');
  CHECK(read.positions[1].x == doctest::Approx(-4.5));
#endif
  CHECK_THROWS_WITH_AS(write_cif(text, "two", two_residues(), {1}, {}, {}), doctest::Contains("1 values for 2 atoms"),
                       InputError);
}
