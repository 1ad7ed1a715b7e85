// boundary.cpp: every exception becomes a class and a line; no exception passes.
#include "vmdplugin/bridge/boundary.h"

#include <doctest/doctest.h>

#include <stdexcept>

using espdiff::boundary;
using espdiff::Failure;

namespace {

template <typename Body>
std::string outcome(Body body) {
  return boundary(
      [&]() -> std::string {
        body();
        return "returned";
      },
      [](const Failure& failure) { return std::string(failure.error_class) + ": " + failure.message.plain(); });
}

}  // namespace

TEST_CASE("boundary: what body returns is returned") {
  const auto refuse = [](const Failure&) { return -1; };
  CHECK(boundary([] { return 7; }, refuse) == 7);
  CHECK(boundary([]() -> int { throw 7; }, refuse) == -1);
  int n_calls = 0;
  boundary([&] { ++n_calls; }, [&](const Failure&) { n_calls = 100; });
  CHECK(n_calls == 1);
}

TEST_CASE("boundary: the class of each exception") {
  CHECK(outcome([] {}) == "returned");
  CHECK(outcome([] { throw espdiff::InputError("no atoms"); }) == "INPUT: no atoms");
  CHECK(outcome([] { throw espdiff::FormatError("a.dx", 3, "no counts"); }) == "FORMAT: a.dx:3: no counts");
  CHECK(outcome([] { throw espdiff::Cancelled(); }) == "CANCELLED: cancelled; nothing was written");
  CHECK(outcome([] { throw std::bad_alloc(); }) ==
        "MEMORY: not enough memory; use a larger grid-spacing, select fewer atoms, or close other programs");
  CHECK(outcome([] { throw std::out_of_range("index 7"); }) ==
        "INTERNAL: internal error: index 7; please report it with the command and, if you can, the input");
  CHECK(outcome([] { throw "text"; }) ==
        "INTERNAL: internal error: an exception of unknown type; please report it with the command");
}

TEST_CASE("boundary: nothing can be thrown through it") {
  const auto body = []() -> int { throw 7; };
  const auto on_failure = [](const Failure&) { return -1; };
  static_assert(noexcept(boundary(body, on_failure)));
  CHECK(boundary(body, on_failure) == -1);
}
