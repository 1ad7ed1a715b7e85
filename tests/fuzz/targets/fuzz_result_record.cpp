// fuzz_result_record.cpp: OUT.json of a comparison, as `espdiff verify` reads it.
#include <fstream>

#include "fuzz/fuzz_file.h"
#include "verify/result_record.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Found by the prefix of its name, hence no file in memory.
  static const std::string prefix = "/dev/shm/espdiff-fuzz-" + std::to_string(getpid()) + "-result";
  std::ofstream(prefix + ".json", std::ios::binary) << espdiff_fuzz::bytes_of(data, size);
  try {
    const espdiff::ResultRecord record(prefix);
    record.number("certificate/self_intersecting_pairs");
    record.flag("certificate/trustworthy");
    record.size("certificate/reasons");
    record.size("region");
    record.sum("certificate/unmatched_area_A2");
    record.text("options/method");
    record.numbers("superposition/rotation_row_major");
    record.triples("certificate/torn");
    for (const char* const role : {"source", "target", "source_map"}) record.input(role);
  } catch (const espdiff::Error& error) {
    if (std::string(error.what()).find(prefix) == std::string::npos) std::abort();
  }
  unlink((prefix + ".json").c_str());
  return 0;
}
