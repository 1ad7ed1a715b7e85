// molfile_file.cpp: topologies and trajectories through molfile plugins: one made here, and VMD's own where VMD is.
#include "io/frames/molfile_file.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>

#include "base/error.h"
#include "io/frames/open_structure.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::real_input;
using espdiff_test::ScratchFolder;

namespace {

const char* const kAtoms = "2\nN ALA 1 PROT -0.5\nOH2 LONGNAME 2 WAT 0.25\n";
const char* const kFrames = "2 30\n 0 0 0  1 0 0\n 0 1 0  1 1 0\n 0 2 0  1 2 0\n";

/// The folder of the plugin that the tests build.
std::string made_plugins() { return ESPDIFF_MADE_PLUGINS; }

struct Made {
  ScratchFolder folder;
  std::string psf = folder.write("a.psf", kAtoms), dcd = folder.write("a.dcd", kFrames);
  Progress progress;
  TrajectoryOpener opener{psf, made_plugins(), progress};
};

}  // namespace

TEST_CASE("a topology and a trajectory are a structure file of many models") {
  Made made;
  CHECK(made.opener.needs_coordinates());
  const auto file = made.opener.open(made.dcd);
  CHECK(file->n_models() == 3);
  const Molecule second = file->read({2, true, true, {}});
  CHECK(second.name == made.dcd + ", frame 1");
  CHECK(second.positions == std::vector<Vec3d>{{0, 1, 0}, {1, 1, 0}});
  CHECK(second.charges == std::vector<float>{-0.5F, 0.25F});
  CHECK(second.atoms[0].name == "N");
  CHECK(second.residues[0].chain == "PROT");
  CHECK(second.residues[1].name == "LONGNAME");
  CHECK(file->unit_cell(2)->lengths.y == 30);
  CHECK(file->sha256().size() == 64);
  // Any order.
  CHECK(file->read({3, true, true, {}}).positions[0].y == 2);
  CHECK(file->read({1, true, true, {}}).positions[0].y == 0);
  CHECK(message_of([&] { file->read({4, true, true, {}}); }) == made.dcd + ": there is no frame 3; it has 3, from 0");
}

TEST_CASE("counting the frames of a long trajectory can be cancelled") {
  Made made;
  made.progress.request_cancel();
  CHECK_THROWS_AS(made.opener.open(made.dcd), Cancelled);
}

TEST_CASE("a trajectory takes the atoms of a structure file, and its options") {
  const ScratchFolder folder;
  const std::string pqr = folder.write("a.pqr",
                                       "ATOM 1 N ALA 1 5 5 5 -0.5 1.5\n"
                                       "ATOM 2 OH2 HOH 2 6 6 6 0.25 1.6\n");
  const Progress progress;
  TrajectoryOpener opener(pqr, made_plugins(), progress);
  CHECK_FALSE(opener.needs_coordinates());
  CHECK(opener.open(pqr)->n_models() == 1);
  const auto file = opener.open(folder.write("a.dcd", kFrames));
  const Molecule dry = file->read({3, true, false, {}});
  CHECK(dry.positions == std::vector<Vec3d>{{0, 2, 0}});
  CHECK(dry.radii == std::vector<float>{1.5F});
}

TEST_CASE("trajectories that cannot be read are refused by name, with the remedy") {
  Made made;
  const auto refused = [&](const std::string& text) {
    const std::string path = made.folder.write("b.dcd", text);
    return message_of([&] { made.opener.open(path)->read({1, true, true, {}}); });
  };
  const std::string b = made.folder.file("b.dcd");
  CHECK(
      refused("3 30\n") ==
      b + ": has 3 atoms in each frame, and the structure has 2; give the structure or topology that it was made with");
  CHECK(refused("") ==
        b + ": VMD's reader for dcd files cannot open it; is it complete, and of the kind that its name says?");
  CHECK(refused("2 30\n") == b + ": there are no frames");
  CHECK(refused("2 30\n0 0 0 nan 0 0\n") ==
        b + ": frame 0: atom 1 is at (nan, 0, 0) A, and coordinates are numbers within 10^6 A; write the frame again, "
            "or leave it out");
  CHECK(message_of([&] { made.opener.open(made.folder.file("absent.dcd")); }) ==
        made.folder.file("absent.dcd") + ": cannot be read: No such file or directory; check the path");
  REQUIRE(::mkfifo(made.folder.file("pipe.dcd").c_str(), 0600) == 0);
  CHECK(message_of([&] { made.opener.open(made.folder.file("pipe.dcd")); }) ==
        made.folder.file("pipe.dcd") + ": is a pipe or a device; save its content as a file and give that");
  CHECK(message_of([&] { made.opener.open(made.folder.write("c.xtc", "2")); }) ==
        made.folder.file("c.xtc") + ": no plugin of VMD in " + made_plugins() +
            " reads files with this ending; Python's espdiff reads it by MDAnalysis (in its repository: pip install "
            "'.[mda]')");
  CHECK(message_of([&] {
          TrajectoryOpener opener(made.folder.write("d.psf", "3\nN ALA 1 PROT -0.5\n"), made_plugins(), made.progress);
          opener.open(made.dcd);
        }) == made.folder.file("d.psf") + ": VMD's reader for psf files finds no atoms; is it complete?");
  CHECK(message_of([&] {
          molfile_readers(made.folder.file(""));
        }).find("there are no molfile plugins of VMD 1.9 in this folder; set VMDDIR to the folder") !=
        std::string::npos);
}

TEST_CASE("VMD's own readers: AdK's PSF and DCD against the files' bytes") {
  const std::string plugins = find_molfile_folder();
  if (plugins.empty()) {
    MESSAGE("SKIPPED: VMD's molfile plugins are absent; put `vmd` on PATH, or set VMDDIR");
    return;
  }
  const auto psf = real_input("traj_adk/adk.psf"), dcd = real_input("traj_adk/adk_dims.dcd");
  if (!psf || !dcd) return;
  const Progress progress;
  TrajectoryOpener opener(*psf, plugins, progress);
  const auto file = opener.open(*dcd);
  CHECK(file->n_models() == 98);
  const Molecule last = file->read({98, true, true, {}});
  REQUIRE(last.size() == 3341);
  CHECK(last.residues.size() == 214);
  CHECK(last.residues[213].name == "GLY");
  // A DCD ends with the z coordinates of its last frame, a record of 4-byte numbers between two lengths.
  std::ifstream bytes(*dcd, std::ios::binary);
  const auto n_bytes = static_cast<std::streamoff>(last.size() * sizeof(float));
  bytes.seekg(-n_bytes - 4, std::ios::end);
  std::vector<float> z(last.size());
  bytes.read(reinterpret_cast<char*>(z.data()), n_bytes);
  for (std::size_t i = 0; i < z.size(); ++i) CHECK(static_cast<float>(last.positions[i].z) == z[i]);
}
