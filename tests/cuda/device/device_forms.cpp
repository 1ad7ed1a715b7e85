// device_forms.cpp: the parallel primitives of the CPU back end, compiled with its flags.
#include "cuda/device/device_forms.h"

#include <atomic>

#include "base/progress.h"

TEST_CASE("the primitives of the CPU back end") { espdiff::cpu_backend::forms::check_all(); }

TEST_CASE("a loop over indices ends when its thread's request to cancel is made") {
  // Few indices, each much work, and many.
  for (const std::size_t n : {std::size_t{1000}, std::size_t{1000000}}) {
    espdiff::Progress progress;
    espdiff::Progress* const asked = &progress;
    std::atomic<std::size_t> n_done{0};
    std::atomic<std::size_t>* const done = &n_done;
    const auto body = [=](std::size_t) {
      if (++*done == 10) asked->request_cancel();
    };
    {
      const espdiff::CancelScope scope(progress);
      CHECK_THROWS_AS(espdiff::cpu_backend::for_each_index(n, body), espdiff::Cancelled);
    }
    CHECK(n_done >= 10);
    CHECK(n_done < 1000);
    n_done = 0;
    CHECK_NOTHROW(espdiff::cpu_backend::for_each_index(n, body));  // on this thread nobody asks any more
    CHECK(n_done == n);
  }
}

TEST_CASE("a loop within a loop's iteration throws nothing there when its thread's request to cancel is made") {
  espdiff::Progress progress;
  espdiff::Progress* const asked = &progress;
  std::atomic<std::size_t> n_inner{0};
  std::atomic<std::size_t>* const inner = &n_inner;
  const espdiff::CancelScope scope(progress);
  // Out of an iteration an exception would end the program. The first index is the asking thread's.
  const auto body = [=](std::size_t i) {
    if (i != 0) return;
    asked->request_cancel();
    espdiff::cpu_backend::for_each_index(10, [=](std::size_t) { ++*inner; });
  };
  CHECK_THROWS_AS(espdiff::cpu_backend::for_each_index(1000, body), espdiff::Cancelled);
  CHECK(n_inner == 10);
  CHECK_THROWS_AS(progress.check_cancelled(), espdiff::Cancelled);  // the thread has its request again
  CHECK_THROWS_AS(espdiff::cpu_backend::for_each_index(10, body), espdiff::Cancelled);
}
