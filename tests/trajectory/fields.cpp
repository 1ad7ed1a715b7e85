// fields.cpp: fields as columns of a trajectory: a pair's numbers, resumed, of residues, and what is refused.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "certificate/result.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/files/read_csv.h"
#include "io/grids/write_grid.h"
#include "report/sections/field_json.h"
#include "support/test_data.h"
#include "support/text.h"
#include "trajectory/residue_csv.h"
#include "trajectory/series_head.h"
#include "trajectory/trajectory.h"

using namespace espdiff_test;
using espdiff::ExistingFile;
using espdiff::ResidueCsv;
using espdiff::SeriesCsv;
using espdiff::SeriesRow;
using espdiff::StepInput;
using espdiff::TrajectoryPlan;
using espdiff::TrajectoryRun;

namespace {

/// A molecule that bends farther in each frame, and its fields.
struct FieldMotion {
  Side source = make_side(1, 0);
  std::vector<Side> frames;
  std::unique_ptr<espdiff::Engine> engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  TrajectoryPlan plan;
  espdiff::SeriesHead head;

  FieldMotion(std::vector<espdiff::FieldRequest> fields, int n_frames) {
    for (int frame = 0; frame < n_frames; ++frame) {
      Side side = source;
      for (Vec3d& p : side.molecule.positions) p.z += 0.02 * (frame + 1) * p.x * p.x;
      side.molecule.charges[0] += 0.5F * static_cast<float>(frame);
      frames.push_back(std::move(side));
      plan.frames.push_back(frame);
    }
    plan.reference = "file source.pqr";
    plan.options = quick_options();
    plan.options.surface.grid_spacing_A = 1.5;
    plan.options.fields = std::move(fields);
    plan.start = espdiff::StartFrom::kSource;
    plan.compared = espdiff::parts_and_fields(plan.options);
    espdiff::SeriesDescription run;
    run.frames = plan.frames;
    head = espdiff::series_head(run, plan.options);
  }

  StepInput read(int frame) const { return {source.shape(), frames[static_cast<std::size_t>(frame)].shape(), {}}; }
  void run(const std::string& path, const std::string& residues, ExistingFile existing) const {
    TrajectoryRun made(plan, SeriesCsv(path, head, existing, plan.compared),
                       ResidueCsv(residues, "charge_mean_abs_difference", existing, plan.options.fields));
    while (!made.is_done()) made.step(*engine, [&] { return read(made.next().frame); }, {});
  }
};

}  // namespace

TEST_SUITE_BEGIN("trajectory fields");

TEST_CASE("rows and residues have the pair's numbers of each field, and a resumed run the same bytes") {
  const ScratchFolder folder;
  const FieldMotion motion({{"charge", "charge"}, {"kd", "hydrophobicity"}}, 3);
  const std::string path = folder.file("a.csv"), residues = folder.file("r.csv");
  motion.run(path, residues, ExistingFile::kRefuse);
  const SeriesCsv file(path, motion.head, ExistingFile::kResume, motion.plan.compared);
  REQUIRE(file.rows().size() == 3);
  const CompareResult alone =
      compare(*motion.engine, motion.source.shape(), motion.frames[2].shape(), motion.plan.options, {});
  const SeriesRow& row = file.rows()[2];
  CHECK(std::stod(row["charge_mean_abs_difference"]) == alone.fields[0].metrics.mean_abs_difference);
  CHECK(std::stod(row["charge_hodgkin_index"]) == alone.fields[0].metrics.hodgkin_index);
  CHECK(std::stod(row["kd_mean_abs_difference"]) == 0);  // all residues are of one kind
  CHECK(row["kd_correlation"].empty());
  CHECK(std::stod(row["kd_area_A2"]) == alone.fields[1].metrics.area_A2);
  CHECK(row["mean_abs_difference"].empty());  // shapes alone
  const espdiff::CsvTable table = espdiff::read_csv(residues), rows = espdiff::read_csv(path);
  for (std::size_t r = 0; r < alone.residues.size(); ++r) {
    const double mean = alone.fields[0].residues[alone.residues[r].residue].mean_abs_difference;
    if (std::isfinite(mean)) CHECK(table.number(2, r + 1) == doctest::Approx(mean).epsilon(1e-12));
  }
  CHECK(table.comments[0] == "residues: charge_mean_abs_difference [e]");
  const auto fields = espdiff::fields_in_head(rows.comments);
  REQUIRE(fields.size() == 2);
  CHECK(fields[0].unit == "e");
  CHECK(fields[0].is_signed);
  CHECK(espdiff::metric_of_column("charge_mean_abs_difference", fields)->field_unit == std::string("e"));
  CHECK(espdiff::metric_of_column("site_kd_correlation", fields)->part == std::string("site"));

  const std::string bytes = read_file(path), of_residues = read_file(residues);
  std::ofstream(folder.file("b.csv")) << bytes.substr(0, bytes.rfind('\n', bytes.size() - 2) + 1);
  std::ofstream(folder.file("s.csv")) << of_residues;
  motion.run(folder.file("b.csv"), folder.file("s.csv"), ExistingFile::kResume);
  CHECK(read_file(folder.file("b.csv")) == bytes);
  CHECK(read_file(folder.file("s.csv")) == of_residues);
  const FieldMotion other({{"charge", "charge"}}, 3);
  const std::string refused =
      message_of([&] { SeriesCsv(folder.file("b.csv"), other.head, ExistingFile::kResume, other.plan.compared); });
  INFO(refused);
  CHECK(contains(refused, "charge=charge|kd=hydrophobicity"));
}

TEST_CASE("a map is of each frame, by its number, and one for all is refused") {
  const ScratchFolder folder;
  const auto write = [&](const std::string& name, const Side& side) { espdiff::write_dx(folder.file(name), side.map); };
  const FieldMotion bare({}, 2);
  write("source.dx", bare.source);
  for (const std::size_t frame : {0, 1}) {
    Side side = bare.frames[frame];
    side.map = potential_map(side.molecule, 1.5);
    write("f0" + std::to_string(frame) + ".dx", side);
  }
  const FieldMotion motion({{"density", "map:" + folder.file("source.dx") + "," + folder.file("f%02d.dx")}}, 2);
  TrajectoryRun run(motion.plan,
                    SeriesCsv(folder.file("a.csv"), motion.head, ExistingFile::kRefuse, motion.plan.compared));
  while (!run.is_done()) run.step(*motion.engine, [&] { return motion.read(run.next().frame); }, {});
  TrajectoryPlan pair = motion.plan;
  pair.options.fields[0].what = "map:" + folder.file("source.dx") + "," + folder.file("f01.dx");
  const CompareResult alone =
      compare(*motion.engine, motion.source.shape(), motion.frames[1].shape(), pair.options, {});
  CHECK(std::stod(run.file().rows()[1]["density_mean_abs_difference"]) == alone.fields[0].metrics.mean_abs_difference);
  CHECK(alone.fields[0].metrics.mean_abs_difference > 0);

  const FieldMotion one({{"density", "map:" + folder.file("source.dx")}}, 1);
  TrajectoryRun refused(one.plan, SeriesCsv(folder.file("b.csv"), one.head, ExistingFile::kRefuse, one.plan.compared));
  CHECK(contains(message_of([&] { refused.step(*one.engine, [&] { return one.read(0); }, {}); }),
                 "each frame needs a map of its own, in its place; name them by the frame's number, as in "
                 "map:SOURCE.dx,frame.%d.dx"));
}

TEST_SUITE_END();
