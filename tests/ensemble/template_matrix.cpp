// template_matrix.cpp: matrices through one template: planted values, made molecules, interruptions, and what is
// refused.
#include "ensemble/template_matrix.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "engine/engine.h"
#include "ensemble/planted_file.h"
#include "ensemble/result/template_values.h"
#include "io/files/read_csv.h"
#include "matrix/made_variants.h"
#include "matrix/matrix_table.h"
#include "matrix/write_matrix.h"
#include "statistics/surface/mesh_graph.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::EnsembleFile;
using espdiff::EnsemblePlan;
using espdiff::find_metric;
using espdiff::Matrix;
using espdiff::MatrixPair;
using espdiff::MatrixPlan;
using espdiff::MatrixReport;
using espdiff::MatrixRun;
using espdiff::TemplateRequest;
using espdiff::Variant;

namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

MatrixRun run_to(const std::string& output) {
  MatrixRun run;
  run.output = output;
  run.potential = "maps";
  return run;
}

TemplateRequest request_of(const std::string& text, std::size_t n_exact) {
  return {text, n_exact, matrix_options(), {}};
}

/// States of a matrix whose potentials are given by vertex; the template is an ellipsoid of two residues.
class PlantedStates {
 public:
  PlantedStates(const std::string& path, std::size_t n_states) : surface_(planted_template(2)) {
    plan_ = plan_of("an ellipsoid", {"ALA 1", "GLY 2"});
    MatrixPlan matrix;
    matrix.potential = "planted";
    matrix.potential_unit = "kT/e";
    for (std::size_t i = 0; i < n_states; ++i) matrix.variants.push_back({"s" + std::to_string(i), "", {}});
    plan_.matrix = std::make_shared<const MatrixPlan>(matrix);
    plan_.replicates = {{"variants", "variants", {"all"}, {"0"}, n_states}};
    EnsembleFile::create(path, plan_, surface_);
    file_ = std::make_unique<EnsembleFile>(path, true);
  }
  std::size_t n_vertices() const { return surface_.positions.size(); }
  std::vector<double> areas() const { return espdiff::make_mesh_graph(surface_.positions, surface_.triangles).area; }
  void write(std::size_t state, const std::vector<float>& values, bool trustworthy = true,
             const std::vector<std::uint8_t>& trusted = {}) {
    file_->write(state, values, {1, 0, 0, 0, 1, 0, trustworthy, trustworthy ? "" : "it slipped"}, trusted);
  }
  void write_error(std::size_t state) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    file_->write(state, std::vector<float>(n_vertices(), kNoValue), {kNaN, 1, 1, kNaN, kNaN, kNaN, false, "it failed"});
  }
  Matrix matrix() const { return espdiff::matrix_through_template(*file_, {}, {}); }

 private:
  espdiff::TemplateSurface surface_;
  EnsemblePlan plan_;
  std::unique_ptr<EnsembleFile> file_;
};

}  // namespace

TEST_SUITE_BEGIN("template matrix");

TEST_CASE("the cells are the sums over the vertices that both states have") {
  const ScratchFolder folder;
  PlantedStates states(folder.file("a.h5"), 3);
  const std::vector<double> areas = states.areas();
  std::vector<std::vector<float>> values(3, std::vector<float>(states.n_vertices()));
  for (std::size_t i = 0; i < 3; ++i) {
    Normal normal(7, i);
    for (float& value : values[i]) value = static_cast<float>(normal.next() + static_cast<double>(i));
    std::vector<std::uint8_t> trusted(values[i].size(), 1);
    trusted[10 + i] = 0;      // and another one is not trusted
    values[i][i] = kNoValue;  // another vertex of each state has no counterpart
    states.write(i, values[i], true, trusted);
    values[i][10 + i] = kNoValue;  // does not count below
  }
  const Matrix matrix = states.matrix();
  REQUIRE(matrix.cells.size() == 6);
  double all = 0;
  for (const double area : areas) all += area;
  double least = 1;
  for (const espdiff::MatrixCell& cell : matrix.cells) {
    double area = 0, absolute = 0, squared = 0, difference = 0, sign = 0, ab = 0, aa = 0, bb = 0;
    for (std::size_t v = 0; v < areas.size(); ++v) {
      const double a = values[cell.source][v], b = values[cell.target][v];
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      area += areas[v];
      absolute += areas[v] * std::fabs(b - a);
      squared += areas[v] * (b - a) * (b - a);
      difference += areas[v] * (b - a);
      sign += (a < 0) != (b < 0) ? areas[v] : 0;
      ab += areas[v] * a * b;
      aa += areas[v] * a * a;
      bb += areas[v] * b * b;
    }
    least = std::min(least, area / all);
    const auto value = [&](const char* name) { return cell.values[find_metric(name)]; };
    CHECK(value("mean_abs_difference") == doctest::Approx(absolute / area));
    CHECK(value("rms_difference") == doctest::Approx(std::sqrt(squared / area)));
    CHECK(value("mean_signed_difference") == doctest::Approx(difference / area));
    CHECK(value("sign_change_area_fraction") == doctest::Approx(sign / area));
    CHECK(value("hodgkin_index") == doctest::Approx(2 * ab / (aa + bb)));
    CHECK(value("carbo_index") == doctest::Approx(ab / std::sqrt(aa * bb)));
    CHECK(value("trusted_source") == doctest::Approx(area / all));
    CHECK(value("trusted_target") == doctest::Approx(area / all));
    CHECK(std::isnan(value("rmsd_A")));
    CHECK(std::isnan(value("mean_displacement_A")));
    const espdiff::MatrixCell& back = matrix.cell(cell.target, cell.source);
    CHECK(back.values[find_metric("mean_abs_difference")] == value("mean_abs_difference"));
    CHECK(back.values[find_metric("mean_signed_difference")] == -value("mean_signed_difference"));
  }
  CHECK(matrix.through->least_area_fraction == doctest::Approx(least));
  CHECK(matrix.through->mean_area_fraction < 1);
}

