// ensemble_scale.cpp: the file and the statistics of an ensemble of any size, with its peak of memory.
//
//     espdiff_ensemble_scale 10000 5000 /tmp/scale.h5            # goes on with a file that is there
//     espdiff_ensemble_scale 10000 5000 /tmp/scale.1.h5 1/4      # writes a quarter, for espdiff merge
//     espdiff_ensemble_scale 1000 5000 /tmp/scale.h5 matrix      # the states as a matrix, with its files
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/counter_random.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_result.h"
#include "ensemble/result/states.h"
#include "ensemble/result/template_values.h"
#include "matrix/write_matrix.h"

using namespace espdiff;

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// A sphere of 20 A with about n vertices, by longitude and latitude.
TemplateSurface sphere(std::size_t n) {
  constexpr double kPi = 3.14159265358979323846;
  const auto rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(n) / 2)), columns = 2 * rows;
  TemplateSurface surface;
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double a = kPi * (i + 0.5) / rows, b = 2 * kPi * j / columns;
      const Vec3d p{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
      surface.positions.push_back(20.0 * p);
      surface.normals.push_back(static_cast<Vec3f>(p));
      surface.residue.push_back(static_cast<std::int32_t>(i));
    }
  }
  for (std::uint32_t i = 0; i + 1 < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns, c = a + columns, d = b + columns;
      surface.triangles.push_back({a, c, b});
      surface.triangles.push_back({b, c, d});
    }
  }
  return surface;
}

EnsemblePlan plan_of(std::size_t n_frames, std::size_t n_residues) {
  EnsemblePlan plan;
  plan.version = "bench";
  plan.device = "cpu";
  plan.potential = "synthetic";
  plan.potential_unit = "kT/e";
  plan.template_name = "a sphere";
  for (std::size_t i = 0; i < n_residues; ++i) plan.residues.push_back("ALA " + std::to_string(i + 1));
  for (std::size_t r = 0; r < 8; ++r)
    plan.replicates.push_back(
        {r < 4 ? "wild" : "mutant", std::to_string(r), {std::to_string(r)}, {std::to_string(r)}, n_frames / 8});
  return plan;
}

/// The same frames as the variants of a matrix.
EnsemblePlan as_matrix(EnsemblePlan plan, std::size_t n_states) {
  MatrixPlan matrix;
  matrix.potential = plan.potential;
  matrix.potential_unit = plan.potential_unit;
  for (std::size_t i = 0; i < n_states; ++i) matrix.variants.push_back({"s" + std::to_string(i), "", {}});
  plan.matrix = std::make_shared<const MatrixPlan>(matrix);
  plan.replicates = {{"variants", "variants", {"all"}, {"0"}, n_states}};
  return plan;
}

int time_matrix(const std::string& path) {
  const EnsembleFile file(path, false);
  const double start = seconds();
  const Matrix matrix = matrix_through_template(file, {}, {});
  const double made = seconds();
  std::printf("N x N       %7.1f s  %7.0f MB peak\n", made - start, peak_megabytes());
  write_matrix(path, matrix, find_metric("mean_abs_difference"));
  std::printf("files       %7.1f s  %7.0f MB peak\n", seconds() - made, peak_megabytes());
  return 0;
}

/// Frames that the file lacks, from `begin` to `end`: noise that remembers the frame before, so it is made from the
/// first frame on.
void write_frames(EnsembleFile& file, std::size_t begin, std::size_t end) {
  std::vector<float> values(file.n_vertices(), 0);
  for (std::size_t f = 0; f < end; ++f) {
    for (std::size_t v = 0; v < values.size(); ++v) {
      const double noise = static_cast<double>(random_bits(1, f, v) >> 11) / 9007199254740992.0 - 0.5;
      values[v] = static_cast<float>(0.8 * static_cast<double>(values[v]) + noise);
    }
    if (f >= begin && !file.has(f)) file.write(f, values, {1, 0, 0, 0, 1, static_cast<double>(values[0]), true, ""});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::fprintf(stderr, "usage: espdiff_ensemble_scale FRAMES VERTICES FILE.h5 [I/N|matrix]\n");
    return 2;
  }
  const std::size_t n_frames = std::strtoul(argv[1], nullptr, 10);
  const TemplateSurface surface = sphere(std::strtoul(argv[2], nullptr, 10));
  const bool is_matrix = argc == 5 && std::string(argv[4]) == "matrix";
  const std::string path = argv[3], part = argc == 5 && !is_matrix ? argv[4] : "1/1";
  const std::size_t index = std::strtoul(part.c_str(), nullptr, 10),
                    n_parts = std::strtoul(part.c_str() + part.find('/') + 1, nullptr, 10);
  if (index < 1 || index > n_parts || part.find('/') == std::string::npos) {
    std::fprintf(stderr, "espdiff_ensemble_scale: %s is not a part I/N\n", part.c_str());
    return 2;
  }
  const double start = seconds();
  const EnsemblePlan plan = plan_of(n_frames, surface.residue.back() + 1U);
  if (!std::filesystem::exists(path)) EnsembleFile::create(path, is_matrix ? as_matrix(plan, n_frames) : plan, surface);
  {
    EnsembleFile file(path, true);
    if (file.n_done() > 0) std::printf("%zu frames were there\n", file.n_done());
    write_frames(file, n_frames * (index - 1) / n_parts, n_frames * index / n_parts);
  }
  const double written = seconds();
  std::printf("%s frames of %zu vertices\nwrite       %7.1f s  %7.0f MB peak\n", argv[1], surface.positions.size(),
              written - start, peak_megabytes());
  if (n_parts > 1) return 0;
  if (is_matrix) return time_matrix(path);
  const EnsembleFile file(path, false);
  const double opened = seconds();
  std::printf("check       %7.1f s  %7.0f MB peak\n", opened - written, peak_megabytes());
  const EnsembleResult result = analyse_ensemble(file, {});
  std::printf("statistics  %7.1f s  %7.0f MB peak\n", seconds() - opened, peak_megabytes());
  if (file.plan().n_frames() <= 2000) {
    const double before = seconds();
    const StateTable states = compare_states(file, result);
    std::printf("states      %7.1f s  %7.0f MB peak, %zu frames with each other\n", seconds() - before,
                peak_megabytes(), states.size());
  }
  std::printf("smallest p  %g; median g of the first replicate %.1f (9 planted)\n", result.test.smallest_p,
              result.replicates[0].inefficiency);
  return 0;
}
