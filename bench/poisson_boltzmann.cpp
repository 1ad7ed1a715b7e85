// poisson_boltzmann.cpp: times the Poisson-Boltzmann potential beside APBS, shows what a start from an earlier
// potential saves and how values at a surface depend on the spacing, as CSV; then one line for each figure that is
// asked for.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "dcd_frames.h"
#include "engine/engine.h"
#include "engine/poisson_boltzmann.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"

namespace {

using espdiff::Lattice;
using espdiff::Molecule;
using espdiff::PoissonBoltzmannOptions;
using espdiff::PoissonBoltzmannReport;
using espdiff::Vec3d;

const char* const kFkbp = "/usr/share/apbs/examples/FKBP/1d7h-min.pqr";

std::string data_folder() {
  const char* const given = std::getenv("ESPDIFF_DATA");
  return given != nullptr ? given : ESPDIFF_SOURCE_DIR "/../shared/data";
}

bool is_there(const std::string& path) {
  if (std::filesystem::exists(path)) return true;
  std::fprintf(stderr, "SKIPPED: %s is absent\n", path.c_str());
  return false;
}

struct Seconds {
  double wall = 0, cpu = 0;
};

double cpu_seconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

/// The least of some repeats, by processor time.
Seconds timed(int repeats, int who, const std::function<void()>& work) {
  Seconds best{1e300, 1e300};
  for (int i = 0; i < repeats; ++i) {
    const double cpu = cpu_seconds(who);
    const auto start = std::chrono::steady_clock::now();
    work();
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double used = cpu_seconds(who) - cpu;
    if (used < best.cpu) best = {wall, used};
  }
  return best;
}

/// n^3 points over a cube of the given side around the molecule's middle.
Lattice cube(const Molecule& m, int n, double side) {
  const double h = side / (n - 1);
  Lattice lattice = espdiff::poisson_boltzmann_lattice(m.positions, m.radii, h, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.origin[static_cast<int>(axis)] += 0.5 * h * (lattice.size[axis] - n);
    lattice.size[axis] = n;
  }
  return lattice;
}

/// The border of one grid alone, which all tables but that of borders are of.
PoissonBoltzmannOptions one_grid() {
  PoissonBoltzmannOptions options;
  options.far_boundary = espdiff::FarBoundary::kDebyeHueckel;
  return options;
}

espdiff::GridPtr potential(espdiff::Engine& engine, const Molecule& m, const Lattice& lattice,
                           PoissonBoltzmannReport* report, const espdiff::GridPtr& start = nullptr,
                           const PoissonBoltzmannOptions& options = one_grid()) {
  return engine.poisson_boltzmann(m.positions, m.radii, m.charges, lattice, options, {}, start, {}, report);
}

void print_row(const std::string& what, int threads, const Lattice& lattice, const Seconds& t,
               const PoissonBoltzmannReport& report) {
  std::printf("%s,%d,%zu,%.4f,%d,%.2e,%.2e,%.3f,%.3f\n", what.c_str(), threads, lattice.n_points(), lattice.step[0].x,
              report.cycles, report.start_residual, report.relative_residual, t.cpu, t.wall);
  std::fflush(stdout);
}

/// Sentences for the end: each a figure beside what is asked for.
class Summary {
 public:
  template <typename... Values>
  void add(const char* format, Values... values) {
    char text[240];
    std::snprintf(text, sizeof text, format, values...);
    lines_.emplace_back(text);
  }
  void print() const {
    for (const std::string& line : lines_) std::printf("# %s\n", line.c_str());
  }

