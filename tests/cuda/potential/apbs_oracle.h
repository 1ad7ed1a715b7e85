// apbs_oracle.h: potentials of APBS (Debian's package) on a given grid, with the engine's definitions.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "base/types.h"
#include "engine/poisson_boltzmann.h"
#include "io/grids/read_grid.h"
#include "support/test_data.h"

namespace espdiff_test {

using espdiff::DielectricBoundary;
using espdiff::Grid;
using espdiff::Lattice;
using espdiff::Molecule;
using espdiff::PoissonBoltzmannOptions;
using espdiff::Vec3d;

inline bool apbs_is_there() { return std::system("command -v apbs >/dev/null 2>&1") == 0; }

/// Where Debian's package apbs-data has its examples; empty when it is absent.
inline std::string apbs_examples() {
  const std::string folder = "/usr/share/apbs/examples";
  return std::filesystem::is_directory(folder) ? folder : std::string();
}

inline void write_apbs_pqr(const std::string& path, const Molecule& molecule) {
  std::ofstream out(path);
  char line[160];
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Vec3d& p = molecule.positions[i];
    std::snprintf(line, sizeof line, "ATOM %zu C ALA 1 %.9f %.9f %.9f %.6f %.6f\n", i + 1, p.x, p.y, p.z,
                  static_cast<double>(molecule.charges[i]), static_cast<double>(molecule.radii[i]));
    out << line;
  }
}

/// The text of an `elec` section on the lattice. @param focus_from length of the coarse grid's sides, for `mg-auto`
inline std::string apbs_elec(const Lattice& lattice, const PoissonBoltzmannOptions& o, const std::string& write,
                             const std::array<double, 3>* coarse_length = nullptr) {
  const Vec3d h{lattice.step[0].x, lattice.step[1].y, lattice.step[2].z};
  std::array<double, 3> n{}, centre{}, length{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    n[axis] = lattice.size[axis];
    length[axis] = h[a] * (n[axis] - 1);
    centre[axis] = lattice.origin[a] + 0.5 * length[axis];
  }
  const auto three = [](const char* word, const std::array<double, 3>& v) {
    char text[160];
    std::snprintf(text, sizeof text, "%s %.9g %.9g %.9g\n", word, v[0], v[1], v[2]);
    return std::string(text);
  };
  char ions[200] = "";
  if (o.ionic_strength > 0)
    std::snprintf(ions, sizeof ions, "ion charge 1 conc %g radius %g\nion charge -1 conc %g radius %g\n",
                  o.ionic_strength, o.ion_radius_A, o.ionic_strength, o.ion_radius_A);
  char rest[400];
  const bool molecular = o.dielectric_boundary == DielectricBoundary::kMolecular;
  std::snprintf(rest, sizeof rest,
                "mol 1\n%s\nbcfl mdh\npdie %g\nsdie %g\nchgm spl2\nsrfm smol\nsrad %g\nswin 0.3\nsdens 40\ntemp %g\n"
                "calcenergy no\ncalcforce no\n",
                o.nonlinear ? "npbe" : "lpbe", o.solute_dielectric, o.solvent_dielectric,
                molecular ? o.probe_radius_A : 0.0, o.temperature_K);
  std::string text = "elec\n";
  if (coarse_length != nullptr) {
    text += "mg-auto\n" + three("dime", n) + three("cglen", *coarse_length) + three("fglen", length) +
            three("cgcent", centre) + three("fgcent", centre);
  } else {
    text += "mg-manual\n" + three("dime", n) + three("grid", {h.x, h.y, h.z}) + three("gcent", centre);
  }
  return text + ions + rest + write + "end\n";
}

/// APBS' potential of a molecule on a lattice, kT/e. Its numbers of points must be such that APBS takes them: 32 c + 1.
/// @param what "pot", "dielx", "kappa", ...
inline Grid apbs_map(const ScratchFolder& folder, const Molecule& molecule, const Lattice& lattice,
                     const PoissonBoltzmannOptions& options, const std::string& what = "pot") {
  write_apbs_pqr(folder.file("in.pqr"), molecule);
  folder.write("in.apbs", "read\nmol pqr in.pqr\nend\n" +
                              apbs_elec(lattice, options, "write " + what + " dx " + what + "\n") + "quit\n");
  const std::string command = "cd '" + folder.file("") + "' && apbs in.apbs >apbs.log 2>&1";
  if (std::system(command.c_str()) != 0) MESSAGE("apbs failed: ", read_file(folder.file("apbs.log")));
  // Debian's is built for several processes, and says which one wrote.
  const std::string alone = folder.file(what + ".dx"), first = folder.file(what + "-PE0.dx");
  return espdiff::read_grid(std::filesystem::exists(alone) ? alone : first);
}

}  // namespace espdiff_test
