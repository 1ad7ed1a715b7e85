// fuzz_component.cpp: definitions of chemical components (CIF).
#include "fuzz/fuzz_file.h"
#include "io/structures/read_component.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    for (const espdiff::Component& component : espdiff::read_components(path)) {
      if (component.atoms.empty() || component.bonds.empty()) std::abort();
      for (const espdiff::ComponentBond& bond : component.bonds) {
        if (bond.a >= component.atoms.size() || bond.b >= component.atoms.size() || bond.a == bond.b) std::abort();
        if (bond.order < 1 || bond.order > espdiff::kAromaticOrder) std::abort();
      }
    }
  });
}
