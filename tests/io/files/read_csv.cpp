// read_csv.cpp: tables as spreadsheets and we write them, and every way in which one is refused.
#include "io/files/read_csv.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "support/test_data.h"

using espdiff::CsvTable;
using espdiff::read_csv;
using namespace espdiff_test;  // NOLINT: a test

TEST_SUITE_BEGIN("read_csv");

TEST_CASE("comments, empty lines, quotes, line ends of other systems and a byte-order mark") {
  const ScratchFolder folder;
  const std::string path = folder.write("t.csv",
                                        "\xEF\xBB\xBF# about\r\n\r\nlabel, value ,note\r\n"
                                        "a,1.5,\"says \"\"no\"\", twice\"\r\n# in between\r\n"
                                        "b,, \"two\nlines\" \r\nc,-2e-3,");
  const CsvTable table = read_csv(path);
  CHECK(table.columns == std::vector<std::string>{"label", "value", "note"});
  REQUIRE(table.rows.size() == 3);
  CHECK(table.rows[0] == std::vector<std::string>{"a", "1.5", "says \"no\", twice"});
  CHECK(table.rows[1] == std::vector<std::string>{"b", "", "two\nlines"});
  CHECK(table.rows[2] == std::vector<std::string>{"c", "-2e-3", ""});
  CHECK(table.lines == std::vector<long>{4, 6, 8});
  CHECK(table.number(2, 1) == doctest::Approx(-0.002));
  CHECK(std::isnan(table.number(1, 1)));
  CHECK(table.find("note") == 2);
  CHECK(table.find("none") == -1);
}

TEST_CASE("a tab in the row of names parts fields, and commas do not") {
  const ScratchFolder folder;
  const CsvTable table = read_csv(folder.write("t.tsv", "a\tb\n1,5\t2\n\t3\n"));
  CHECK(table.rows[0] == std::vector<std::string>{"1,5", "2"});
  CHECK(table.rows[1] == std::vector<std::string>{"", "3"});
}

TEST_CASE("what is wrong is named with its line") {
  const ScratchFolder folder;
  const auto refusal = [&](const std::string& text) {
    const std::string path = folder.write("t.csv", text);
    return message_of([&] { read_csv(path); });
  };
  CHECK(refusal("# only this\n").find("no row of column names") != std::string::npos);
  CHECK(refusal("a,b,a\n").find("'a' is there twice") != std::string::npos);
  CHECK(refusal("a,b\n1,2\n\n3\n").find(":4: 1 fields instead of 2 (a, b)") != std::string::npos);
  CHECK(refusal("a\n\"open\n").find(":2: a quote is opened and never closed") != std::string::npos);
  CHECK(refusal("a\n\"x\"y\n").find("text follows a closing quote") != std::string::npos);
  CHECK(message_of([&] { read_csv(folder.file("absent.csv")); }).find("absent.csv") != std::string::npos);
  const CsvTable table = read_csv(folder.write("n.csv", "a,b\n1,x\n"));
  CHECK(message_of([&] { table.number(0, 1); }).find("n.csv:2: column b: 'x' is no number") != std::string::npos);
  CHECK(message_of([&] { table.require("c"); }).find("there is no column 'c'; there are: a, b") != std::string::npos);
}

TEST_SUITE_END();
