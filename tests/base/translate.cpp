// translate.cpp: what the standard library throws becomes ours, with the file where there is one.
#include "base/text/translate.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <vector>

using espdiff::Error;
using espdiff::ErrorClass;

namespace {

Error translation_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return espdiff::translated(error);
  }
  return {ErrorClass::kInternal, "(nothing thrown)"};
}

}  // namespace

TEST_CASE("an error of ours stays what it is") {
  const Error error = translation_of([] { throw espdiff::FormatError("a.dx", 3, "no counts"); });
  CHECK(error.error_class() == ErrorClass::kFormat);
  CHECK(error.what() == std::string("a.dx:3: no counts"));
  CHECK(error.exit_status() == 2);
}

TEST_CASE("a failure of the file system names the file and the reason") {
  const Error error = translation_of([] { (void)std::filesystem::file_size("/no/such/file"); });
  CHECK(error.error_class() == ErrorClass::kIo);
  CHECK(error.what() ==
        std::string("/no/such/file: cannot be used: No such file or directory; check the path and its permissions"));
}

TEST_CASE("lack of memory is told with a remedy, also where a container says it") {
  for (const auto& call : std::vector<std::function<void()>>{
           [] { throw std::bad_alloc(); }, [] { std::string().reserve(std::string().max_size() + 1); }}) {
    const Error error = translation_of(call);
    CHECK(error.error_class() == ErrorClass::kMemory);
    CHECK(std::string(error.what()).find("not enough memory; use a larger grid-spacing, select fewer atoms") == 0);
    CHECK(error.exit_status() == 1);
  }
}

TEST_CASE("a thread that cannot be made, and mistakes of ours") {
  const Error threads =
      translation_of([] { throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again)); });
  CHECK(threads.error_class() == ErrorClass::kDevice);
  CHECK(std::string(threads.what()).find("the system refused: Resource temporarily unavailable; close") == 0);
  const Error mistake = translation_of([] { std::vector<int>().at(3) = 1; });
  CHECK(mistake.error_class() == ErrorClass::kInternal);
  CHECK(std::string(mistake.what()).find("internal error: ") == 0);
  CHECK(std::string(mistake.what()).find("please report it") != std::string::npos);
}
