// atom_records.cpp: models of PDB and PQR files, and which of the two a file is.
#include "io/structures/atom_records.h"

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;

namespace {

const std::string kAtom = "ATOM      1  N   MET A   1      44.360  -3.155   8.971  1.00 10.00           N\n";

std::vector<std::size_t> sizes(const std::string& text) {
  std::vector<std::size_t> n;
  for (const AtomModel& model : split_models(text, "f.pdb")) n.push_back(model.size());
  return n;
}

bool is_pqr(const std::string& lines, const std::string& path = "f") {
  return looks_like_pqr(split_models(lines, path).front(), path);
}

using Sizes = std::vector<std::size_t>;

}  // namespace

TEST_CASE("atom_records: models by MODEL and ENDMDL") {
  CHECK(sizes(kAtom + kAtom + "TER\nEND\n") == Sizes{2});
  CHECK(sizes("MODEL        1\n" + kAtom + "ENDMDL\nMODEL        2\n" + kAtom + kAtom + "ENDMDL\nEND\n") ==
        Sizes{1, 2});
  CHECK(sizes("MODEL 1\n" + kAtom + "MODEL 2\n" + kAtom) == Sizes{1, 1});
  CHECK(sizes(kAtom + "ENDMDL\n" + kAtom + "ENDMDL\n") == Sizes{1, 1});
  CHECK(sizes(kAtom + "TER\n# scores\nfilter 0\nmodel 1\n") == Sizes{1});  // as Rosetta writes them
  CHECK(sizes("MODEL 1\n" + kAtom + "ENDMDL\nMODEL 2\nENDMDL\n") == Sizes{1, 0});
}

TEST_CASE("atom_records: END parts frames as VMD writes them, and nothing else") {
  CHECK(sizes("CRYST1\n" + kAtom + "END\n" + kAtom + "END\n") == Sizes{1, 1});
  CHECK(message_of([] { sizes(kAtom + "END\n" + kAtom + kAtom + "END\n"); }) ==
        "f.pdb:2: atoms continue after END, and the parts differ (1 and 2 atoms); delete END if they are one molecule, "
        "or "
        "put "
        "them between MODEL and ENDMDL");
}

TEST_CASE("atom_records: atoms beside the models are refused with their line") {
  CHECK(message_of([] { sizes("MODEL 1\n" + kAtom + "ENDMDL\n" + kAtom); }) ==
        "f.pdb:4: an atom outside of MODEL ... ENDMDL ('ATOM      1  N   MET A   1'), in a file that has MODEL "
        "records; move it into a model, or "
        "delete the "
        "MODEL and ENDMDL lines");
  CHECK_THROWS_AS(sizes(kAtom + "MODEL 1\n" + kAtom + "ENDMDL\n"), FormatError);
}

TEST_CASE("atom_records: lines keep number and text, without line ends") {
  const std::string text = "REMARK\r\nhetatm 1 A B 1 0 0 0 1 1\r\nATOM\t2 C D 1 0 0 0 1 1";
  const auto models = split_models(text, "f");
  REQUIRE(models.size() == 1);
  REQUIRE(models[0].size() == 2);
  CHECK(models[0][0].number == 2);
  CHECK(models[0][0].is_hetatm());
  CHECK(models[0][0].text == "hetatm 1 A B 1 0 0 0 1 1");
  CHECK_FALSE(models[0][1].is_hetatm());
}

TEST_CASE("atom_records: a file without atoms, a model that is not there") {
  CHECK(message_of([] { sizes("REMARK nothing\nATOMIC\n"); }) ==
        "f.pdb: has no ATOM or HETATM records; give a structure with atoms");
  const auto models = split_models(kAtom, "f.pdb");
  CHECK(&pick_model(models, 1, "f.pdb") == &models[0]);
  CHECK(message_of([&] { pick_model(models, 2, "f.pdb"); }) ==
        "f.pdb: model 2 was asked for, but the file has models 1 to 1");
  CHECK_THROWS_AS(pick_model(models, 0, "f.pdb"), InputError);
}

TEST_CASE("atom_records: PDB and PQR by their lines") {
  CHECK_FALSE(is_pqr(kAtom));
  // pdb2pqr: charge and radius where PDB has occupancy and B factor.
  CHECK(is_pqr("ATOM      1  N   MET A   1      44.360  -3.155   8.971 -0.3000 1.8500\n"));
  CHECK(is_pqr("ATOM      1  N   NTE   544     -13.336   3.045  35.885 0.185 1.824\n"));
  CHECK(is_pqr("ATOM 1 H5T DC5 1 27.482 39.448 51.564 0.4422 0.6000\n"));
  // Only coordinates; then occupancy and B factor but nothing after them.
  CHECK_FALSE(is_pqr("ATOM      1  N   MET A   1      44.360  -3.155   8.971\n"));
  CHECK_FALSE(is_pqr("ATOM      1  O       X   1       0.417   8.303  11.737  0.00  0.00\n"));
  CHECK_FALSE(is_pqr("ATOM      1  O       X   1       0.417   8.303  11.737  1.00 -1.00\n"));
}

TEST_CASE("atom_records: two decimals in PDB's columns are ambiguous; a negative charge or the name decides") {
  const std::string line = "ATOM      1  O   ION     1       0.417   8.303  11.737  1.00  2.00\n";
  CHECK_FALSE(is_pqr(line, "a.pdb"));
  CHECK(is_pqr(line, "a.pqr"));
  CHECK(is_pqr(line, "a.pqr.gz"));
  CHECK(is_pqr(line + "ATOM      1  O   ION     1       0.417   8.303  11.737 -1.00  2.00\n", "a.pdb"));
}

TEST_CASE("atom_records: one broken line does not turn a PDB into a PQR") {
  std::string lines;
  for (int i = 0; i < 5; ++i) lines += "ATOM      1  O       X   1       0.417   8.303  11.737  0.00  0.00\n";
  CHECK_FALSE(is_pqr(lines + "ATOM      1  O       X   1       0.417   x.303  11.737  0.00  0.00\n"));
}
