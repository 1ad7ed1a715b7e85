// map_errors.cpp: how many errors planted into given maps the check of maps finds, and how many right maps it refuses;
// the table of bench/study_notes.md. Each map is checked as a comparison checks it, on the surface of its own molecule.
// espdiff_map_errors [--limits] [PQR...]: the proteins below, and further ones, such as those of bench/planted_inputs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "input_checks/map_check.h"
#include "input_checks/map_warnings.h"
#include "io/structures/structure_file.h"
#include "mapping/build_surface.h"
#include "options/options.h"
#include "potential/potential_series.h"
#include "real_pairs.h"

namespace {

using namespace espdiff;

constexpr double kTemperature_K = 300;
const std::string kApbs = "/usr/share/apbs/examples/";

/// The proteins on which the limits were chosen, and those that were not looked at.
const std::vector<std::string> kLimits = {"series19_ubq_2k39/m00.pqr", "series19_ubq_2k39/m04.pqr",
                                          "pair_t4l_maps/3lzm.pqr", "pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr",
                                          kApbs + "FKBP/1d7h-min.pqr"};
const std::vector<std::string> kOthers = {kApbs + "bem/test_proteins/1a63.pqr",
                                          kApbs + "bem/test_proteins/1bbl.pqr",
                                          kApbs + "bem/test_proteins/451c.pqr",
                                          kApbs + "pbsam-barn_bars/barnase.pqr",
                                          kApbs + "pbsam-barn_bars/barstar.pqr",
                                          kApbs + "hca-bind/hca.pqr",
                                          kApbs + "pka-lig/bx6_7_apo_apbs.pqr",
                                          kApbs + "bem-pKa/test_proteins/2LZT-noASP66.pqr",
                                          kApbs + "protein-rna/model_outNB.pqr",
                                          kApbs + "protein-rna/model_outBoxB19.pqr",
                                          kApbs + "bem-binding-energy/test_proteins/1d30_monomer1.pqr",
                                          kApbs + "helix/Membrane-helix-0.pqr",
                                          kApbs + "protein-rna/model_outNpep.pqr",
                                          kApbs + "actin-dimer/mol1.pqr",
                                          kApbs + "misc/mache.pqr",
                                          "map_apbs_fas2/fas2.pqr",
                                          "ref_apbs/1tca.pqr",
                                          "traj_adk/adk_open.pqr"};

struct Row {
  int n = 0, refused = 0, warned = 0;
  double least = 1, low = 1e9, high = -1e9;
};

/// The rows of a table, in the order in which they come. Right maps that are refused and errors that are passed over
/// are told on stderr.
class Table {
 public:
  explicit Table(bool of_right_maps) : of_right_maps_(of_right_maps) {}

  void add(const std::string& kind, const std::string& subject, const std::vector<Warning>& warnings,
           const std::shared_ptr<const MapCheck>& check) {
    if (rows_.count(kind) == 0) order_.push_back(kind);
    Row& row = rows_[kind];
    ++row.n;
    const bool refuses = std::any_of(warnings.begin(), warnings.end(), [](const Warning& w) { return w.refuses; });
    row.refused += refuses ? 1 : 0;
    row.warned += !refuses && !warnings.empty() ? 1 : 0;
    if (of_right_maps_ ? refuses : warnings.empty())
      std::fprintf(stderr, "%s, %s: %s\n", kind.c_str(), subject.c_str(),
                   refuses ? warnings.front().text.plain().c_str() : "nothing is said");
    if (!check) return;
    row.least = std::min(row.least, check->best().correlation);
    row.low = std::min(row.low, check->best().slope);
    row.high = std::max(row.high, check->best().slope);
  }

  void print(const char* title) const {
    std::printf(
        "| %s | maps | refused | warned of | neither | least correlation | slopes |\n|---|---|---|---|---|---|---|\n",
        title);
    for (const std::string& kind : order_) {
      const Row& r = rows_.at(kind);
      std::printf("| %s | %d | %d | %d | %d | %.3f | %.3g to %.3g |\n", kind.c_str(), r.n, r.refused, r.warned,
                  r.n - r.refused - r.warned, r.least, r.low, r.high);
    }
    std::printf("\n");
    std::fflush(stdout);
  }

