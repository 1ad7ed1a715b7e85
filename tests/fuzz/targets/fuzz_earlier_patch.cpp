// fuzz_earlier_patch.cpp: a patch of an earlier ensemble, from its OUT.json and OUT.vtp: the input is one behind the
// other, and the second begins at the first "<".
#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/molecule/earlier_patch.h"
#include "fuzz/fuzz_file.h"
#include "prepare/read_earlier_patch.h"

namespace {

/// Has everything that place_patch() relies on.
void check(const espdiff::EarlierPatch& patch) {
  const std::size_t n = patch.positions.size();
  if (patch.inside.size() != n || patch.residue.size() != n || !std::isfinite(patch.area_A2)) std::abort();
  for (const espdiff::Vec3d& p : patch.positions) {
    if (!std::isfinite(p.x + p.y + p.z)) std::abort();
  }
  for (const std::int32_t residue : patch.residue) {
    if (residue < -1 || residue >= static_cast<std::int32_t>(patch.residues.size())) std::abort();
  }
  for (const espdiff::Triangle& triangle : patch.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= n) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Two files whose names differ in their ending, hence none in memory.
  static const std::string prefix = "/dev/shm/espdiff-fuzz-" + std::to_string(getpid()) + "-patch";
  const std::string bytes = espdiff_fuzz::bytes_of(data, size);
  const std::size_t vtp = std::min(bytes.find('<'), bytes.size());
  std::ofstream(prefix + ".json", std::ios::binary) << bytes.substr(0, vtp);
  std::ofstream(prefix + ".vtp", std::ios::binary) << bytes.substr(vtp);
  for (const char* const number : {"1", "2"}) {
    try {
      check(*espdiff::read_earlier_patch({prefix + ".json", number}));
    } catch (const espdiff::Error& error) {
      if (std::string(error.what()).find(prefix) == std::string::npos) std::abort();
    }
  }
  unlink((prefix + ".json").c_str());
  unlink((prefix + ".vtp").c_str());
  return 0;
}
