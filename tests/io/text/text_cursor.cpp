// text_cursor.cpp: numbers, words and line numbers of text.
#include "io/text/text_cursor.h"

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;

TEST_CASE("text_cursor: numbers in all spellings that our formats use") {
  const auto number = [](const char* word) {
    double value = -99;
    CHECK_MESSAGE(parse_number(word, value), word);
    return value;
  };
  CHECK(number("1") == 1);
  CHECK(number("+1.5") == 1.5);
  CHECK(number("-2e-3") == -0.002);
  CHECK(number(".5") == 0.5);
  CHECK(number("5.") == 5);
  CHECK(number("1.25D-03") == 0.00125);
  CHECK(number("1.25d2") == 125);
  CHECK(number("1e-400") == 0);
}

TEST_CASE("text_cursor: what is no finite number is refused and leaves the value") {
  for (const char* word : {"", "nan", "NaN", "inf", "-Infinity", "1e400", "1.2x", "1,5", "--1", "++1", "+-", "-",
                           "1.5D", "0x1p3", "1 2"}) {
    double value = 7;
    CHECK_FALSE_MESSAGE(parse_number(word, value), word);
    CHECK(value == 7);
  }
}

TEST_CASE("text_cursor: integers") {
  long long value = 0;
  CHECK(parse_integer("-12", value));
  CHECK(value == -12);
  CHECK(parse_integer("+7", value));
  CHECK(value == 7);
  for (const char* word : {"", "1.0", "12a", "99999999999999999999", "+-1"})
    CHECK_FALSE_MESSAGE(parse_integer(word, value), word);
  CHECK(value == 7);
}

TEST_CASE("text_cursor: walks by words, numbers and lines") {
  const std::string path = "f";
  TextCursor cursor("alpha 1.5\r\n\n  2 rest of it \r\nlast", path);
  CHECK(cursor.next_word() == "alpha");
  CHECK(cursor.line() == 1);
  CHECK(cursor.next_number("x") == 1.5);
  CHECK(cursor.peek_word() == "2");
  CHECK(cursor.next_integer("n") == 2);
  CHECK(cursor.line() == 3);
  CHECK(cursor.rest_of_line() == "rest of it");
  double value = 3;
  CHECK_FALSE(cursor.try_number(value));
  CHECK(cursor.next_word() == "last");
  CHECK(cursor.line() == 4);
  CHECK(cursor.at_end());
  CHECK(cursor.next_word().empty());
}

TEST_CASE("text_cursor: errors name file, line and word") {
  const std::string path = "map.dx";
  TextCursor cursor("origin 1 abc\n", path);
  cursor.next_word();
  CHECK(cursor.next_number("origin") == 1);
  CHECK(message_of([&] { cursor.next_number("origin"); }) == "map.dx:1: origin is 'abc'; a finite number was expected");
  cursor.next_word();
  // At the end the last line is named, not the empty one behind its newline.
  CHECK(message_of([&] { cursor.next_integer("count"); }) ==
        "map.dx:1: count is missing at the end of the file; an integer was expected");
}

TEST_CASE("text_cursor: quoted text is short and on one line") {
  CHECK(in_quotes("abc") == "'abc'");
  CHECK(in_quotes("a\nb\x01\xff") == "'a?b?\?'");
  CHECK(in_quotes(std::string(100, 'x')) == "'" + std::string(40, 'x') + "...'");
}
