// fuzz_verify.cpp: OUT.json of a comparison, through the whole of `espdiff verify`; the other files of the result stay
// as they are (tests/fuzz/result).
#include <filesystem>
#include <fstream>

#include "fuzz/fuzz_file.h"
#include "verify/verify.h"

namespace {

/// A folder in memory with the result's other files.
std::string make_folder() {
  const std::string folder = "/dev/shm/espdiff-fuzz-" + std::to_string(getpid()) + "-verify";
  std::filesystem::create_directories(folder);
  for (const char* const name : {"out.vtp", "out.residues.csv", "a.pqr", "b.pqr"})
    std::filesystem::copy_file(std::string(ESPDIFF_FUZZ_RESULT) + "/" + name, folder + "/" + name,
                               std::filesystem::copy_options::overwrite_existing);
  std::atexit([] {
    std::error_code ignored;
    std::filesystem::remove_all("/dev/shm/espdiff-fuzz-" + std::to_string(getpid()) + "-verify", ignored);
  });
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string folder = make_folder();
  std::ofstream(folder + "/out.json", std::ios::binary) << espdiff_fuzz::bytes_of(data, size);
  try {
    const espdiff::Verification result = espdiff::verify(folder + "/out");
    result.agrees();
  } catch (const espdiff::Error& error) {
    const std::string message = error.what();
    // One of a structure or of a lattice names that.
    if (message.find(folder) == std::string::npos && message.rfind("verify: ", 0) != 0) std::abort();
  }
  return 0;
}
