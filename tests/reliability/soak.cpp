// soak.cpp: many comparisons in one process, from files to files: memory, descriptors, threads and temporary files stay
// as they were. ESPDIFF_COMPARISONS=1000 makes the long form of it (scripts/soak); ESPDIFF_PLANTED_LEAK=8192 loses so
// many bytes in each comparison, which must make the test fail: reliability.soak_finds_a_leak.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "certificate/result.h"
#include "cli/run_espdiff.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "mapping/input.h"
#include "options/options.h"
#include "potential/computed_map.h"
#include "report/sections/provenance.h"
#include "report/write_compare.h"
#include "support/limit_memory.h"
#include "system/this_process.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

/// Of this process: what it asked for and did not give back, and what the system gave it. The first counts every lost
/// byte; the second also sees memory that did not come from malloc, but moves by what the allocator keeps.
struct Memory {
  long allocated = 0, resident = 0;
};

Memory memory_now() {
  std::ifstream statm("/proc/self/statm");
  long size = 0, resident = 0;
  statm >> size >> resident;
  return {static_cast<long>(allocated_bytes()), resident * sysconf(_SC_PAGESIZE)};
}

std::size_t n_entries(const char* folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// As `espdiff compare` does: everything is read, made and written anew.
void compare_once(const ScratchFolder& folder, bool with_potential) {
  const Molecule source = read_structure(folder.file("a.pqr")), target = read_structure(folder.file("b.pqr"));
  CompareOptions options;
  options.surface.grid_spacing_A = 1.5;
  PotentialOptions coulomb;
  coulomb.method = PotentialMethod::kCoulomb;
  CompareInput from{&source, nullptr}, to{&target, nullptr};
  if (with_potential) {
    from.make_map = ComputedMap(source, {}, coulomb).maker();
    to.make_map = ComputedMap(target, {}, coulomb).maker();
  }
  const auto engine = select_engine(DeviceChoice::kCpu, 2);
  const CompareResult result = compare(*engine, from, to, options, Progress());
  write_compare(folder.file("out"), source, target, result, options, {});
}

/// Keeps written memory reachable, so that leak checkers of the test itself do not report it.
void plant_leak(std::size_t n_bytes) {
  static std::vector<std::unique_ptr<std::string>> lost;
  if (n_bytes > 0) lost.push_back(std::make_unique<std::string>(n_bytes, 'x'));
}

/// With an error in each.
void fail_once(const ScratchFolder& folder) {
  CHECK_THROWS(read_structure(folder.file("damaged.pqr")));
  CHECK_THROWS(read_structure(folder.file("absent.pqr")));
}

}  // namespace

TEST_CASE("many comparisons in one process leave memory, descriptors, threads and files as they were") {
  if (!can_limit_memory()) return;
  const char* const asked = std::getenv("ESPDIFF_COMPARISONS");
  const int n = asked != nullptr ? std::max(40, std::atoi(asked)) : 60;
  const char* const leak = std::getenv("ESPDIFF_PLANTED_LEAK");
  const std::size_t n_lost = leak != nullptr ? std::strtoull(leak, nullptr, 10) : 0;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(12));
  folder.write("b.pqr", row_of_atoms(12, 0.3));
  folder.write("damaged.pqr", row_of_atoms(3) + "ATOM 4 N ALA\n");
  std::filesystem::create_directory(folder.file("tmp"));
  setenv("TMPDIR", folder.file("tmp").c_str(), 1);
  const auto repeat = [&](int times) {
    for (int i = 0; i < times; ++i) {
      compare_once(folder, i % 2 == 0);
      fail_once(folder);
      plant_leak(n_lost);
    }
  };
  const int warm_up = std::max(20, n / 10);
  repeat(warm_up);
  const Memory before = memory_now();
  const std::size_t descriptors = n_entries("/proc/self/fd"), threads = n_entries("/proc/self/task");
  const auto files = files_in(folder.file(""));
  repeat(n - warm_up);
  const Memory after = memory_now();
  const long allocated = after.allocated - before.allocated, resident = after.resident - before.resident;
  MESSAGE(n, " comparisons: ", before.resident / 1000, " kB after ", warm_up, ", then ", resident / 1000, " kB more; ",
          before.allocated / 1000, " kB allocated, then ", allocated, " bytes more");
  // The allocator counts the small blocks that it keeps for each thread as allocated.
  constexpr long kAllocatorBytes = 50'000;
  CHECK(allocated < kAllocatorBytes);
  // So small a process grows by the allocator's last pages.
  CHECK((resident < before.resident / 100 || resident < 500'000));
  CHECK(n_entries("/proc/self/fd") == descriptors);
  CHECK(n_entries("/proc/self/task") == threads);
  CHECK(files_in(folder.file("")) == files);
  CHECK(files_in(folder.file("tmp")).empty());
}
