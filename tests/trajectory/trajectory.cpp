// trajectory.cpp: frames row by row: as single comparisons, resumed wherever a run broke off, and what is refused.
#include "trajectory/trajectory.h"

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "frames/frame_files.h"
#include "io/files/read_csv.h"
#include "prepare/load_state.h"
#include "prepare/take_charges.h"
#include "support/test_data.h"
#include "support/text.h"
#include "trajectory/made_series_head.h"

using namespace espdiff_test;
using espdiff::ExistingFile;
using espdiff::Method;
using espdiff::Progress;
using espdiff::SeriesCsv;
using espdiff::SeriesHead;
using espdiff::SeriesRow;
using espdiff::StartFrom;
using espdiff::StepInput;
using espdiff::TrajectoryPlan;
using espdiff::TrajectoryRun;
using espdiff::TrajectorySummary;

namespace {

/// A molecule that bends farther in each frame.
struct Motion {
  Side source = make_side(1, 0);
  std::vector<Side> sides;
  Motion() {
    for (int frame = 0; frame < 5; ++frame) {
      Side side = source;
      for (Vec3d& p : side.molecule.positions) p.z += 0.02 * (frame + 2) * p.x * p.x;
      side.map = potential_map(side.molecule, 1.0);
      sides.push_back(std::move(side));
    }
  }

  TrajectoryPlan plan(Method method = Method::kDeform) const {
    TrajectoryPlan plan;
    plan.reference = "file source.pqr";
    plan.frames = {0, 1, 2, 3, 4};
    plan.options = quick_options();
    plan.options.method = method;
    plan.options.surface.grid_spacing_A = 1.5;
    plan.options.deform.max_iterations = 3000;
    return plan;
  }
  const Side& side(int frame) const { return sides.at(static_cast<std::size_t>(frame)); }
};

struct Runner {
  const Motion& motion;
  std::unique_ptr<espdiff::Engine> engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  std::vector<std::string> warnings{};
  std::function<StepInput(int frame)> read = [this](int frame) {
    return StepInput{motion.source.input(), motion.side(frame).input(), {}};
  };

  TrajectorySummary operator()(const TrajectoryPlan& plan, const std::string& path,
                               ExistingFile existing = ExistingFile::kRefuse, const Progress& progress = {}) {
    TrajectoryRun run(plan, SeriesCsv(path, kSeriesHead, existing));
    if (!run.warning().empty()) warnings.push_back(run.warning());
    while (!run.is_done()) {
      run.step(
          *engine,
          [&] {
            StepInput input = read(run.next().frame);
            if (run.next().source) input.source = motion.side(*run.next().source).input();
            return input;
          },
          progress);
    }
    return run.summary();
  }

  /// All frames beside each other.
  TrajectorySummary at_once(const TrajectoryPlan& plan, const std::string& path,
                            ExistingFile existing = ExistingFile::kRefuse, const Progress& progress = {}) {
    TrajectoryRun run(plan, SeriesCsv(path, kSeriesHead, existing),
                      espdiff::ResidueCsv(path + ".residues", "", existing));
    REQUIRE(run.is_independent());
    run.finish(
        *engine, motion.source.molecule.size(), [&](const espdiff::TrajectoryStep& step) { return read(step.frame); },
        progress);
    return run.summary();
  }

  /// Ends while frame `last` is computed, its row not written.
  void interrupted(const TrajectoryPlan& plan, const std::string& path, int last) {
    Progress* asked = nullptr;
    Progress progress([&](const std::string& stage, double) {
      if (stage.rfind("frame " + std::to_string(last) + ":", 0) == 0) asked->request_cancel();
    });
    asked = &progress;
    const std::string expected = "cancelled after " + std::to_string(last) + " of 5 rows; resume continues " + path;
    CHECK(message_of([&] { (*this)(plan, path, ExistingFile::kRefuse, progress); }) == expected);
  }
};

std::vector<std::vector<std::string>> rows_of(const std::string& path) {
  std::vector<std::vector<std::string>> rows;
  const SeriesCsv file(path, {}, ExistingFile::kResume);
  for (const SeriesRow& row : file.rows()) rows.push_back(row.cells());
  return rows;
}

}  // namespace