 private:
  bool of_right_maps_;
  std::map<std::string, Row> rows_;
  std::vector<std::string> order_;
};

struct Subject {
  std::string name;
  Molecule molecule;
  std::unique_ptr<MapReferences> references;
  Grid right;  ///< pb, 1 A
};

Grid pb(Engine& engine, const Molecule& m, double spacing_A, const std::function<void(PotentialOptions&)>& change) {
  PotentialOptions o;
  o.method = PotentialMethod::kPoissonBoltzmann;
  o.pb_spacing_A = spacing_A;
  o.pb.tolerance = 1e-4;
  change(o);
  return potential_map(engine, m, o, {});
}

Grid other(Engine& engine, const Molecule& m, PotentialMethod method, double resolution_A,
           const std::function<void(PotentialOptions&)>& change) {
  PotentialOptions o;
  o.method = method;
  o.grid.resolution_A = resolution_A;
  change(o);
  return potential_map(engine, m, o, {});
}

Grid scaled(Grid map, double factor) {
  for (float& value : map.values) value *= static_cast<float>(factor);
  return map;
}

Grid shifted(Grid map, double distance_A) {
  map.lattice.origin += distance_A / std::sqrt(3.0) * Vec3d{1, 1, 1};
  return map;
}

/// Charges on the nearest points of a lattice.
Grid density(Grid map, const Molecule& m) {
  std::fill(map.values.begin(), map.values.end(), 0.0F);
  for (std::size_t a = 0; a < m.size(); ++a) {
    const Vec3d d = m.positions[a] - map.lattice.origin;
    std::size_t index = 0, stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<int>(axis);
      index += stride * static_cast<std::size_t>(std::lround(d[i] / map.lattice.step[axis][i]));
      stride *= static_cast<std::size_t>(map.lattice.size[axis]);
    }
    map.values[index] += m.charges[a];
  }
  return map;
}

void check(Table& table, const std::string& kind, const Subject& subject, const Grid& map) {
  std::shared_ptr<const MapCheck> outcome;
  const std::vector<Warning> warnings = map_warnings("source", map, *subject.references, kTemperature_K, outcome);
  table.add(kind, subject.name, warnings, outcome);
}

Subject make_subject(Engine& engine, const std::string& path) {
  Subject s{std::filesystem::path(path).stem().string(), read_structure(path, {}), nullptr, {}};
  s.right = pb(engine, s.molecule, 1, [](auto&) {});
  return s;
}

/// References hold on to the molecule, so they are made where it stays.
void add_references(Engine& engine, Subject& s, double& seconds) {
  std::vector<std::pair<std::string, double>> times;
  StageClock clock(times);
  const RigidTransform to_common = principal_frame(s.molecule.positions);
  const Surface surface = build_surface(engine, s.molecule, to_common, SurfaceOptions{}, {}, clock);
  seconds += 1e-3 * engine.elapsed_ms([&] {
    s.references =
        std::make_unique<MapReferences>(engine, s.molecule, to_common, surface, 0.5F, kTemperature_K, Progress());
  });
}

void right_maps(Engine& engine, const Subject& s, Table& table) {
  const Molecule& m = s.molecule;
  const auto pb_map = [&](const char* kind, double spacing_A, const std::function<void(PotentialOptions&)>& change) {
    check(table, kind, s, pb(engine, m, spacing_A, change));
  };
  check(table, "pb, 0.15 mol/l, 1 A", s, s.right);
  pb_map("pb, 2 A", 2, [](auto&) {});
  pb_map("pb, no salt", 1, [](auto& o) { o.pb.ionic_strength = 0; });
  pb_map("pb, 0.5 mol/l", 1, [](auto& o) { o.pb.ionic_strength = 0.5; });
  pb_map("pb, dielectric 4 inside", 1, [](auto& o) { o.pb.solute_dielectric = 4; });
  pb_map("pb, dielectric 20 inside", 1, [](auto& o) { o.pb.solute_dielectric = 20; });
  pb_map("pb, boundary vdw, nine-point", 1, [](auto& o) {
    o.pb.dielectric_boundary = DielectricBoundary::kVanDerWaals;
    o.pb.smoothing = DielectricSmoothing::kNinePoint;
  });
  pb_map("pb, boundary gaussian", 1, [](auto& o) { o.pb.dielectric_boundary = DielectricBoundary::kGaussian; });
  const auto map = [&](const char* kind, PotentialMethod method, double resolution_A,
                       const std::function<void(PotentialOptions&)>& change) {
    check(table, kind, s, other(engine, m, method, resolution_A, change));
  };
  map("coulomb, 2 A", PotentialMethod::kCoulomb, 2, [](auto&) {});
  map("coulomb, dielectric 4", PotentialMethod::kCoulomb, 2, [](auto& o) { o.coulomb.dielectric = 4; });
  map("coulomb, dielectric 4 r", PotentialMethod::kCoulomb, 2, [](auto& o) {
    o.coulomb.dielectric = 4;
    o.coulomb.distance_dependent = true;
  });
  map("pme, smooth part, 1 A", PotentialMethod::kPme, 1, [](auto&) {});
  map("pme, smooth part, 2 A", PotentialMethod::kPme, 2, [](auto&) {});
  map("pme as PMEPot's", PotentialMethod::kPme, 1, [](auto& o) {
    o.pme.compatible = true;
    o.pme.order = 4;
  });
  map("pme, smooth part, beta 0.4", PotentialMethod::kPme, 1, [](auto& o) { o.pme.ewald_factor = 0.4; });
}