 private:
  std::vector<std::string> lines_;
};

/// APBS on the same grid, focusing from one of 1.7 times its extent, without writing the potential.
Seconds apbs_seconds(const Lattice& lattice, int repeats) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "espdiff-bench-apbs";
  std::filesystem::create_directories(folder);
  const double side = lattice.step[0].x * (lattice.size[0] - 1);
  std::ofstream in(folder / "in.apbs");
  in << "read\nmol pqr " << kFkbp << "\nend\nelec\nmg-auto\ndime " << lattice.size[0] << " " << lattice.size[0] << " "
     << lattice.size[0] << "\ncglen " << 1.7 * side << " " << 1.7 * side << " " << 1.7 * side << "\nfglen " << side
     << " " << side << " " << side
     << "\ncgcent mol 1\nfgcent mol 1\nmol 1\nlpbe\nbcfl mdh\nion charge 1 conc 0.15 radius 2\nion charge -1 conc 0.15 "
        "radius 2\npdie 2\nsdie 78.54\nchgm spl2\nsrfm smol\nsrad 1.4\nswin 0.3\nsdens 10\ntemp 300\ncalcenergy "
        "no\ncalcforce no\nend\nquit\n";
  in.close();
  const std::string command = "cd " + folder.string() + " && OMP_NUM_THREADS=1 apbs in.apbs >apbs.log 2>&1";
  const Seconds seconds = timed(repeats, RUSAGE_CHILDREN, [&] {
    if (std::system(command.c_str()) != 0) throw espdiff::InputError("apbs failed; see " + folder.string());
  });
  std::filesystem::remove_all(folder);
  return seconds;
}

constexpr double kFkbpSide_A = 67.2;  // 97 points of 0.7 A

void measure_speed(int repeats, Summary& summary) {
  if (!is_there(kFkbp)) return;
  const Molecule m = espdiff::read_structure(kFkbp);
  const Lattice lattice = cube(m, 97, kFkbpSide_A);
  Seconds one, two;
  for (const int threads : {1, 2}) {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, threads);
    PoissonBoltzmannReport report;
    const Seconds t = timed(repeats, RUSAGE_SELF, [&] { potential(*engine, m, lattice, &report); });
    print_row("fkbp_97", threads, lattice, t, report);
    (threads == 1 ? one : two) = t;
    if (threads == 1)
      summary.add("memory: %.0f bytes a grid point, asked for before anything is computed", report.bytes_per_point);
  }
  if (std::system("command -v apbs >/dev/null 2>&1") != 0) {
    std::fprintf(stderr, "SKIPPED: apbs is not on PATH\n");
    return;
  }
  const Seconds apbs = apbs_seconds(lattice, std::min(repeats, 3));
  print_row("fkbp_97_apbs", 1, lattice, apbs, {});
  summary.add("processor time on one thread over APBS': %.3f (at most 0.2)", one.cpu / apbs.cpu);
  summary.add("wall time on two threads over APBS': %.3f (at most 0.1)", two.wall / apbs.wall);
}

void measure_sizes(int repeats, int largest, Summary& summary) {
  if (!is_there(kFkbp)) return;
  const Molecule m = espdiff::read_structure(kFkbp);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  double first = 0, last = 0, n_first = 0, n_last = 0, steepest = 0;
  for (const int n : {65, 97, 129, 193, 257}) {
    if (n > largest) break;
    const Lattice lattice = cube(m, n, kFkbpSide_A);
    PoissonBoltzmannReport report;
    const Seconds t = timed(n > 129 ? 1 : repeats, RUSAGE_SELF, [&] { potential(*engine, m, lattice, &report); });
    print_row("fkbp_size_" + std::to_string(n), 1, lattice, t, report);
    const auto points = static_cast<double>(lattice.n_points());
    if (first == 0) {
      first = t.cpu;
      n_first = points;
    } else {
      steepest = std::max(steepest, std::log(t.cpu / last) / std::log(points / n_last));
    }
    last = t.cpu;
    n_last = points;
  }
  if (n_last > n_first)
    summary.add(
        "slope of the time in log-log from 65^3 to the largest grid: %.2f, at most %.2f between neighbours (at most "
        "1.1)",
        std::log(last / first) / std::log(n_last / n_first), steepest);
}

Molecule moved(Molecule m, double by_A) {
  std::mt19937 generator(3);
  std::normal_distribution<double> along(0, by_A / std::sqrt(3.0));
  for (Vec3d& p : m.positions) p = p + Vec3d{along(generator), along(generator), along(generator)};
  return m;
}