TEST_SUITE_BEGIN("trajectory");

TEST_CASE("a row a frame, with the values of the pair, and what the rows were made with") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan();
  run.start = StartFrom::kSource;
  run.frames = {1, 3};
  const TrajectorySummary summary = runner(run, folder.file("a.csv"));
  CHECK(summary.n_frames == 2);
  CHECK(summary.n_rows == 2);
  const SeriesCsv file(folder.file("a.csv"), kSeriesHead, ExistingFile::kResume);
  REQUIRE(file.rows().size() == 2);
  for (const SeriesRow& row : file.rows()) {
    const auto frame = static_cast<std::size_t>(std::stoi(row["frame"]));
    const CompareResult alone =
        compare(*runner.engine, motion.source.input(), motion.sides[frame].input(), run.options, {});
    CHECK(row["reference_frame"] == "file source.pqr");
    CHECK(std::stod(row["rmsd_A"]) == alone.rmsd_A);
    CHECK(std::stod(row["mean_abs_difference"]) == alone.potential.metrics.mean_abs_difference);
    CHECK(std::stod(row["no_counterpart_target"]) == alone.certificate.unmatched_target);
    CHECK(row["potential_unit"] == "kT/e");
    CHECK(row["start"] == "source");
    CHECK(row["converged"] == (alone.certificate.converged ? "1" : "0"));
    CHECK(row["iterations"] == std::to_string(alone.mapping.deform.iterations));
    CHECK(row["error"].empty());
  }
  CHECK(read_file(folder.file("a.csv")).rfind("# espdiff: 1\n# frames: all\n# settings: \nframe,reference_frame,", 0) ==
        0);
  CHECK(folder.n_files() == 1);
}

TEST_CASE("a row has what the preparation of its states left doubtful among its warnings") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  espdiff::StateOrigin source, target;
  source.preparation.emplace();
  source.preparation->gaps = {"between GLY 10 and ALA 15 of chain A"};
  runner.read = [&](int frame) {
    return StepInput{motion.source.input(), motion.side(frame).input(), {}, &source, &target};
  };
  TrajectoryPlan run = motion.plan();
  run.frames = {1};
  runner(run, folder.file("a.csv"));
  const SeriesCsv file(folder.file("a.csv"), kSeriesHead, ExistingFile::kResume);
  REQUIRE(file.rows().size() == 1);
  CHECK(contains(file.rows()[0]["warnings"], "the source lacks residues between GLY 10 and ALA 15 of chain A"));
}

TEST_CASE("a run that broke off anywhere continues the same rows") {
  const Motion motion;
  for (const Method method : {Method::kMorph, Method::kDeform}) {
    CAPTURE(to_string(method));
    const ScratchFolder folder;
    Runner runner{motion};
    const TrajectoryPlan run = motion.plan(method);
    const std::string whole = folder.file("whole.csv"), part = folder.file("part.csv"), state = part + ".state";
    runner(run, whole);
    REQUIRE(rows_of(whole).size() == 5);
    const std::string expected = read_file(whole);
    CHECK_FALSE(std::filesystem::exists(whole + ".state"));
    std::string before;
    for (const int last : {1, 2, 4}) {
      CAPTURE(last);
      runner.interrupted(run, part, last);
      std::ofstream(part, std::ios::app) << last << ",file source.pqr,1.2";  // a row that was being written
      if (last == 1) std::filesystem::remove(state);                         // between the first row and its mapping
      if (last == 2) {
        // Between a row and its mapping: the state is that of the row before.
        const std::string rows = read_file(part), now = read_file(state);
        std::filesystem::remove(part);
        runner.interrupted(run, part, 1);
        std::ofstream(part, std::ios::binary) << rows;
      }
      const TrajectorySummary summary = runner(run, part, ExistingFile::kResume);
      CHECK(summary.n_resumed == static_cast<std::size_t>(last));
      CHECK(summary.n_rows == 5 - static_cast<std::size_t>(last));
      CHECK(read_file(part) == expected);
      CHECK(runner.warnings.empty());
      CHECK_FALSE(std::filesystem::exists(state));
      std::filesystem::remove(part);
    }
    // Complete: left as it is.
    CHECK(runner(run, whole, ExistingFile::kResume).n_rows == 0);
    CHECK(read_file(whole) == expected);
    CHECK(SeriesCsv(whole, kSeriesHead, ExistingFile::kResume).rows()[3]["start"] == "previous");
  }
}

