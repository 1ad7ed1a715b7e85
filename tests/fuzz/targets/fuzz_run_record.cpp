// fuzz_run_record.cpp: OUT.json of a comparison, which pictures need.
#include <fstream>

#include "fuzz/fuzz_file.h"
#include "io/structures/run_record.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Found by the name of the surface beside it, hence no file in memory.
  static const std::string prefix = "/dev/shm/espdiff-fuzz-" + std::to_string(getpid());
  std::ofstream(prefix + ".json", std::ios::binary) << espdiff_fuzz::bytes_of(data, size);
  try {
    espdiff::read_run_record(prefix + ".vtp");
  } catch (const espdiff::Error&) {
  }
  unlink((prefix + ".json").c_str());
  return 0;
}