void planted(const Subject& s, const Subject& another, Table& table) {
  const double kcal = conversion_factor(PotentialUnit::kKtPerE, PotentialUnit::kKcalPerMolE, kTemperature_K),
               mv = conversion_factor(PotentialUnit::kKtPerE, PotentialUnit::kMillivolt, kTemperature_K),
               kj = conversion_factor(PotentialUnit::kKtPerE, PotentialUnit::kKjPerMolE, kTemperature_K);
  check(table, "mV read as kT/e", s, scaled(s.right, mv));
  check(table, "V read as kT/e", s, scaled(s.right, mv / 1000));
  check(table, "kJ/(mol e) read as kT/e", s, scaled(s.right, kj));
  check(table, "kcal/(mol e) read as kT/e", s, scaled(s.right, kcal));
  Grid unknown = s.right;
  unknown.unit = PotentialUnit::kUnknown;
  check(table, "no unit", s, unknown);
  check(table, "times 10", s, scaled(s.right, 10));
  check(table, "times 0.1", s, scaled(s.right, 0.1));
  check(table, "sign turned", s, scaled(s.right, -1));
  for (const double distance_A : {1.0, 2.0, 3.0, 5.0})
    check(table, "shifted by " + std::to_string(static_cast<int>(distance_A)) + " A", s, shifted(s.right, distance_A));
  check(table, "charge density", s, density(s.right, s.molecule));
  Grid foreign = another.right;
  const auto middle = [](const Molecule& m) {
    Vec3d sum{};
    for (const Vec3d& p : m.positions) sum += p;
    return (1 / static_cast<double>(m.size())) * sum;
  };
  foreign.lattice.origin += middle(s.molecule) - middle(another.molecule);
  check(table, "map of another molecule", s, foreign);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = espdiff_bench::data_folder();
  const bool of_limits = argc > 1 && std::strcmp(argv[1], "--limits") == 0;
  const std::unique_ptr<Engine> engine = select_engine(DeviceChoice::kCpu, 0);
  std::vector<Subject> subjects;
  std::vector<std::string> paths = of_limits ? kLimits : kOthers;
  paths.insert(paths.end(), argv + (of_limits ? 2 : std::min(argc, 1)), argv + argc);
  for (const std::string& path : paths) {
    const std::string whole = path[0] == '/' ? path : folder + "/" + path;
    if (!std::filesystem::exists(whole)) {
      std::fprintf(stderr, "map_errors: %s is absent\n", whole.c_str());
      continue;
    }
    subjects.push_back(make_subject(*engine, whole));
  }
  double seconds = 0;
  for (Subject& s : subjects) add_references(*engine, s, seconds);
  Table right(true), wrong(false);
  for (const Subject& s : subjects) right_maps(*engine, s, right);
  for (std::size_t i = 0; i < subjects.size(); ++i) planted(subjects[i], subjects[(i + 1) % subjects.size()], wrong);
  right.print("right maps");
  wrong.print("planted errors");
  std::printf("references: %.2f s for each of %zu molecules\n", seconds / static_cast<double>(subjects.size()),
              subjects.size());
  return 0;
}
