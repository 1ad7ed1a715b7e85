// file_kind.cpp: formats are told by content.
#include "io/files/file_kind.h"

#include "io/files/read_input.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

TEST_CASE("file_kind: the marks of each format") {
  const std::string cube = "a\nb\n 1 0 0 0\n 2 1 0 0\n 2 0 1 0\n 2 0 0 1\n";
  const std::string ccp4 = std::string(208, '\1') + "MAP " + std::string(20, '\1');
  const std::string dcd = std::string("\x54\0\0\0", 4) + "CORD" + std::string(80, '\0');
  CHECK(recognise("ATOM      1  N   MET A   1") == FileKind::kAtomRecords);
  CHECK(recognise("\n# by hand\nHETATM    1  N   MET A   1") == FileKind::kAtomRecords);
  CHECK(recognise("A title of my own\nATOM      1  N   MET A   1") == FileKind::kAtomRecords);
  CHECK(recognise("HEADER    HYDROLASE\n") == FileKind::kAtomRecords);
  CHECK(recognise("\xef\xbb\xbfREMARK 1\n") == FileKind::kAtomRecords);
  CHECK(recognise("# comment\n\ndata_1TCA\n") == FileKind::kMmcif);
  CHECK(recognise("{\"data_1TCA\":") == FileKind::kMmjson);
  CHECK(recognise("\x83\xa7"
                  "encoder\xa8mmtf") == FileKind::kBinaryCif);
  CHECK(recognise("\xde\x01\x10\xabmmtfVersion") == FileKind::kMmtf);
  CHECK(recognise("@<TRIPOS>MOLECULE\n") == FileKind::kMol2);
  CHECK(recognise("ligand\n  made\n\n  1  0  0  0  0  0  0  0  0  0999 V2000\n    0.0 0.0 0.0 C\n") == FileKind::kSdf);
  CHECK(recognise("\n\n\n  0  0  0     0  0            999 V3000\n") == FileKind::kSdf);
  CHECK(recognise("a\nb\nc\nV2000 is a word\n") == FileKind::kUnknownText);
  CHECK(recognise("PSF CMAP\n\n") == FileKind::kPsf);
  CHECK(recognise("%VERSION  VERSION_STAMP = V0001.000") == FileKind::kPrmtop);
  CHECK(recognise(std::string("\0\0\0\x0e\0\0\0\x0dVERSION 2019\0\0", 22)) == FileKind::kTpr);
  CHECK(recognise(std::string(3, '\0')) == FileKind::kUnknownBinary);
  CHECK(recognise("; topol.top\n#include \"oplsaa.ff/forcefield.itp\"\n[ moleculetype ]\nProtein 3\n") ==
        FileKind::kGromacsTopology);
  CHECK(recognise("made by LEaP\n    2\n   1.0000000   2.0000000  -3.0000000   4.0000000   5.0000000   6.0000000\n") ==
        FileKind::kAmberRestart);
  CHECK(recognise("three\n3\n1 2 3\n4 5 6\n") == FileKind::kUnknownText);
  CHECK(recognise(dcd) == FileKind::kDcd);
  CHECK(recognise("CDF\x01"
                  "abc") == FileKind::kNetcdf);
  CHECK(recognise("\x89HDF\r\n") == FileKind::kHdf5);
  CHECK(recognise("# c\nobject 1 class gridpositions counts 2 2 2\n") == FileKind::kDx);
  CHECK(recognise(cube) == FileKind::kCube);
  CHECK(recognise("MODEL 3\nATOM x\n" + cube.substr(4)) == FileKind::kCube);
  CHECK(recognise(ccp4) == FileKind::kCcp4);
  CHECK(recognise("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\">") == FileKind::kVti);
  CHECK(recognise("<VTKFile type=\"PolyData\"><!-- \"ImageData\" -->") == FileKind::kVtkXml);
  CHECK(recognise("# vtk DataFile Version 3.0\n") == FileKind::kVtkLegacy);
  CHECK(recognise("hello world\n") == FileKind::kUnknownText);
  CHECK(recognise(std::string("ab\0cd", 5)) == FileKind::kUnknownBinary);
  CHECK(recognise("") == FileKind::kUnknownText);
}

TEST_CASE("file_kind: real files") {
  const std::pair<const char*, FileKind> files[] = {{"calb/1TCA.pdb", FileKind::kMmcif},
                                                    {"tim/2YPI.pdb", FileKind::kAtomRecords},
                                                    {"bad_pdb/odd-start.pdb", FileKind::kAtomRecords},
                                                    {"bad_biopython/a_structure.pdb", FileKind::kAtomRecords},
                                                    {"ubq/ubq.psf", FileKind::kPsf},
                                                    {"box_dhfr_jac/JAC.prmtop", FileKind::kPrmtop},
                                                    {"traj_adk/adk_dims.dcd", FileKind::kDcd},
                                                    {"map_ngl/3pqr-mode0.ccp4", FileKind::kCcp4},
                                                    {"map_ngl/esp.dx", FileKind::kDx},
                                                    {"map_ngl/benzene-homo.cube", FileKind::kCube},
                                                    {"map_vti/hydrogen.vti", FileKind::kVti},
                                                    {"tim/dTIM_seq.csv", FileKind::kUnknownText}};
  for (const auto& file : files) {
    const auto name = file.first;  // a structured binding cannot be captured by CHECK_MESSAGE
    const auto kind = file.second;
    const auto path = real_input(name);
    if (!path) return;
    CHECK_MESSAGE(recognise(read_text_file(*path)) == kind, name);
  }
}
