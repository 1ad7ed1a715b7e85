// error.cpp: names, exit statuses and messages of the error classes.
#include "base/error.h"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "base/progress.h"
#include "base/work.h"
#include "support/test_data.h"

using espdiff::Error;
using espdiff::ErrorClass;
using espdiff_test::message_of;

TEST_SUITE_BEGIN("errors");

TEST_CASE("input, format and I/O errors exit with 2, all others with 1") {
  std::set<std::string> names;
  for (int c = 0; c <= static_cast<int>(ErrorClass::kInternal); ++c) {
    const ErrorClass error_class = static_cast<ErrorClass>(c);
    const bool by_user =
        error_class == ErrorClass::kInput || error_class == ErrorClass::kFormat || error_class == ErrorClass::kIo;
    CHECK(Error(error_class, "text").exit_status() == (by_user ? 2 : 1));
    names.insert(espdiff::error_class_name(error_class));
  }
  CHECK(names == std::set<std::string>{"INPUT", "FORMAT", "IO", "GEOMETRY", "CONVERGENCE", "DEVICE", "MEMORY",
                                       "CANCELLED", "INTERNAL"});
}

TEST_CASE("each kind carries its class") {
  CHECK(espdiff::InputError("a").error_class() == ErrorClass::kInput);
  CHECK(espdiff::FormatError("f", 1, "a").error_class() == ErrorClass::kFormat);
  CHECK(espdiff::IoError("f", "a").error_class() == ErrorClass::kIo);
  CHECK(espdiff::GeometryError("a").error_class() == ErrorClass::kGeometry);
  CHECK(espdiff::ConvergenceError("a").error_class() == ErrorClass::kConvergence);
  CHECK(espdiff::DeviceError("a").error_class() == ErrorClass::kDevice);
  CHECK(espdiff::MemoryError("a").error_class() == ErrorClass::kMemory);
  CHECK(espdiff::Cancelled().error_class() == ErrorClass::kCancelled);
}

TEST_CASE("file errors name the file, and the line where there is one") {
  CHECK(std::string(espdiff::FormatError("a.pqr", 7, "bad number").what()) == "a.pqr:7: bad number");
  CHECK(std::string(espdiff::FormatError("a.vti", 0, "bad extent").what()) == "a.vti: bad extent");
  CHECK(std::string(espdiff::IoError("a.dx", "no such file").what()) == "a.dx: no such file");
}

TEST_CASE("progress is reported until cancellation") {
  int n = 0;
  espdiff::Progress progress([&](const std::string& stage, double fraction) {
    CHECK(stage == "stage");
    CHECK(fraction == 0.5);
    ++n;
  });
  progress.report("stage", 0.5);
  CHECK_NOTHROW(progress.check_cancelled());
  progress.request_cancel();
  CHECK_THROWS_AS(progress.report("stage", 0.5), espdiff::Cancelled);
  CHECK_THROWS_AS(progress.check_cancelled(), espdiff::Cancelled);
  CHECK(n == 1);
  CHECK_NOTHROW(espdiff::Progress().report("nobody listens", 1));
}

TEST_CASE("a request to cancel holds for its thread, in a scope, and for any Progress there") {
  espdiff::Progress asked;
  const espdiff::Progress other;
  const espdiff::CancelRequest before;
  {
    const espdiff::CancelScope scope(asked);
    CHECK_FALSE(espdiff::CancelRequest().made());
    asked.request_cancel();
    CHECK(espdiff::CancelRequest().made());
    CHECK_THROWS_AS(espdiff::CancelRequest().check(), espdiff::Cancelled);
    CHECK_THROWS_AS(other.check_cancelled(), espdiff::Cancelled);
    {
      const espdiff::CancelScope inner(other);
      CHECK_FALSE(espdiff::CancelRequest().made());
    }
    CHECK(espdiff::CancelRequest().made());
    CHECK_FALSE(before.made());
  }
  CHECK_FALSE(espdiff::CancelRequest().made());
  CHECK_NOTHROW(other.report("stage", 0));
}

TEST_CASE("work of more than a day is refused with what it follows from") {
  using espdiff::option;
  CHECK_NOTHROW(espdiff::require_work(1.7e13, "a sum", "give less"));
  CHECK(
      message_of([] {
        espdiff::require_work(3e14, "a sum over 1e+09 charges", "give a larger " + option("ewaldfactor", "0.25"));
      }) ==
      "a sum over 1e+09 charges: about 3e+14 steps, 417 hours of one core (limit 24 hours); give a larger ewaldfactor "
      "0.25");
  CHECK(message_of([] { espdiff::require_work(1e20, "a sum", "give less"); }) ==
        "a sum: about 1e+20 steps, 15844 years of one core (limit 24 hours); give less");
}

TEST_SUITE_END();
