// fuzz_series_state.cpp: the saved mapping of a trajectory; behind a check sum that fits, and as it is.
#include "fuzz_file.h"
#include "io/sha256.h"
#include "trajectory/series_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes = espdiff_fuzz::bytes_of(data, size);
  if (size > 0 && data[0] != '!') {
    bytes = "espdiff series state 2\nf\n" + bytes;
    bytes += espdiff::sha256_of(bytes);
  }
  return espdiff_fuzz::read_as_file(bytes, [](const std::string& path) { espdiff::read_series_state(path, "f"); });
}