TEST_CASE("a state onto which the mapping is not trustworthy is named, and its rows and columns are marked") {
  const ScratchFolder folder;
  PlantedStates states(folder.file("a.h5"), 4);
  for (std::size_t i = 0; i < 3; ++i)
    states.write(i, std::vector<float>(states.n_vertices(), static_cast<float>(i)), i != 1);
  states.write_error(3);
  const Matrix matrix = states.matrix();
  for (const espdiff::MatrixCell& cell : matrix.cells) {
    const bool doubtful = cell.source == 1 || cell.target == 1, failed = cell.source == 3 || cell.target == 3;
    CHECK(cell.trustworthy == (!doubtful && !failed));
    CHECK(cell.error.empty() != failed);
    CHECK(std::isnan(cell.values[find_metric("mean_abs_difference")]) == failed);
    if (failed) CHECK(cell.error == "the template onto s3: it failed");
    if (doubtful && !failed) CHECK(cell.reasons == std::vector<std::string>{"the template onto s1: it slipped"});
  }
  std::ostringstream text;
  print_matrix(text, matrix, find_metric("mean_abs_difference"));
  INFO(text.str());
  CHECK(contains(text.str(), "is not trustworthy onto these states"));
  CHECK(contains(text.str(), "  s1                   it slipped\n  s3                   it failed\n"));
  CHECK(contains(text.str(), "No pair was compared by itself"));
  CHECK(contains(text.str(), "A template does not give: RMSD, Mean displacement, Area of the mapped surface"));
  espdiff::write_matrix(folder.file("m"), matrix, find_metric("mean_abs_difference"));
  const auto json = nlohmann::json::parse(read_file(folder.file("m.json")));
  CHECK(json["template"]["states"][1]["reason"] == "it slipped");
  CHECK(json["template"]["states"][3]["error"] == "it failed");
  CHECK(json["trustworthy"][0][1] == false);
  CHECK(json["trustworthy"][0][2] == true);
  CHECK(json["trustworthy"][0][3].is_null());
  CHECK_FALSE(json["metrics"].contains("rmsd_A"));
  CHECK(json["template"]["absent"][0] == "rmsd_A");
}

TEST_CASE("a cell is trustworthy from the required share of the template on, which both states have to be trusted on") {
  const ScratchFolder folder;
  PlantedStates states(folder.file("a.h5"), 3);
  const std::size_t n = states.n_vertices();
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<float> values(n);
    for (std::size_t v = 0; v < n; ++v) values[v] = static_cast<float>(v % 7 + i * v);
    std::vector<std::uint8_t> trusted(n, 1);
    for (std::size_t v = 0; v < n; ++v) trusted[v] = (i == 1 && v < n / 3) || (i == 2 && v >= 2 * n / 3) ? 0 : 1;
    states.write(i, values, true, trusted);
  }
  const std::vector<double> areas = states.areas();
  double all = 0, middle = 0;
  for (std::size_t v = 0; v < n; ++v) {
    all += areas[v];
    middle += v >= n / 3 && v < 2 * n / 3 ? areas[v] : 0;
  }
  const Matrix matrix = states.matrix();
  for (const MatrixPair& pair : {MatrixPair{0, 1}, MatrixPair{2, 0}}) {
    CHECK(matrix.cell(pair.first, pair.second).trustworthy);
    CHECK(matrix.cell(pair.first, pair.second).values[find_metric("trusted_source")] > 0.5);
  }
  const espdiff::MatrixCell& cell = matrix.cell(1, 2);
  CHECK(cell.values[find_metric("trusted_source")] == doctest::Approx(middle / all));
  CHECK_FALSE(cell.trustworthy);
  REQUIRE(cell.reasons.size() == 1);
  CHECK(contains(cell.reasons[0], " % of the template is trusted onto both states (limit 50 %)"));
}