/// What a start from an earlier potential saves: of adenylate kinase's frame before, of a frame whose atoms lie ever
/// nearer, and of the same frame on a grid of half the spacing, which is as good as any earlier potential can be.
void measure_starts(Summary& summary) {
  const std::string folder = data_folder() + "/traj_adk";
  if (!is_there(folder + "/adk_open.pqr") || !is_there(folder + "/adk_dims.dcd")) return;
  const Molecule open = espdiff::read_structure(folder + "/adk_open.pqr");
  const auto frame = [&](std::size_t i) { return espdiff_bench::read_frame(open, folder + "/adk_dims.dcd", i); };
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 0);
  const Molecule before = frame(40), next = frame(41);
  const Lattice lattice = espdiff::poisson_boltzmann_lattice(before.positions, before.radii, 0.5, 12);
  const auto row = [&](const std::string& name, const Molecule& m, const Lattice& on, const espdiff::GridPtr& start) {
    PoissonBoltzmannReport report;
    espdiff::GridPtr made;
    const Seconds t = timed(1, RUSAGE_SELF, [&] { made = potential(*engine, m, on, &report, start); });
    print_row("start_" + name, 0, on, t, report);
    return std::make_pair(made, report);
  };
  const auto [from, cold] = row("zero", before, lattice, nullptr);
  const PoissonBoltzmannReport frame_before = row("frame_before", next, lattice, from).second;
  for (const double by_A : {0.05, 0.01, 0.001})
    row("moved_by_" + std::to_string(by_A), moved(before, by_A), lattice, from);
  Lattice fine = lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    fine.size[axis] = 2 * fine.size[axis] - 1;
    fine.step[axis] = 0.5 * fine.step[axis];
  }
  const PoissonBoltzmannReport finer =
      row("itself_at_half_the_spacing", before, lattice, row("fine", before, fine, nullptr).first).second;
  summary.add(
      "cycles from zero %d, from the frame before %d (half is asked for), from the same frame at half the spacing %d",
      cold.cycles, frame_before.cycles, finer.cycles);
}

/// Pairs whose atoms lie in one frame: both potentials on the first one's surface.
void study_spacing(const std::string& name, const std::string& first, const std::string& second, double finest,
                   Summary& summary) {
  if (!is_there(first) || !is_there(second)) return;
  const Molecule a = espdiff::read_structure(first), b = espdiff::read_structure(second);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 0);
  const auto atoms = engine->upload_atoms(a.positions, a.radii, std::vector<std::int32_t>(a.size(), 0));
  const auto surface = engine->project(engine->isosurface(engine->density(atoms, 1.0), 0.5F), atoms, 0.5F, 1.0);
  double usual = 0, halved = 0;
  for (const auto smoothing : {espdiff::DielectricSmoothing::kEdges, espdiff::DielectricSmoothing::kNinePoint}) {
    for (const double h : {1.0, 0.7, 0.5, 0.35, 0.25}) {
      if (h < finest) break;
      PoissonBoltzmannOptions options = one_grid();
      options.smoothing = smoothing;
      const auto on_surface = [&](const Molecule& m) {
        const Lattice lattice = espdiff::poisson_boltzmann_lattice(a.positions, a.radii, h, 12);
        return engine->download(engine->sample(potential(*engine, m, lattice, nullptr, nullptr, options), surface));
      };
      const std::vector<float> at_a = on_surface(a), at_b = on_surface(b);
      double squares = 0, differences = 0;
      for (std::size_t v = 0; v < at_a.size(); ++v) {
        squares += static_cast<double>(at_a[v]) * static_cast<double>(at_a[v]);
        differences += std::fabs(static_cast<double>(at_b[v]) - static_cast<double>(at_a[v]));
      }
      const double n = static_cast<double>(at_a.size());
      std::printf("spacing_%s_%s,%.2f,rms %.4f,mean absolute difference %.4f\n", name.c_str(),
                  smoothing == espdiff::DielectricSmoothing::kEdges ? "edges" : "nine_point", h, std::sqrt(squares / n),
                  differences / n);
      std::fflush(stdout);
      if (smoothing == espdiff::DielectricSmoothing::kEdges && h == espdiff::kUsualPbSpacing_A) usual = differences / n;
      if (smoothing == espdiff::DielectricSmoothing::kEdges && h == 0.5 * espdiff::kUsualPbSpacing_A)
        halved = differences / n;
    }
  }
  if (halved > 0)
    summary.add("%s: halving the usual spacing changes the mean absolute difference by %.2f %% (at most 3 %%)",
                name.c_str(), 100 * std::fabs(halved / usual - 1));
}

