// limits.cpp: too much of anything is refused with one line, and no process is left to the kernel.
#include <doctest/doctest.h>

#include <utility>

#include "base/error.h"
#include "cli/run_espdiff.h"
#include "io/molecules/molecule_builder.h"
#include "io/structures/structure_file.h"
#include "support/limit_memory.h"

using namespace espdiff_test;  // NOLINT: a test

TEST_CASE("little memory: every run ends with 0, or with 1 or 2 and one line, and nothing half written") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(40));
  folder.write("b.pqr", row_of_atoms(40, 0.2));
  const std::string verbs[] = {"compare a.pqr b.pqr --grid-spacing 0.3 -o out",
                               "surface a.pqr --grid-spacing 0.2 -o out.vtp",
                               "surface a.pqr --grid-spacing 0.02 -o out.vtp", "potential a.pqr --grid 0.25 -o out.dx"};
  int n_refused = 0;
  for (const std::string& verb : verbs) {
    for (int megabytes = 300; megabytes <= 1500; megabytes += 150) {
      CAPTURE(verb);
      CAPTURE(megabytes);
      const Outcome outcome =
          run_espdiff(verb + " --device cpu --threads 1 -q",
                      "cd " + folder.file("") + " && ulimit -v " + std::to_string(1024 * megabytes) + " &&");
      CHECK(outcome.status >= 0);
      CHECK_MESSAGE(outcome.status <= 2, outcome.err);
      if (outcome.status == 0) break;
      ++n_refused;
      CHECK_MESSAGE(outcome.err.rfind("espdiff: ", 0) == 0, outcome.err);
      CHECK(n_lines(outcome.err) == 1);
      CHECK(folder.n_files() == 2);
    }
    for (const char* name : {"out.json", "out.vtp", "out.residues.csv", "out.dx"})
      std::filesystem::remove(folder.file(name));
  }
  CHECK(n_refused > 0);
}

TEST_CASE("a map of 1024^3 points is refused where memory does not hold it") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(4));
  const std::string path = folder.write(
      "big.vti",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<ImageData WholeExtent=\"0 1023 0 1023 0 1023\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n"
      "<Piece Extent=\"0 1023 0 1023 0 1023\"><PointData Scalars=\"p\"><DataArray type=\"Float32\" Name=\"p\" "
      "format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData>\n<AppendedData encoding=\"raw\">_");
  std::filesystem::resize_file(path, (std::uintmax_t{4} << 30U) + 1000);  // holes: no room on the disk
  const Outcome outcome = run_espdiff("surface a.pqr --map big.vti --device cpu --threads 1 -o out.vtp",
                                      "cd " + folder.file("") + " && ulimit -v 3000000 &&");
  CHECK(outcome.status == 1);
  CHECK_MESSAGE(contains(outcome.err, "espdiff: big.vti: needs 4.3 GB of memory, and "), outcome.err);
  CHECK(n_lines(outcome.err) == 1);
  CHECK(folder.n_files() == 2);
}

TEST_CASE("text maps of 1024^3 points are refused: too few values, or more than memory holds") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(4));
  const std::string dx =
      "object 1 class gridpositions counts 1024 1024 1024\norigin 0 0 0\ndelta 1 0 0\ndelta 0 1 0\ndelta 0 0 1\n"
      "object 2 class gridconnections counts 1024 1024 1024\n"
      "object 3 class array type double rank 0 items 1073741824 data follows\n1 2 3\n";
  const std::string cube = "a map\nof a molecule\n 1 0 0 0\n 1024 1 0 0\n 1024 0 1 0\n 1024 0 0 1\n 6 6 0 0 0\n1 2 3\n";
  for (const std::string& text : {dx, cube}) {
    const std::string name = text == dx ? "big.dx" : "big.cube";
    CAPTURE(name);
    // What a file is, its first 64 kB tell.
    const std::string path = folder.write(name, text + std::string(70000, '\n'));
    const auto run = [&] {
      return run_espdiff("surface a.pqr --map " + name + " --map-unit kT/e --device cpu -o out.vtp",
                         "cd " + folder.file("") + " && ulimit -v 2000000 &&");
    };
    const Outcome cut = run();
    CHECK(cut.status == 2);
    CHECK_MESSAGE(contains(cut.err, "the header promises 1073741824 values, but only "), cut.err);
    CHECK(n_lines(cut.err) == 1);
    std::filesystem::resize_file(path, std::uintmax_t{3} << 30U);  // holes: no room on the disk
    const Outcome whole = run();
    CHECK(whole.status == 1);
    CHECK_MESSAGE(contains(whole.err, "espdiff: " + name + ": needs 3.2 GB of memory, and "), whole.err);
    CHECK(n_lines(whole.err) == 1);
    std::filesystem::remove(path);
  }
}