TEST_CASE("the sample of exact pairs is the same each time, without doubles, and grows from smaller ones") {
  const std::vector<MatrixPair> small = espdiff::exact_sample(19, 6), large = espdiff::exact_sample(19, 40);
  CHECK(small.size() == 6);
  CHECK(std::set<MatrixPair>(large.begin(), large.end()).size() == 40);
  for (std::size_t k = 0; k < small.size(); ++k) CHECK(small[k] == large[k]);
  for (const MatrixPair& pair : large) CHECK(pair.first != pair.second);
  CHECK(espdiff::exact_sample(3, 6) == espdiff::matrix_pairs(3));
  CHECK(espdiff::exact_sample(3, 100) == espdiff::matrix_pairs(3));
  CHECK(espdiff::exact_sample(3, 0).empty());
}

TEST_CASE("identical states differ by nothing") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  std::vector<Variant> variants = made_variants(1);
  variants.push_back(variants.front());
  variants.back().label = "copy";
  const MatrixReport report =
      run_template_matrix(*engine, variants, matrix_options(), request_of("0", 2), run_to(folder.file("m")), {});
  const Matrix& matrix = *report.matrix;
  CHECK(matrix.value(find_metric("mean_abs_difference"), 0, 1) == 0);
  CHECK(matrix.value(find_metric("hodgkin_index"), 1, 0) == doctest::Approx(1));
  // The made chains have bonds of three times the usual length, which the certificate of a template says too.
  CHECK(contains(matrix.through->states[0].reason, "the coordinates of the source are scaled"));
  CHECK_FALSE(matrix.cells[0].trustworthy);
  REQUIRE(matrix.through->exact.size() == 2);
  for (const espdiff::TemplateAgreement& of : espdiff::agreement(matrix)) {
    INFO(matrix.metrics()[of.metric].name);
    CHECK(of.largest_difference == doctest::Approx(0).scale(1).epsilon(1e-3));
  }
}

TEST_CASE("made states: near the exact pairs, and the files say how near") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  const std::vector<Variant> variants = made_variants(4);
  const MatrixReport report =
      run_template_matrix(*engine, variants, matrix_options(), request_of("medoid", 12), run_to(folder.file("m")), {});
  CHECK(report.template_work->n_states == 4);
  CHECK(report.template_work->n_exact == 12);
  CHECK_FALSE(std::filesystem::exists(folder.file("m.state")));
  CHECK(std::filesystem::exists(folder.file("m.h5")));
  const std::size_t metric = find_metric("mean_abs_difference");
  for (const espdiff::MatrixCell& exact : report.matrix->through->exact) {
    INFO(exact.source, " to ", exact.target);
    CHECK(report.matrix->value(metric, exact.source, exact.target) ==
          doctest::Approx(exact.values[metric]).epsilon(0.15));
  }
  const auto json = nlohmann::json::parse(read_file(folder.file("m.json")));
  const auto& agreement = json["template"]["exact"]["agreement"]["mean_abs_difference"];
  CHECK(agreement["n"] == 12);
  CHECK(agreement["correlation"].get<double>() > 0.9);
  CHECK(agreement["largest_difference"].get<double>() >= agreement["mean_difference"].get<double>());
  CHECK(json["clustering"]["order"].size() == 4);
  const auto table = espdiff::read_csv(folder.file("m.csv"));
  REQUIRE(table.rows.size() == 12);
  CHECK(table.rows[0][static_cast<std::size_t>(table.require("rmsd_A"))].empty());
}