TEST_CASE("without its mapping a resumed run says so and starts from the source; changed rows are refused") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  const TrajectoryPlan run = motion.plan();
  const std::string part = folder.file("part.csv"), state = part + ".state";
  runner.interrupted(run, part, 3);
  const std::string rows = read_file(part), mapping = read_file(state);
  std::filesystem::remove(state);
  runner(run, part, ExistingFile::kResume);
  REQUIRE(runner.warnings.size() == 1);
  CHECK(runner.warnings[0].rfind("the mapping of frame 2 is missing, the next one starts from the source: " + state,
                                 0) == 0);
  CHECK(SeriesCsv(part, kSeriesHead, ExistingFile::kResume).rows()[3]["start"] == "source");

  // The row after the mapping is computed again, and was of something else.
  folder.write("part.csv", rows);
  std::filesystem::remove(state);
  runner.interrupted(run, folder.file("other.csv"), 2);
  std::filesystem::rename(folder.file("other.csv.state"), state);
  const std::vector<std::string> cells = rows_of(part).back();
  std::vector<SeriesRow> kept = SeriesCsv(part, kSeriesHead, ExistingFile::kResume).rows();
  std::vector<std::string> changed = kept.back().cells();
  changed[2] = "9.87";
  kept.back() = SeriesRow(changed);
  {
    SeriesCsv file(part, kSeriesHead, ExistingFile::kReplace);
    for (const SeriesRow& row : kept) file.add(row);
  }
  CHECK(message_of([&] {
          runner(run, part, ExistingFile::kResume);
        }).find("frame 2 now has rmsd_A '" + cells[2] + "' instead of '9.87'") == 0);
}

TEST_CASE("a frame that fails ends the run and is named, or is a row with the reason") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan();
  runner.read = [&motion](int frame) {
    if (frame == 1) throw espdiff::IoError("frame1.pqr", "cannot be read, \"gone\"\nfor good");
    return StepInput{motion.source.input(), motion.side(frame).input(), {}};
  };
  CHECK(message_of([&] { runner(run, folder.file("a.csv")); }).rfind("frame 1: frame1.pqr: cannot be read", 0) == 0);
  CHECK(rows_of(folder.file("a.csv")).size() == 1);
  run.skip_errors = true;
  const TrajectorySummary summary = runner(run, folder.file("b.csv"));
  CHECK(summary.n_rows == 5);
  CHECK(summary.n_skipped == 1);
  const SeriesCsv file(folder.file("b.csv"), kSeriesHead, ExistingFile::kResume);
  CHECK(file.rows()[1]["error"] == "frame1.pqr: cannot be read, \"gone\" for good");
  CHECK(file.rows()[1]["rmsd_A"].empty());
  CHECK(file.rows()[2]["start"] == "source");
}

