// fuzz_matrix_state.cpp: state files of a matrix; lines get the check sums that they would have, so that what is behind
// the sums is reached.
#include <sstream>

#include "fuzz/fuzz_file.h"
#include "io/files/sha256.h"
#include "matrix/matrix_state.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = espdiff_fuzz::bytes_of(data, size);
  std::string state = bytes;
  if (size > 0 && data[0] == '{') {
    state = "espdiff matrix state 1\n";
    std::istringstream lines(bytes);
    std::string sum;
    for (std::string line; std::getline(lines, line);) {
      sum = espdiff::sha256_of(sum + line).substr(0, 32);
      state += sum + ' ' + line + '\n';
    }
  }
  return espdiff_fuzz::read_as_file(state, [](const std::string& path) { espdiff::read_matrix_state(path); });
}
