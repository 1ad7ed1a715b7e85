// Values of JSON and CBOR, counted before a parser makes objects of them.
#include "io/text/json_values.h"

#include <doctest/doctest.h>

#include <string>

using espdiff::count_cbor_values;

namespace {

/// A number of arrays within each other, with a 1 in the innermost.
std::string nested(std::size_t n_levels) { return std::string(n_levels, '\x81') + '\x01'; }

}  // namespace

TEST_CASE("count_cbor_values: each item counts, and so do the names in a map") {
  CHECK(count_cbor_values("\x01").value() == 1);
  CHECK(count_cbor_values("\x80").value() == 1);
  CHECK(count_cbor_values("\x83\x01\x20\x65hello").value() == 4);
  CHECK(count_cbor_values("\xa2\x61\x61\x01\x61\x62\x82\x01\x02").value() == 7);
  CHECK(count_cbor_values("\xfb\x3f\xf8zzzzzz").value() == 1);                                    // a double
  CHECK(count_cbor_values(std::string("\x59\x01\x00", 3) + std::string(256, 'x')).value() == 1);  // 256 bytes
  CHECK(count_cbor_values(nested(16)).value() == 17);
}

TEST_CASE("count_cbor_values: what is cut, followed by more, nested deeper, tagged or of unknown length is none") {
  const std::string whole = "\xa2\x61\x61\x01\x61\x62\x82\x01\x02";
  for (std::size_t n = 0; n < whole.size(); ++n) CHECK_FALSE(count_cbor_values(whole.substr(0, n)));
  CHECK_FALSE(count_cbor_values(whole + "\x01"));
  CHECK_FALSE(count_cbor_values(nested(17)));
  CHECK_FALSE(count_cbor_values(nested(10'000'000)));
  CHECK_FALSE(count_cbor_values("\xc1\x01"));                              // tagged
  CHECK_FALSE(count_cbor_values("\x9f\x01\xff"));                          // of unknown length
  CHECK_FALSE(count_cbor_values("\x7f\x61\x61\xff"));                      // the same of text
  CHECK_FALSE(count_cbor_values("\x1c"));                                  // reserved
  CHECK_FALSE(count_cbor_values("\x9b\xff\xff\xff\xff\xff\xff\xff\xff"));  // 2^64 - 1 items
  CHECK_FALSE(count_cbor_values("\xbb\x80\xff\xff\xff\xff\xff\xff\xff"));  // twice as many as that is 0, or so
  CHECK_FALSE(count_cbor_values("\x5b\xff\xff\xff\xff\xff\xff\xff\xff"));
}