TEST_CASE("frames that do not depend on each other: beside each other the bytes of one after the other") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan(Method::kMorph);
  run.start = StartFrom::kSource;
  runner(run, folder.file("a.csv"));
  const std::string expected = read_file(folder.file("a.csv"));
  CHECK(runner.at_once(run, folder.file("b.csv")).n_rows == 5);
  CHECK(read_file(folder.file("b.csv")) == expected);
  const std::string residues = read_file(folder.file("b.csv.residues"));
  CHECK(std::count(residues.begin(), residues.end(), '\n') == 8);
  // Stopped between two rows and resumed; replaced.
  Progress* asked = nullptr;
  Progress progress([&](const std::string& stage, double) {
    if (stage.rfind("frame 2:", 0) == 0) asked->request_cancel();
  });
  asked = &progress;
  const std::string stopped =
      message_of([&] { runner.at_once(run, folder.file("c.csv"), ExistingFile::kRefuse, progress); });
  CHECK(contains(stopped, "cancelled after "));
  CHECK(contains(stopped, " of 5 rows; resume continues " + folder.file("c.csv")));
  runner.at_once(run, folder.file("c.csv"), ExistingFile::kResume);
  CHECK(read_file(folder.file("c.csv")) == expected);
  CHECK(read_file(folder.file("c.csv.residues")) == residues);
  runner.at_once(run, folder.file("c.csv"), ExistingFile::kReplace);
  CHECK(read_file(folder.file("c.csv")) == expected);
  CHECK(read_file(folder.file("c.csv.residues")) == residues);
  // A frame that fails, and inputs that are others than the file's.
  runner.read = [&motion](int frame) {
    if (frame == 1) throw espdiff::InputError("frame 1 is gone");
    return StepInput{motion.source.input(), motion.side(frame).input(), {{"source", "s.pqr", "abc"}}};
  };
  CHECK(message_of([&] { runner.at_once(run, folder.file("d.csv")); }) == "frame 1: frame 1 is gone");
  CHECK(rows_of(folder.file("d.csv")).size() == 1);
  run.skip_errors = true;
  CHECK(runner.at_once(run, folder.file("e.csv")).n_skipped == 1);
  runner(run, folder.file("f.csv"));
  CHECK(read_file(folder.file("e.csv")) == read_file(folder.file("f.csv")));
  // There is too little memory for the first frame, beside others and alone: its inputs are in the head all the same.
  Side other = motion.side(0);
  for (Vec3d& p : other.molecule.positions) p.x *= 1e9;
  runner.read = [&](int frame) {
    return StepInput{
        motion.source.input(), (frame == 0 ? other : motion.side(frame)).input(), {{"source", "s.pqr", "abc"}}};
  };
  CHECK(runner.at_once(run, folder.file("g.csv")).n_skipped == 1);
  CHECK(contains(read_file(folder.file("g.csv")), "# source_sha256: abc"));
  runner(run, folder.file("h.csv"));
  const auto head_of = [&](const std::string& name) {
    const std::string text = read_file(folder.file(name));
    return text.substr(0, text.find("\nframe,"));
  };
  CHECK(head_of("g.csv") == head_of("h.csv"));
  // The error says how much memory there is at that moment; the other rows have the same bytes but for their checksums.
  const auto rows = rows_of(folder.file("g.csv")), expected_rows = rows_of(folder.file("h.csv"));
  REQUIRE(rows.size() == 5);
  CHECK(contains(rows[0].back(), "of memory"));
  for (std::size_t i = 1; i < rows.size(); ++i) CHECK(rows[i] == expected_rows[i]);
  run.frames = {0, 1, 2, 3, 4, 3};
  runner.read = [&motion](int frame) {
    return StepInput{motion.source.input(), motion.side(frame).input(), {{"source", "s.pqr", "def"}}};
  };
  CHECK(contains(message_of([&] { runner.at_once(run, folder.file("e.csv"), ExistingFile::kResume); }),
                 "was made with source_sha256 'abc'"));
}

