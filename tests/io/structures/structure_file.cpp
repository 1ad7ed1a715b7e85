// structure_file.cpp: files that are no structure are called by their name, with a remedy.
#include "io/structures/structure_file.h"

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

TEST_CASE("read_structure: real files of other formats are refused by name") {
  const std::pair<const char*, const char*> files[] = {
      {"map_ngl/esp.dx",
       "an OpenDX map, which is not read as a structure; that is no structure; give a PQR, PDB, mmCIF, GRO, MOL2 or "
       "Amber restart file"},
      {"map_ngl/3pqr-mode0.ccp4", "a CCP4/MRC map, which is not read as a structure; that is no structure"},
      {"map_ngl/benzene-homo.cube", "a Gaussian cube map"},
      {"map_vti/hydrogen.vti", "a VTI map"},
      {"ubq/ubq.psf",
       "a PSF topology, which is not read as a structure; give the structure or restart of its atoms, and this as "},
      {"traj_adk/adk_dims.dcd", "a DCD trajectory"},
      {"box_tz2/tz2.truncoct.parm7", "an Amber prmtop topology"},
      {"tim/dTIM_seq.csv",
       "a text file of unknown format, which is not read as a structure; give a PQR, PDB, mmCIF, GRO, MOL2 or Amber "
       "restart file"}};
  for (const auto& [name, part] : files) {
    const auto path = real_input(name);
    if (!path) return;
    CHECK_THROWS_AS(read_structure(*path), InputError);
    CHECK(message_of([&] { read_structure(*path); }).find(*path + ": this looks like " + part) == 0);
    CHECK_THROWS_AS(count_models(*path), InputError);
  }
}

TEST_CASE("read_structure: BinaryCIF points to mmCIF") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("1abc.bcif",
                                         "\x83\xa7"
                                         "encoder\xa8mol*\xaa"
                                         "dataBlocks\x91");
  CHECK(message_of([&] { read_structure(path); }) == path +
                                                         ": this looks like a BinaryCIF structure, which is not read "
                                                         "as a structure; fetch the same entry as mmCIF or PDB");
}

TEST_CASE("read_structure: missing, directory, empty, without atoms") {
  const ScratchFolder scratch;
  CHECK_THROWS_AS(read_structure(scratch.file("absent.pqr")), IoError);
  CHECK_THROWS_AS(read_structure(scratch.file("")), IoError);
  CHECK_THROWS_AS(read_structure(scratch.write("empty.pdb", "")), InputError);
  const std::string blank = scratch.write("blank.pdb", "\n\n");
  CHECK(message_of([&] { read_structure(blank); }).find("a text file of unknown format") != std::string::npos);
  const std::string remarks = scratch.write("remarks.pdb", "REMARK 1\nEND\n");
  CHECK(message_of([&] { read_structure(remarks); }) ==
        remarks + ": has no ATOM or HETATM records; give a structure with atoms");
}

TEST_CASE("read_structure: models of a PQR file") {
  const ScratchFolder scratch;
  const std::string path =
      scratch.write("a.pqr",
                    "MODEL 1\nATOM 1 N MET 1 1 2 3 0.5 1.5\nENDMDL\nMODEL 2\nATOM 1 N MET 1 4 5 6 0.5 "
                    "1.5\nENDMDL\nEND\n");
  CHECK(count_models(path) == 2);
  StructureOptions options;
  options.model = 2;
  CHECK(read_structure(path, options).positions[0] == Vec3d{4, 5, 6});
  options.model = 3;
  CHECK_THROWS_AS(read_structure(path, options), InputError);
}
