// pme.cpp: times the particle-mesh Ewald potential and a plain forward and inverse Fourier transform of the same grid,
// as CSV. bench/pmepot.tcl times VMD's PMEPot for the same numbers of atoms and grids.
#include <fftw3.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "dcd_frames.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "random_charges.h"

namespace {

using espdiff::PmeCell;
using espdiff::PmeOptions;
using espdiff::Vec3d;

struct Case {
  std::string name;
  std::vector<Vec3d> positions;
  std::vector<float> charges;
  PmeCell cell;
  int n_points = 0;  ///< along each edge
};

Case random_case(const std::string& name, std::size_t n_atoms, double edge, int n_points) {
  espdiff_bench::RandomCharges of = espdiff_bench::random_charges(n_atoms, edge);
  return {name, std::move(of.positions), std::move(of.charges), of.cell, n_points};
}

/// The charges of an Amber topology: 5 fields of 16 columns a line, in kcal/mol's unit of charge.
std::vector<float> prmtop_charges(const std::string& path) {
  constexpr double kAmberCharge = 18.2223;
  std::ifstream in(path);
  std::vector<float> charges;
  bool is_inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '%') {
      if (line.find("FLAG") != std::string::npos) is_inside = line.find("FLAG CHARGE") != std::string::npos;
      continue;
    }
    for (std::size_t at = 0; is_inside && at + 16 <= line.size(); at += 16)
      charges.push_back(static_cast<float>(std::strtod(line.substr(at, 16).c_str(), nullptr) / kAmberCharge));
  }
  return charges;
}

/// DHFR in water, the joint Amber-CHARMM benchmark: one frame.
Case dhfr_case(const std::string& folder) {
  espdiff::Molecule molecule;
  molecule.charges = prmtop_charges(folder + "/JAC.prmtop");
  molecule.atoms.resize(molecule.charges.size());
  molecule.positions.resize(molecule.charges.size());
  const espdiff::Molecule frame = espdiff_bench::read_frame(molecule, folder + "/JAC_from_ncrst.dcd", 0);
  constexpr double kEdge = 62.23;
  return {"dhfr", frame.positions, molecule.charges, espdiff_bench::cubic_cell(kEdge), 64};
}

double median_ms(int repeats, const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < repeats + 2; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    if (i >= 2)
      times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  return times[times.size() / 2];
}

/// FFTW's three-dimensional transform, forward and inverse, single precision, one thread, estimated plans.
double plain_fft_ms(int n, int repeats) {
  const std::size_t n_modes =
      static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n / 2 + 1);
  fftwf_complex* const grid = fftwf_alloc_complex(n_modes);
  float* const values = reinterpret_cast<float*>(grid);
  const fftwf_plan there = fftwf_plan_dft_r2c_3d(n, n, n, values, grid, FFTW_ESTIMATE);
  const fftwf_plan back = fftwf_plan_dft_c2r_3d(n, n, n, grid, values, FFTW_ESTIMATE);
  std::fill(values, values + 2 * n_modes, 0.0F);
  const double ms = median_ms(repeats, [&] {
    fftwf_execute(there);
    fftwf_execute(back);
  });
  fftwf_destroy_plan(there);
  fftwf_destroy_plan(back);
  fftwf_free(grid);
  return ms;
}

void measure(const Case& c, int repeats, int n_threads, const PmeOptions& base, const char* mode) {
  PmeOptions options = base;
  options.size = {c.n_points, c.n_points, c.n_points};
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
  espdiff::Grid map;
  const double ms = median_ms(
      repeats, [&] { map = engine->download(engine->pme_potential(c.positions, c.charges, c.cell, options, {}, {})); });
  std::printf("%s,%zu,%d,%s,%d,%s,%d,%.2f,%.2f\n", c.name.c_str(), c.positions.size(), c.n_points, mode, options.order,
              options.precision == espdiff::Precision::kDouble ? "double" : "single", n_threads, ms,
              plain_fft_ms(c.n_points, repeats));
  std::fflush(stdout);
}

void measure_all(const Case& c, int repeats) {
  for (const int n_threads : {1, 2}) {
    PmeOptions options;
    options.order = 4;
    options.compatible = true;
    measure(c, repeats, n_threads, options, "compatible");
    options.compatible = false;
    measure(c, repeats, n_threads, options, "points");
    options.order = 6;
    measure(c, repeats, n_threads, options, "points");
    options.precision = espdiff::Precision::kDouble;
    measure(c, repeats, n_threads, options, "points");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the PME potential: from atoms on the host to the map on the host.");
  bool large = false;
  app.add_flag("--large", large, "Also a million atoms on 216^3 points");
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("case,atoms,grid,mode,order,precision,threads,ms,plain_fft_ms\n");
    measure_all(random_case("5k", 5000, 80, 80), 15);
    measure_all(random_case("50k", 50000, 80, 80), 15);
    const char* const given = std::getenv("ESPDIFF_DATA");
    const std::string folder =
        (given != nullptr ? given : ESPDIFF_SOURCE_DIR "/../shared/data") + std::string("/box_dhfr_jac");
    if (std::filesystem::is_directory(folder)) {
      measure_all(dhfr_case(folder), 15);
    } else {
      std::fprintf(stderr, "SKIPPED: dhfr: %s is absent; set ESPDIFF_DATA\n", folder.c_str());
    }
    if (large) measure_all(random_case("1M", 1000000, 216, 216), 3);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff_pme: %s\n", error.what());
    return 1;
  }
}