TEST_CASE("each frame against the one before") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan(Method::kMorph);
  run.against = espdiff::Reference::kPrevious;
  run.frames = {0, 2, 3};
  CHECK(runner(run, folder.file("a.csv")).n_frames == 2);
  const SeriesCsv file(folder.file("a.csv"), kSeriesHead, ExistingFile::kResume);
  REQUIRE(file.rows().size() == 2);
  CHECK(file.rows()[0]["frame"] == "2");
  CHECK(file.rows()[0]["reference_frame"] == "0");
  CHECK(file.rows()[1]["reference_frame"] == "2");
  const CompareResult alone = compare(*runner.engine, motion.side(2).input(), motion.side(3).input(), run.options, {});
  CHECK(std::stod(file.rows()[1]["mean_abs_difference"]) == alone.potential.metrics.mean_abs_difference);
  run.frames = {2};
  CHECK(message_of([&] { TrajectoryRun(run, SeriesCsv(folder.file("b.csv"), kSeriesHead, ExistingFile::kRefuse)); }) ==
        "reference previous needs two frames or more");
  CHECK(folder.n_files() == 1);
}

TEST_CASE("each frame against the frame of its number of another trajectory") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan(Method::kMorph);
  run.against = espdiff::Reference::kSame;
  run.start = StartFrom::kPrevious;
  run.frames = {1, 3};
  // Frame i of the other trajectory is frame i of this one, so that nothing differs.
  CHECK(runner(run, folder.file("a.csv")).n_frames == 2);
  const SeriesCsv file(folder.file("a.csv"), kSeriesHead, ExistingFile::kResume);
  REQUIRE(file.rows().size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(file.rows()[i]["reference_frame"] == file.rows()[i]["frame"]);
    CHECK(std::stod(file.rows()[i]["rmsd_A"]) < 1e-6);
    CHECK(std::stod(file.rows()[i]["mean_abs_difference"]) < 1e-4);
    CHECK(file.rows()[i]["start"] == "source");
  }
}

TEST_CASE("the residues of a run that was killed between its two rows are resumed to the same bytes") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan plan = motion.plan(Method::kMorph);
  plan.start = StartFrom::kSource;
  plan.frames = {0, 1, 2};
  const auto run = [&](const std::string& name, ExistingFile existing) {
    TrajectoryRun made(plan, SeriesCsv(folder.file(name), kSeriesHead, existing),
                       espdiff::ResidueCsv(folder.file("residues_" + name), "", existing));
    while (!made.is_done()) made.step(*runner.engine, [&] { return runner.read(made.next().frame); }, {});
  };
  run("whole.csv", ExistingFile::kRefuse);
  const std::string rows = read_file(folder.file("whole.csv")), residues = read_file(folder.file("residues_whole.csv"));
  const CompareResult alone = compare(*runner.engine, motion.source.input(), motion.side(2).input(), plan.options, {});
  const espdiff::CsvTable table = espdiff::read_csv(folder.file("residues_whole.csv"));
  REQUIRE(table.rows.size() == 3);
  REQUIRE(table.columns.size() == alone.residues.size() + 1);
  for (std::size_t r = 0; r < alone.residues.size(); ++r)
    CHECK(table.number(2, r + 1) == doctest::Approx(alone.residues[r].mean_abs_difference).epsilon(1e-12));
  // The last row of the trajectory is missing, that of the residues is there.
  std::ofstream(folder.file("cut.csv")) << rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1);
  std::ofstream(folder.file("residues_cut.csv")) << residues;
  run("cut.csv", ExistingFile::kResume);
  CHECK(read_file(folder.file("cut.csv")) == rows);
  CHECK(read_file(folder.file("residues_cut.csv")) == residues);
}

TEST_CASE("a file with rows of other frames is refused and left as it is") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan();
  run.frames = {0, 1};
  const std::string path = folder.file("a.csv");
  runner(run, path);
  const std::string good = read_file(path);
  run.frames = {1, 2};
  CHECK(message_of([&] { runner(run, path, ExistingFile::kResume); }).find("row 1 is of frame 0, not of 1") !=
        std::string::npos);
  run.frames = {0};
  CHECK(message_of([&] { runner(run, path, ExistingFile::kResume); }).find("row 2 is of frame 1, beyond the run") !=
        std::string::npos);
  CHECK(read_file(path) == good);
  CHECK(folder.n_files() == 1);
}

