// fuzz_matrix_json.cpp: OUT.json of a matrix, which plots are drawn from.
#include "fuzz/fuzz_file.h"
#include "matrix/read_matrix.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size),
                                    [](const std::string& path) { espdiff::read_matrix_json(path); });
}