TEST_CASE("interrupted, resumed and in parts: the same bytes") {
  const ScratchFolder folder;
  const auto engine = cpu_engine(1);
  const std::vector<Variant> variants = made_variants(4);
  const TemplateRequest request = request_of("v1", 3);
  const auto compute = [&](const MatrixRun& run, const espdiff::Progress& progress) {
    return run_template_matrix(*engine, variants, matrix_options(), request, run, progress);
  };
  compute(run_to(folder.file("whole")), {});
  const std::string csv = read_file(folder.file("whole.csv")), json = read_file(folder.file("whole.json"));

  MatrixRun run = run_to(folder.file("stopped"));
  std::unique_ptr<espdiff::Progress> progress;
  for (const char* where : {"state 3 of 4", "pair 2 of 3"}) {
    progress = std::make_unique<espdiff::Progress>([&](const std::string& stage, double) {
      if (contains(stage, where)) progress->request_cancel();
    });
    const std::string message = message_of([&] { compute(run, *progress); });
    INFO(message);
    CHECK(contains(message, "cancelled after "));
    CHECK(contains(message, "resume continues"));
    run.resume = true;
  }
  const MatrixReport report = compute(run, {});
  CHECK(report.template_work->n_states_resumed == 4);
  CHECK(report.template_work->n_exact_resumed == 1);
  CHECK(read_file(folder.file("stopped.csv")) == csv);
  CHECK(read_file(folder.file("stopped.json")) == json);
  CHECK(read_file(folder.file("stopped.h5")) == read_file(folder.file("whole.h5")));

  std::vector<std::string> parts;
  for (const int index : {2, 1}) {
    MatrixRun part = run_to(folder.file("part"));
    part.shard = {index, 2};
    const MatrixReport of_part = compute(part, {});
    CHECK_FALSE(of_part.matrix.has_value());
    parts.insert(parts.end(), of_part.files.begin(), of_part.files.end());
  }
  REQUIRE(parts.size() == 4);
  CHECK(espdiff::are_parts_of_template_matrix(parts));
  merge_template_matrix(parts, run_to(folder.file("merged")));
  CHECK(read_file(folder.file("merged.csv")) == csv);
  CHECK(read_file(folder.file("merged.json")) == json);
  CHECK(read_file(folder.file("merged.h5")) == read_file(folder.file("whole.h5")));

  const auto refused = [&](const std::vector<std::string>& some) {
    const std::string message = message_of([&] { merge_template_matrix(some, run_to(folder.file("two"))); });
    CHECK_FALSE(std::filesystem::exists(folder.file("two.h5")));
    CHECK_FALSE(std::filesystem::exists(folder.file("two.json")));
    return message;
  };
  CHECK(contains(refused({parts[0], parts[1], parts[2]}), "the exact pair "));
  CHECK(contains(refused({parts[0], parts[1], parts[3]}), "none of the files has frame 0 (v0)"));
}

TEST_CASE("what a template cannot do is refused in one sentence, before any file is made") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  const std::vector<Variant> variants = made_variants(3);
  const auto refused = [&](const std::vector<Variant>& given, const espdiff::CompareOptions& options,
                           const std::string& text, const std::string& cluster_by = "") {
    MatrixRun run = run_to(folder.file("m"));
    run.cluster_by = cluster_by;
    TemplateRequest request{text, 0, options, {}};
    const std::string message = message_of([&] { run_template_matrix(*engine, given, options, request, run, {}); });
    CHECK(folder.n_files() == 0);
    return message;
  };
  std::vector<Variant> bare = variants;
  for (Variant& v : bare) v.map.reset();
  CHECK(contains(refused(bare, matrix_options(), "0"), "a template gives differences of potentials, and v0 has none"));
  CHECK(contains(
      refused(variants, matrix_options(), "3"),
      "template 3 is neither medoid, nor the label of a variant, nor its number from 0 to 2, nor a structure"));
  CHECK(contains(refused(variants, matrix_options(), "0", "rmsd_A"), "a template does not give this metric"));
  espdiff::CompareOptions options = matrix_options();
  options.input.region = "//A/1";
  CHECK(contains(refused(variants, options, "0"), "a region is of each pair's source"));
  options = matrix_options();
  options.method = espdiff::Method::kDeform;
  CHECK(contains(refused(variants, options, "0"), "a template is mapped by the morph"));
}

TEST_CASE("a file of other states or another template is refused, and a state that fails is noted or stops the run") {
  const ScratchFolder folder;
  const auto engine = cpu_engine();
  std::vector<Variant> variants = made_variants(3);
  MatrixRun run = run_to(folder.file("m"));
  const auto message = [&](const std::string& text) {
    return message_of([&] { run_template_matrix(*engine, variants, matrix_options(), request_of(text, 0), run, {}); });
  };
  run_template_matrix(*engine, variants, matrix_options(), request_of("0", 0), run, {});
  CHECK(contains(message("0"), "exists"));
  run.resume = true;
  CHECK(contains(message("1"), "m.h5 is of another run: the template is v0 there and v1 here"));
  variants[2].inputs.front().sha256 = "changed";
  CHECK(contains(message("0"), "m.h5 is of another run: the structure of v2 has changed"));
  run = run_to(folder.file("n"));
  variants[1].map->lattice.origin += Vec3d{500, 0, 0};  // covers nothing
  CHECK(contains(message("0"), "v1: "));
  CHECK_FALSE(std::filesystem::exists(folder.file("n.csv")));
  run.overwrite = run.skip_errors = true;
  const MatrixReport report = run_template_matrix(*engine, variants, matrix_options(), request_of("0", 0), run, {});
  CHECK(contains(report.matrix->through->states[1].error, "does not cover"));
  CHECK(report.matrix->cell(0, 2).error.empty());
}

TEST_SUITE_END();