TEST_CASE("an input that all rows depend on has to be the same when a run is resumed, errors skipped or not") {
  const Motion motion;
  const ScratchFolder folder;
  Runner runner{motion};
  TrajectoryPlan run = motion.plan();
  run.skip_errors = true;
  const std::string path = folder.file("a.csv");
  std::string sha256 = "abc";
  runner.read = [&](int frame) {
    return StepInput{motion.source.input(), motion.side(frame).input(), {{"source", "s.pqr", sha256}}};
  };
  runner.interrupted(run, path, 2);
  sha256 = "def";
  CHECK(message_of([&] { runner(run, path, ExistingFile::kResume); }).find("was made with source_sha256 'abc'") !=
        std::string::npos);
  CHECK(rows_of(path).size() == 2);
}

TEST_CASE("frames are numbered through all files") {
  const ScratchFolder folder;
  const auto model = [](double x) {
    return "ATOM 1 CA ALA 1 " + std::to_string(x) + " 0 0 0.5 2.0\nATOM 2 CA ALA 2 3 1 0 -0.5 2.0\n";
  };
  std::string two, three;
  for (int i = 0; i < 2; ++i) two += "MODEL\n" + model(i) + "ENDMDL\n";
  for (int i = 2; i < 5; ++i)
    three += "CRYST1   4" + std::to_string(i) + ".000   41.000   42.000  90.00  90.00  90.00\nMODEL\n" + model(i) +
             "ENDMDL\n";
  espdiff::FrameFiles files({folder.write("a.pqr", two), folder.write("b.pqr", three)});
  CHECK(files.n_frames() == 5);
  for (const int frame : {4, 0, 2, 1, 3}) CHECK(files.read(frame, {}).positions[0].x == frame);
  CHECK(files.name(3) == folder.file("b.pqr") + ", model 2");
  CHECK_FALSE(files.cell(1).has_value());
  CHECK(files.cell(4).value().lengths.x == 44);
  folder.write("a.pqr", model(7) + model(8));
  CHECK(files.read(4, {}).positions[0].x == 4);
  CHECK(message_of([&] { files.read(0, {}); }) ==
        folder.file("a.pqr") + ": the file was changed while it was in use; start again");
  CHECK_THROWS_AS(espdiff::FrameFiles({}), espdiff::InputError);
  CHECK_THROWS_AS(espdiff::FrameFiles({folder.file("absent.pdb")}), espdiff::IoError);
}

TEST_CASE("a frame without values takes those of its atoms in the molecule, in any order") {
  const Molecule molecule = make_side(1, 0).molecule;
  Molecule frame = molecule;
  frame.charges.clear();
  frame.radii.assign(frame.size(), 1.5F);
  frame.radii_origin = espdiff::ValueOrigin::kElement;
  std::swap(frame.atoms[3], frame.atoms[4]);  // of one residue
  REQUIRE(frame.atoms[3].residue == frame.atoms[4].residue);
  take_values(frame, molecule, "frames.pdb, model 1");
  CHECK(frame.charges[3] == molecule.charges[4]);
  CHECK(frame.radii[4] == molecule.radii[3]);
  CHECK(frame.charges[20] == molecule.charges[20]);
  CHECK(frame.radii_origin == molecule.radii_origin);

  Molecule own = molecule;
  own.charges.assign(own.size(), 0.25F);
  take_values(own, molecule, "frames.pqr, model 1");
  CHECK(own.charges[7] == 0.25F);

  Molecule shorter = molecule;
  shorter.charges.clear();
  shorter.atoms.pop_back(), shorter.positions.pop_back(), shorter.radii.pop_back();
  CHECK(message_of([&] { take_values(shorter, molecule, "frames.pdb, model 1"); }) ==
        "frames.pdb, model 1 has no charges and radii, and cannot take those of molecule.pqr: it lacks OH of TYR A 12 "
        "(119 and 120 atoms); give frames and source of the same atoms, or frames as PQR");
}

TEST_SUITE_END();
