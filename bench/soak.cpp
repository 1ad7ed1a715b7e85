// soak.cpp: many comparisons in one process: memory, descriptors, threads and temporary files before and after.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/progress.h"
#include "compare/input.h"
#include "compare/options.h"
#include "compare/result.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "report/write_compare.h"

namespace {

using namespace espdiff;  // NOLINT: a program of one file

/// What a process holds.
struct Holdings {
  double resident_MB = 0;
  int n_descriptors = 0, n_threads = 0;
};

int n_entries(const char* folder) {
  int n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n;
  return n;
}

Holdings holdings() {
  Holdings now;
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    double kilobytes = 0;
    if (key == "VmRSS:" && status >> kilobytes) now.resident_MB = kilobytes / 1024;
  }
  now.n_descriptors = n_entries("/proc/self/fd");
  now.n_threads = n_entries("/proc/self/task");
  return now;
}

/// A chain of atoms along x, bent by so much.
Molecule bent_chain(double amount) {
  Molecule m;
  m.name = "chain";
  m.radii_origin = ValueOrigin::kFile;
  for (int i = 0; i < 24; ++i) {
    const double x = 1.6 * i, y = amount * 0.02 * x * x + 0.6 * (i % 2), z = 0.5 * (i % 3);
    m.residues.push_back({"ALA", "A", i + 1, ' '});
    m.atoms.push_back({"CA", "C", i, false});
    m.positions.push_back({x, y, z});
    m.radii.push_back(1.7F);
    m.charges.push_back(0.1F * static_cast<float>(i % 5 - 2));
  }
  return m;
}

}  // namespace

int main(int argc, char** argv) {
  const int n_runs = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int n_warm = n_runs / 10;
  const std::string prefix = (std::filesystem::temp_directory_path() / "espdiff-soak").string();
  const Molecule source = bent_chain(0);
  CompareOptions options;
  options.surface.grid_spacing_A = 1.5;
  Holdings warm;
  std::printf("%8s %14s %12s %8s\n", "run", "resident (MB)", "descriptors", "threads");
  for (int i = 0; i <= n_runs; ++i) {
    if (i == n_warm) warm = holdings();
    if (i % (n_runs / 10 > 0 ? n_runs / 10 : 1) == 0) {
      const Holdings now = holdings();
      std::printf("%8d %14.1f %12d %8d\n", i, now.resident_MB, now.n_descriptors, now.n_threads);
      std::fflush(stdout);
    }
    if (i == n_runs) break;
    const Molecule target = bent_chain(0.2 + 0.05 * (i % 7));
    const auto engine = select_engine(DeviceChoice::kCpu, 2);
    const CompareResult result = compare(*engine, {&source, nullptr}, {&target, nullptr}, options, Progress());
    write_compare(prefix, source, target, result, options, {});
  }
  const Holdings end = holdings();
  for (const char* ending : {".json", ".vtp", ".residues.csv"}) std::filesystem::remove(prefix + ending);
  const double growth = (end.resident_MB - warm.resident_MB) / warm.resident_MB;
  std::printf("growth after run %d: %.2f %% of memory, %d descriptors, %d threads\n", n_warm, 100 * growth,
              end.n_descriptors - warm.n_descriptors, end.n_threads - warm.n_threads);
  return growth < 0.01 && end.n_descriptors == warm.n_descriptors && end.n_threads <= warm.n_threads ? 0 : 1;
}