TEST_CASE("text that takes many times its size as atoms, cells or JSON is refused before memory is taken") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(4));
  const auto refused = [&](const std::string& name, const std::string& line, int n_lines_of_it, const std::string& head,
                           const std::string& arguments, const std::string& need) {
    CAPTURE(name);
    folder.write("line", line);
    const std::string make = "cd " + folder.file("") + " && printf '%s' '" + head + "' >" + name +
                             " && yes \"$(cat line)\" | head -n " + std::to_string(n_lines_of_it) + " >>" + name;
    REQUIRE(std::system(make.c_str()) == 0);
    const Outcome outcome = run_espdiff(arguments, "cd " + folder.file("") + " && ulimit -v 1500000 &&");
    CHECK(outcome.status == 1);
    CHECK_MESSAGE(contains(outcome.err, "espdiff: " + name + ": needs " + need + " GB of memory, and "), outcome.err);
    CHECK(n_lines(outcome.err) == 1);
    std::filesystem::remove(folder.file(name));
  };
  const std::string end = " --device cpu --threads 1 -q -o out";
#ifdef ESPDIFF_HAVE_GEMMI
  refused("many.pdb", "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C", 3000000, "",
          "surface many.pdb" + end + ".vtp", "1.8");
  refused("many.cif", "ATOM 1 C CA . ALA A 1 1 ? 0.0 0.0 0.0 1.0 0.0 1 ALA A CA 1", 2000000,
          "data_a\nloop_\n_atom_site.group_PDB\n", "surface many.cif" + end + ".vtp", "3.2");
#endif
  refused("values.json", "{},{},{},{},", 2500000, "[", "plot values.json -o out.png", "1.6");
  refused("cells.csv", ",,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,", 600000, "structure,b\n",
          "matrix --list cells.csv" + end, "1.9");
}

TEST_CASE("a ligand of more atoms than memory holds is refused before they are read") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  // Asked for before PDB2PQR runs, so that any program does.
  folder.write("a.pdb", "ATOM      1  CA  GLY A   1       0.000   0.000   0.000  1.00  0.00           C\n");
  REQUIRE(std::system(("cd " + folder.file("") + " && echo '@<TRIPOS>ATOM' >many.mol2 && " +
                       "yes '1 C 0 0 0 C' | head -n 4500000 >>many.mol2")
                          .c_str()) == 0);
  const Outcome outcome =
      run_espdiff("prepare a.pdb --ligand many.mol2 -o out.pqr -q",
                  "cd " + folder.file("") + " && export ESPDIFF_PDB2PQR=true && ulimit -v 900000 &&");
  CHECK(outcome.status == 1);
  CHECK_MESSAGE(contains(outcome.err, "espdiff: many.mol2: needs 2.4 GB of memory, and "), outcome.err);
  CHECK(n_lines(outcome.err) == 1);
  CHECK(folder.n_files() == 2);
}

TEST_CASE("more atoms than are read are refused") {
  const ScratchFolder folder;
  std::string text;
  text.reserve(std::size_t{40} * (espdiff::kMostAtoms + 1));
  char line[96];
  for (std::size_t i = 0; i <= espdiff::kMostAtoms; ++i) {
    std::snprintf(line, sizeof line, "ATOM 1 C ALA 1 %d %d %d 0 1\n", static_cast<int>(i % 200),
                  static_cast<int>(i / 200 % 200), static_cast<int>(i / 40000));
    text += line;
  }
  const std::string path = folder.write("many.pqr", text);
  CHECK(message_of([&] { espdiff::read_structure(path); }) ==
        path + ": has more than 5000000 atoms, which is the most that are read");
}

#ifdef ESPDIFF_HAVE_ZLIB
TEST_CASE("a gzip file that unpacks to more than memory holds is refused") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(4));
  // Many members of one file: 16 MiB of blanks each.
  const std::string make = "cd " + folder.file("") +
                           " && printf 'object 1 class gridpositions counts 900 900 900\\n' | gzip -c >bomb.dx.gz && "
                           "head -c 16777216 /dev/zero | tr '\\0' ' ' | gzip -c >one.gz && for i in $(seq 160); do cat "
                           "one.gz; done >>bomb.dx.gz && rm one.gz";
  REQUIRE(std::system(make.c_str()) == 0);
  const Outcome outcome = run_espdiff("surface a.pqr --map bomb.dx.gz --device cpu --threads 1 -o out.vtp",
                                      "cd " + folder.file("") + " && ulimit -v 1500000 &&");
  CHECK(outcome.status == 1);
  const bool is_told = contains(outcome.err, "espdiff: bomb.dx.gz: needs ") ||
                       contains(outcome.err, "espdiff: bomb.dx.gz: does not fit into memory; ");
  CHECK_MESSAGE(is_told, outcome.err);
  CHECK(n_lines(outcome.err) == 1);
  CHECK(folder.n_files() == 2);
}
#endif
