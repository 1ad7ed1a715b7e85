// multigrid_forms.cpp: a multigrid cycle in passes over planes gives the bits of its single steps, at any number of
// threads, and is symmetric. Compiled with the CPU back end's flags, because the engine's interface offers neither.
#include <doctest/doctest.h>
#include <omp.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "base/progress.h"
#include "cuda/device/launch.h"
#include "cuda/potential/pb/conjugate_gradients.h"
#include "cuda/potential/pb/multigrid/multigrid.h"
#include "cuda/potential/pb/multigrid/operator_rows.h"
#include "cuda/potential/pb/multigrid/packed_operator.h"
#include "support/random.h"

using namespace espdiff_test;
using namespace espdiff::cpu_backend;

namespace {

/// Faces between those of a solute and of water, ions at some points.
GridOperator random_operator(GridSize size, Random& random) {
  GridOperator a;
  a.size = size;
  for (Buffer<float>* buffer : {&a.ex, &a.ey, &a.ez, &a.diagonal}) buffer->assign(size.points(), 0.0F);
  for (std::size_t p = 0; p < size.points(); ++p) {
    for (Buffer<float>* faces : {&a.ex, &a.ey, &a.ez}) raw(*faces)[p] = random.uniform(0, 1) < 0.5 ? 2.0F : 78.54F;
    raw(a.diagonal)[p] = random.uniform(0, 1) < 0.3 ? 0.5F : 0.0F;
  }
  add_faces_to_diagonal(a);
  return a;
}

/// Random inside, zero on the border.
Buffer<float> random_values(GridSize size, Random& random) {
  Buffer<float> values(size.points(), 0.0F);
  for (int k = 1; k < size.nz - 1; ++k) {
    for (int j = 1; j < size.ny - 1; ++j) {
      for (int i = 1; i < size.nx - 1; ++i)
        raw(values)[size.index(i, j, k)] = static_cast<float>(random.uniform(-1, 1));
    }
  }
  return values;
}

std::size_t n_different(const Buffer<float>& a, const Buffer<float>& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += raw(a)[i] == raw(b)[i] ? 0 : 1;
  return n;
}

/// Runs with so many threads.
class Threads {
 public:
  explicit Threads(int n) : before_(omp_get_max_threads()) { omp_set_num_threads(n); }
  ~Threads() { omp_set_num_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

// The last four are run by several threads; the second and the last two have axes that are no multiple of two plus one.
// Planes of the last one are swept in three strips.
const GridSize kSizes[] = {{9, 9, 9}, {12, 10, 9}, {33, 25, 41}, {25, 33, 65}, {30, 26, 44}, {260, 401, 20}};

}  // namespace

TEST_SUITE_BEGIN("multigrid");

TEST_CASE("a cycle in passes has the bits of its single steps, at any number of threads") {
  for (const GridSize& size : kSizes) {
    Random random(7);
    const GridOperator a = random_operator(size, random);
    const Buffer<float> r = random_values(size, random);
    Buffer<float> by_points(size.points(), 0.0F);
    Multigrid(a).precondition_by_points(r, by_points);
    CHECK(dot_product(by_points, by_points) > 0);
    double product = 0;
    for (const int n : {1, 2, 3, 4}) {
      const Threads threads(n);
      Buffer<float> z(size.points(), 0.0F);
      const double found = Multigrid(a).precondition(r, z);
      CAPTURE(size.nz);
      CAPTURE(n);
      CHECK(n_different(z, by_points) == 0);
      CHECK(found == doctest::Approx(dot_product(r, z)).epsilon(1e-12));
      if (n > 1) CHECK(found == product);
      product = found;
    }
  }
}

TEST_CASE("the direction and its image in one pass are those of two, at any number of threads") {
  for (const GridSize& size : kSizes) {
    Random random(8);
    const GridOperator a = random_operator(size, random);
    const Buffer<float> z = random_values(size, random), p = random_values(size, random);
    constexpr float kBeta = 0.37F;
    Buffer<float> direction(size.points(), 0.0F), image(size.points(), 0.0F);
    for (std::size_t i = 0; i < size.points(); ++i) raw(direction)[i] = raw(z)[i] + kBeta * raw(p)[i];
    for (const Products products : {Products::kRounded, Products::kExact}) {
      apply_operator(a, direction, image, products);
      for (const int n : {1, 2, 4}) {
        const Threads threads(n);
        Buffer<float> own_z = z, own_p = p;
        const double product = Multigrid(a).turn_and_apply(kBeta, own_z, own_p, products);
        CHECK(n_different(own_p, direction) == 0);
        CHECK(n_different(own_z, image) == 0);
        CHECK(product == doctest::Approx(dot_product(direction, image)).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("a solution that is taken direction by direction has nearly the residual that is reported") {
  const GridSize size{33, 25, 41};
  GridOperator a;
  a.size = size;
  for (Buffer<float>* faces : {&a.ex, &a.ey, &a.ez}) faces->assign(size.points(), 78.54F);
  a.diagonal.assign(size.points(), 0.5F);
  add_faces_to_diagonal(a);
  Buffer<float> x(size.points(), 0.0F), low(size.points(), 0.0F), b(size.points(), 0.0F);
  raw(b)[size.index(16, 12, 20)] = 1;
  SolverWork work(size.points());
  work.r = b;
  SolverOptions options;
  options.tolerance = 1e-8;
  std::vector<double> taken(size.points(), 0.0);
  Multigrid multigrid(a);
  const SolverReport report = conjugate_gradients(
      multigrid, options, work,
      [&](double alpha, const Buffer<float>& p) {
        for (std::size_t i = 0; i < taken.size(); ++i) taken[i] += alpha * static_cast<double>(raw(p)[i]);
      },
      [](double) {});
  REQUIRE(report.converged);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    raw(x)[i] = static_cast<float>(taken[i]);
    raw(low)[i] = static_cast<float>(taken[i] - static_cast<double>(raw(x)[i]));
  }
  subtract_exactly(a, x, low, b);
  // 4.7e-8; with products added up in single precision 1.4e-7, and more on a larger grid.
  CHECK(std::sqrt(dot_product(b, b)) < 8e-8);
}

namespace {

/// Ions everywhere or nowhere; one face in thirty is cut by the boundary. The diagonal holds k alone.
GridOperator cut_operator(GridSize size, Random& random) {
  GridOperator a = random_operator(size, random);
  for (std::size_t p = 0; p < size.points(); ++p) {
    raw(a.diagonal)[p] = random.uniform(0, 1) < 0.3 ? 0.5F : 0.0F;
    if (random.uniform(0, 1) < 0.1)
      raw(p % 3 == 0 ? a.ex : p % 3 == 1 ? a.ey : a.ez)[p] = static_cast<float>(random.uniform(3, 70));
  }
  return a;
}

/// A ball of solute with a Stern layer, in a corner, so that many rows are plain, with ions, without, and with both.
/// The diagonal holds k alone.
GridOperator ball_operator(GridSize size) {
  GridOperator a;
  a.size = size;
  for (Buffer<float>* buffer : {&a.ex, &a.ey, &a.ez, &a.diagonal}) buffer->assign(size.points(), 0.0F);
  const auto distance = [](double i, double j, double k) { return std::hypot(i - 4, j - 4, k - 4); };
  for (int k = 0; k < size.nz; ++k) {
    for (int j = 0; j < size.ny; ++j) {
      for (int i = 0; i < size.nx; ++i) {
        const std::size_t p = size.index(i, j, k);
        const auto face = [&](double r) { return r < 2 ? 2.0F : r < 2.4 ? 20.0F : 78.54F; };
        raw(a.ex)[p] = face(distance(i + 0.5, j, k));
        raw(a.ey)[p] = face(distance(i, j + 0.5, k));
        raw(a.ez)[p] = face(distance(i, j, k + 0.5));
        raw(a.diagonal)[p] = k > size.nz / 2 || distance(i, j, k) < 4 ? 0.0F : 0.5F;
      }
    }
  }
  return a;
}

/// Rows that are mixed as a whole and in part, and plain ones with ions and without.
bool has_all_kinds_of_rows(const PackedOperator& packed, const GridSize& size) {
  bool has[4] = {};
  const std::uint32_t end = static_cast<std::uint32_t>(size.nx - 1);
  for (int row = 0; row < size.ny * size.nz; ++row) {
    const espdiff::cpu_backend::MixedPoints& mixed = packed.view().mixed[row];
    has[mixed.first == 1 && mixed.last == end ? 0 : mixed.first < mixed.last ? 1 : 2 + mixed.has_ions()] = true;
  }
  return has[0] && (has[1] || end < 18) && has[2] && has[3];
}

}  // namespace

TEST_CASE("packed coefficients give the bits of arrays, at any number of threads") {
  for (std::size_t of = 0; of < 2 * std::size(kSizes); ++of) {
    const GridSize size = kSizes[of / 2];
    const bool is_ball = of % 2 == 1;
    Random random(11);
    GridOperator arrays = is_ball ? ball_operator(size) : cut_operator(size, random);
    const auto packed = espdiff::cpu_backend::PackedOperator::pack(arrays, {2.0F, 78.54F, 0.5F}, 2);
    REQUIRE(packed != nullptr);
    if (is_ball) CHECK(has_all_kinds_of_rows(*packed, size));
    GridOperator again;
    packed->unpack(again);
    CHECK(n_different(again.ex, arrays.ex) + n_different(again.ey, arrays.ey) + n_different(again.ez, arrays.ez) +
              n_different(again.diagonal, arrays.diagonal) ==
          0);
    add_faces_to_diagonal(arrays);
    const Buffer<float> r = random_values(size, random), low = random_values(size, random);
    Buffer<float> z(size.points(), 0.0F), direction = r, image = low, rest = r, rest_of_one = r;
    Multigrid of_arrays(arrays);
    const double product = of_arrays.precondition(r, z), turned = of_arrays.turn_and_apply(0.4F, image, direction);
    subtract_exactly(arrays, z, low, rest);
    subtract_exactly(arrays, z, {}, rest_of_one);
    for (const int n : {1, 2, 4}) {
      const Threads threads(n);
      GridOperator a = again;
      add_faces_to_diagonal(a, packed);
      constexpr std::size_t kAllPacked = 0;
      Multigrid multigrid(a, kAllPacked);
      spare_arrays(a);
      REQUIRE(a.ex.empty());
      Buffer<float> own_z(size.points(), 0.0F), own_p = r, own_q = low, own_rest = r, own_rest_of_one = r;
      CHECK(multigrid.precondition(r, own_z) == product);
      CHECK(multigrid.turn_and_apply(0.4F, own_q, own_p) == turned);
      subtract_exactly(a, own_z, low, own_rest);
      subtract_exactly(a, own_z, {}, own_rest_of_one);
      CHECK(n_different(own_z, z) == 0);
      CHECK(n_different(own_q, image) == 0);
      CHECK(n_different(own_rest, rest) == 0);
      CHECK(n_different(own_rest_of_one, rest_of_one) == 0);
    }
  }
}

TEST_CASE("a request to cancel within a loop over ranges ends the computation behind the loop, not the program") {
  const GridSize size{9, 9, 9};
  const GridOperator arrays = ball_operator(size);
  GridOperator a = arrays;
  add_faces_to_diagonal(a, espdiff::cpu_backend::PackedOperator::pack(arrays, {2.0F, 78.54F, 0.5F}, 2));
  for (const int n : {1, 2}) {
    const Threads threads(n);
    espdiff::Progress progress;
    const espdiff::CancelScope scope(progress);
    const auto loop = [&] {
      for_each_index(1, [&](std::size_t) {
        progress.request_cancel();
        Buffer<float> storage;
        OperatorRows(a, storage, PlainEnds::kUnpacked).hold(1);
      });
    };
    CHECK_THROWS_AS(loop(), espdiff::Cancelled);
  }
}

TEST_CASE("the cycle is symmetric and positive, as conjugate gradients need it") {
  Random random(9);
  const GridSize size{33, 25, 41};
  const GridOperator a = random_operator(size, random);
  const Buffer<float> x = random_values(size, random), y = random_values(size, random);
  Buffer<float> of_x(size.points(), 0.0F), of_y(size.points(), 0.0F);
  Multigrid multigrid(a);
  const double xx = multigrid.precondition(x, of_x), yy = multigrid.precondition(y, of_y);
  CHECK(xx > 0);
  CHECK(yy > 0);
  CHECK(std::fabs(dot_product(y, of_x) - dot_product(x, of_y)) < 2e-6 * std::sqrt(xx * yy));
}

TEST_CASE("a step along the direction changes x and the residual, and returns the residual's square") {
  const std::size_t n = 40001;
  Random random(10);
  Buffer<float> p(n, 0.0F), q(n, 0.0F), x(n, 0.0F), r(n, 0.0F);
  for (Buffer<float>* values : {&p, &q, &x, &r}) {
    for (std::size_t i = 0; i < n; ++i) raw(*values)[i] = static_cast<float>(random.uniform(-1, 1));
  }
  const Buffer<float> x_before = x, r_before = r;
  const double square = advance(0.25F, p, q, x, r);
  for (std::size_t i = 0; i < n; i += 777) {
    CHECK(raw(x)[i] == raw(x_before)[i] + 0.25F * raw(p)[i]);
    CHECK(raw(r)[i] == raw(r_before)[i] - 0.25F * raw(q)[i]);
  }
  CHECK(square == doctest::Approx(dot_product(r, r)).epsilon(1e-12));
  Buffer<float> without_x = r_before;
  CHECK(subtract_scaled(0.25F, q, without_x) == square);
  CHECK(to_host(without_x) == to_host(r));
}

TEST_SUITE_END();
