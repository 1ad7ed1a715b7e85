// matrix_state.cpp: what a state file keeps, and every way in which one is broken, cut off, or another's.
#include "matrix/matrix_state.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::MatrixCell;
using espdiff::MatrixPlan;
using espdiff::MatrixState;
using espdiff::MatrixStateContent;
using espdiff::read_matrix_state;

namespace {

MatrixPlan plan_of_three() {
  MatrixPlan plan;
  plan.version = "1";
  plan.device = "cpu";
  plan.settings = {{"grid-spacing", "1"}, {"rho", "0.3"}};
  for (const char* label : {"a", "b, \"quoted\"", "c"})
    plan.variants.push_back({label, "G", {{"structure", std::string(label) + ".pqr", std::string(64, *label)}}});
  return plan;
}

MatrixCell cell_of(std::size_t source, std::size_t target, double value) {
  MatrixCell cell;
  cell.source = source;
  cell.target = target;
  cell.values.assign(espdiff::matrix_metrics().size(), value);
  cell.values[1] = std::numeric_limits<double>::quiet_NaN();
  cell.values[2] = 1.0 / 3;
  cell.converged = true;
  cell.reasons = {"one", "two\nlines"};
  return cell;
}

/// A file with three cells.
std::string written_state(const ScratchFolder& folder) {
  const std::string path = folder.file("m.state");
  MatrixState state = MatrixState::begin(path, plan_of_three());
  state.add(cell_of(0, 1, 0.1));
  state.add(cell_of(0, 2, 1e-300));
  state.add(cell_of(1, 0, -7));
  return path;
}

std::size_t line_start(const std::string& text, int line) {
  std::size_t at = 0;
  for (int i = 1; i < line; ++i) at = text.find('\n', at) + 1;
  return at;
}

}  // namespace

TEST_SUITE_BEGIN("matrix state");

TEST_CASE("numbers come back bit by bit, and a run continues behind the last cell") {
  const ScratchFolder folder;
  const std::string path = written_state(folder);
  MatrixStateContent content;
  {
    MatrixState state = MatrixState::go_on(path, plan_of_three(), content);
    CHECK(content.cells.size() == 3);
    CHECK_FALSE(content.cut_off);
    state.add(cell_of(1, 2, 0.2));
  }
  const MatrixStateContent all = read_matrix_state(path);
  REQUIRE(all.cells.size() == 4);
  CHECK(all.cells[0].values[0] == 0.1);
  CHECK(std::isnan(all.cells[0].values[1]));
  CHECK(all.cells[1].values[2] == 1.0 / 3);
  CHECK(all.cells[1].values[3] == 1e-300);
  CHECK(all.cells[2].reasons == std::vector<std::string>{"one", "two\nlines"});
  CHECK(all.cells[3].target == 2);
  CHECK(all.plan.variants[1].label == "b, \"quoted\"");
  CHECK(espdiff::plan_difference(all.plan, plan_of_three()).empty());
}

TEST_CASE("a row that a killed run left incomplete is taken away, wherever it ends") {
  const ScratchFolder folder;
  const std::string whole = read_file(written_state(folder));
  const std::size_t last = line_start(whole, 5);
  for (const std::size_t n : {last + 1, last + 20, last + 40, whole.size() - 1}) {
    const std::string path = folder.write("cut.state", whole.substr(0, n));
    const MatrixStateContent content = read_matrix_state(path);
    CHECK(content.cut_off);
    CHECK(content.cells.size() == 2);
    MatrixStateContent earlier;
    MatrixState::go_on(path, plan_of_three(), earlier).add(cell_of(1, 0, -7));
    CHECK(read_file(path) == whole);
  }
}

TEST_CASE("a byte that was changed, a line left out or moved, is found and its line named") {
  const ScratchFolder folder;
  const std::string whole = read_file(written_state(folder));
  for (const int line : {2, 3, 4, 5}) {
    std::string changed = whole;
    char& byte = changed[line_start(whole, line) + 60];
    byte = byte == 'x' ? 'y' : 'x';
    const std::string path = folder.write("d.state", changed);
    const std::string message = message_of([&] { read_matrix_state(path); });
    CHECK_MESSAGE(contains(message, "d.state:" + std::to_string(line) + ": the state file is damaged"), message);
    CHECK(contains(message, "overwrite"));
  }
  const std::size_t third = line_start(whole, 3), fourth = line_start(whole, 4);
  const std::string without = whole.substr(0, third) + whole.substr(fourth);
  CHECK(
      contains(message_of([&] { read_matrix_state(folder.write("d.state", without)); }), "damaged from this line on"));
  std::string zeros = whole;
  zeros.replace(line_start(whole, 5), 10, std::string(10, '\0'));
  CHECK(contains(message_of([&] { read_matrix_state(folder.write("d.state", zeros)); }),
                 ":5: the state file is damaged"));
}

TEST_CASE("another kind of file, and one without a row, say so") {
  const ScratchFolder folder;
  const std::string whole = read_file(written_state(folder));
  CHECK(contains(message_of([&] { read_matrix_state(folder.write("x", "source,target\n")); }),
                 "no state file of a matrix"));
  CHECK(contains(message_of([&] { read_matrix_state(folder.write("x", "")); }), "no state file of a matrix"));
  CHECK(contains(message_of([&] { read_matrix_state(folder.write("x", whole.substr(0, line_start(whole, 2) + 50))); }),
                 "cut off before its first row"));
  CHECK(contains(message_of([&] { read_matrix_state(folder.file("absent")); }), "cannot be read"));
}

TEST_CASE("a file of another run says what differs") {
  const ScratchFolder folder;
  const std::string path = written_state(folder);
  const auto refusal = [&](const MatrixPlan& plan) {
    return message_of([&] {
      MatrixStateContent content;
      MatrixState::go_on(path, plan, content);
    });
  };
  MatrixPlan plan = plan_of_three();
  plan.settings[0].second = "0.8";
  CHECK(contains(refusal(plan), "of another run: the setting grid-spacing is 1 there and 0.8 here"));
  plan = plan_of_three();
  plan.variants[2].inputs[0].sha256 = std::string(64, '0');
  CHECK(contains(refusal(plan), "the structure of c has changed"));
  plan = plan_of_three();
  plan.variants.pop_back();
  CHECK(contains(refusal(plan), "the number of variants is 3 there and 2 here"));
  plan = plan_of_three();
  plan.device = "cuda";
  CHECK(contains(refusal(plan), "the device is cpu there and cuda here"));
  plan = plan_of_three();
  plan.variants[0].group = "other";
  plan.variants[0].inputs[0].path = "moved/a.pqr";
  CHECK(refusal(plan) == "(nothing thrown)");
}

TEST_CASE("one process at a time writes a state file") {
  const ScratchFolder folder;
  const std::string path = folder.file("m.state");
  const MatrixState state = MatrixState::begin(path, plan_of_three());
  MatrixStateContent content;
  CHECK(
      contains(message_of([&] { MatrixState::go_on(path, plan_of_three(), content); }), "another process is writing"));
  CHECK(contains(message_of([&] { MatrixState::begin(path, plan_of_three()); }), "another process is writing"));
}

TEST_SUITE_END();
