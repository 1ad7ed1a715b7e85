// json_integer.cpp: what is a whole number of a type, and what is not.
#include "io/text/json_integer.h"

#include <doctest/doctest.h>

#include <limits>
#include <nlohmann/json.hpp>

using namespace espdiff;
using Json = nlohmann::json;

namespace {

template <typename Integer>
void check_refused(const Json& json) {
  CHECK_THROWS_AS(integer_of<Integer>(json), std::out_of_range);
}

}  // namespace

TEST_CASE("whole numbers within a type's range come as they are") {
  CHECK(integer_of<int>(Json::parse("2147483647")) == std::numeric_limits<int>::max());
  CHECK(integer_of<int>(Json::parse("-2147483648")) == std::numeric_limits<int>::min());
  CHECK(integer_of<int>(Json(7)) == 7);  // held as a signed number, as one that was read is not
  CHECK(integer_of<std::size_t>(Json::parse("18446744073709551615")) == std::numeric_limits<std::size_t>::max());
  CHECK(integer_of<char>(Json(65)) == 'A');
}

TEST_CASE("other values are refused, not cast") {
  for (const char* const text : {"1e30", "1.5", "1.0", "\"1\"", "null", "true", "[1]", "2147483648", "-2147483649",
                                 "18446744073709551615", "99999999999999999999999"})
    check_refused<int>(Json::parse(text));
  check_refused<std::size_t>(Json::parse("-1"));
  check_refused<std::size_t>(Json::parse("1e3"));
  check_refused<char>(Json::parse("300"));
}
