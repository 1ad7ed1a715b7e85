// write_synthetic.cpp: writes generated or read atoms as "x y z radius" lines, so that other programs can be timed on
// the same ones.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "io/structures/structure_file.h"
#include "synthetic_protein.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: espdiff_synthetic N_ATOMS|FILE.pqr > ATOMS\n");
    return 2;
  }
  try {
    char* end = nullptr;
    const long n_atoms = std::strtol(argv[1], &end, 10);
    const bool generate = *end == '\0' && n_atoms >= 10;
    const espdiff::Molecule molecule = generate ? espdiff_bench::synthetic_protein(static_cast<std::size_t>(n_atoms))
                                                : espdiff::read_structure(argv[1]);
    for (std::size_t i = 0; i < molecule.size(); ++i) {
      const espdiff::Vec3d p = molecule.positions[i];
      std::printf("%.4f %.4f %.4f %.4f\n", p.x, p.y, p.z, static_cast<double>(molecule.radii[i]));
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff_synthetic: %s\n", error.what());
    return 2;
  }
}