/// What the border's values do to potentials on the surface and outside it: against 30 A of solvent.
void measure_borders(const std::string& name, const std::string& path, int repeats) {
  if (!is_there(path)) return;
  const Molecule m = espdiff::read_structure(path);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const auto atoms = engine->upload_atoms(m.positions, m.radii, std::vector<std::int32_t>(m.size(), 0));
  const espdiff::Mesh mesh =
      engine->download(engine->project(engine->isosurface(engine->density(atoms, 1.0), 0.5F), atoms, 0.5F, 1.0));
  std::vector<espdiff::MeshPtr> surfaces;
  for (const double offset_A : {0.0, 1.4, 3.0}) {
    espdiff::Mesh outside = mesh;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      outside.positions[v] = outside.positions[v] + static_cast<float>(offset_A) * mesh.normals[v];
    surfaces.push_back(engine->upload_mesh(outside));
  }
  std::vector<std::vector<float>> wanted;
  const auto row = [&](const std::string& border, double padding_A, espdiff::FarBoundary far_boundary) {
    PoissonBoltzmannOptions options;
    options.far_boundary = far_boundary;
    const Lattice lattice = espdiff::poisson_boltzmann_lattice(m.positions, m.radii, 0.5, padding_A);
    espdiff::GridPtr map;
    const Seconds t = timed(wanted.empty() ? 1 : repeats, RUSAGE_SELF,
                            [&] { map = potential(*engine, m, lattice, nullptr, nullptr, options); });
    std::printf("border_%s,%s,%zu points,%.3f s", name.c_str(), border.c_str(), lattice.n_points(), t.cpu);
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const std::vector<float> found = engine->download(engine->sample(map, surfaces[s]));
      if (wanted.size() == s) wanted.push_back(found);
      double squares = 0, differences = 0;
      for (std::size_t v = 0; v < found.size(); ++v) {
        const double value = static_cast<double>(wanted[s][v]), off = static_cast<double>(found[v]) - value;
        squares += value * value;
        differences += off * off;
      }
      std::printf(",%.3f %%", 100 * std::sqrt(differences / squares));
    }
    std::printf("\n");
    std::fflush(stdout);
  };
  row("30 A", 30, espdiff::FarBoundary::kDebyeHueckel);
  row("12 A", 12, espdiff::FarBoundary::kDebyeHueckel);
  row("6 A and a wider grid", 6, espdiff::FarBoundary::kFocus);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the Poisson-Boltzmann potential, beside APBS, and how it depends on the spacing.");
  int repeats = 5, largest = 257;
  double finest = 0.25;
  bool no_study = false;
  std::vector<std::string> borders;
  app.add_option("--repeats", repeats, "The least of so many times counts");
  app.add_option("--largest", largest, "Points along an edge of the largest grid");
  app.add_option("--finest", finest, "Finest spacing of the study, Angstrom");
  app.add_flag("--no-study", no_study, "Times alone");
  app.add_option("--borders", borders, "Nothing but what the border's values change, for these PQR files");
  CLI11_PARSE(app, argc, argv);
  try {
    for (const std::string& path : borders) measure_borders(std::filesystem::path(path).stem().string(), path, repeats);
    if (!borders.empty()) return 0;
    std::printf("case,threads,points,spacing_A,cycles,start_residual,residual,cpu_s,wall_s\n");
    Summary summary;
    measure_speed(repeats, summary);
    measure_sizes(repeats, largest, summary);
    measure_starts(summary);
    const std::string data = data_folder(), pqr = data + "/pqr_pdb2pqr/1AJJ_pH", t4l = data + "/pair_t4l_maps/",
                      tim = data + "/pair_tim_maps/";
    if (!no_study) {
      study_spacing("1AJJ", pqr + "7_AMBER.pqr", pqr + "2_AMBER.pqr", finest, summary);
      study_spacing("T4 lysozyme", t4l + "3lzm.pqr", t4l + "181l_fit.pqr", finest, summary);
      study_spacing("TIM", tim + "scTIM_chainA.pqr", tim + "dTIM_chainA.pqr", finest, summary);
    }
    summary.print();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff_poisson_boltzmann: %s\n", error.what());
    return 1;
  }
}
