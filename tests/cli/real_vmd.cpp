// real_vmd.cpp: a VMD that is found on PATH (or named by $VMD) reads what espdiff writes.
#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "cli/run_espdiff.h"
#include "io/structures/structure_file.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// The command that starts VMD; empty when there is none.
std::string vmd_command() {
  const char* named = std::getenv("VMD");
  const std::string command = named != nullptr ? named : "vmd";
  return std::system(("command -v '" + command + "' >/dev/null 2>&1").c_str()) == 0 ? command : std::string();
}

double density_oracle(const espdiff::Molecule& molecule, espdiff::Vec3d p) {
  double sum = 0;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const double s = static_cast<double>(molecule.radii[i]);
    const espdiff::Vec3d d = p - molecule.positions[i];
    if (s > 0) sum += std::exp(-espdiff::dot(d, d) / (2 * s * s));
  }
  return sum;
}

}  // namespace

TEST_CASE("VMD reads the density that `surface` writes and finds it at the atoms") {
  const std::string vmd = vmd_command();
  if (vmd.empty()) {
    MESSAGE("SKIPPED: no vmd on PATH, and $VMD is not set");
    return;
  }
  const auto path = real_input("ubq/ubq.pqr");
  if (!path) return;
  const ScratchFolder folder;
  const Outcome outcome = run_espdiff("surface " + *path + " --grid-spacing 0.5 --density " + folder.file("d.dx") +
                                      " -q -o " + folder.file("s.vtp"));
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  folder.write("read.tcl",
               "proc run {} {\n  set mol [mol new {" + *path + "} type pqr waitfor all]\n  mol addfile {" +
                   folder.file("d.dx") +
                   "} type dx waitfor all $mol\n  set atoms [atomselect $mol {name CA}]\n  set out [open {" +
                   folder.file("values") +
                   "} w]\n  foreach i [$atoms list] value [$atoms get interpvol0] { puts $out \"$i $value\" }\n  puts "
                   "$out done\n  close $out\n}\n"
                   "run\nquit\n");
  REQUIRE(std::system(("timeout 60 " + vmd + " -dispdev text -e " + folder.file("read.tcl") + " </dev/null >" +
                       folder.file("log") + " 2>&1")
                          .c_str()) == 0);
  std::istringstream values(read_file(folder.file("values")));
  REQUIRE_MESSAGE(contains(values.str(), "done"), read_file(folder.file("log")));
  const espdiff::Molecule molecule = espdiff::read_structure(*path);
  std::size_t n = 0, atom = 0;
  double worst = 0;
  for (double value = 0; values >> atom >> value; ++n) {
    worst = std::max(worst, std::fabs(value - density_oracle(molecule, molecule.positions[atom])));
  }
  CHECK(n == 76);
  CHECK(worst < 0.15);  // of up to 11; measured 0.093: trilinear interpolation on 0.5 A
}
