// fuzz_topology.cpp: charges of topologies: PSF and prmtop.
#include <cmath>

#include "fuzz/fuzz_file.h"
#include "io/structures/read_topology.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::Topology topology = espdiff::read_topology(path);
    const std::size_t n = topology.charges.size();
    if (n == 0 || topology.names.size() != n || (!topology.radii.empty() && topology.radii.size() != n)) std::abort();
    for (const float charge : topology.charges) {
      if (!(std::fabs(charge) <= 1e6F)) std::abort();
    }
    for (const float radius : topology.radii) {
      if (!(radius >= 0 && radius <= 1000)) std::abort();
    }
    if (espdiff::read_topology_atoms(path).size() != n) std::abort();
  });
}
