// fuzz_xsc.cpp: cells of NAMD (.xsc).
#include "fuzz/fuzz_file.h"
#include "io/structures/read_unit_cells.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size),
                                    [](const std::string& path) { espdiff::read_xsc(path); });
}
