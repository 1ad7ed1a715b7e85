// write_csv.cpp: numbers and quoting.
#include "io/files/write_csv.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "io/files/read_csv.h"

using namespace espdiff;

TEST_CASE("numbers are short, and no value is an empty field") {
  CHECK(csv_number(0.5) == "0.5");
  CHECK(csv_number(-1234567.0) == "-1.23457e+06");
  CHECK(csv_number(1.0 / 3) == "0.333333");
  CHECK(csv_number(1.0 / 3, 3) == "0.333");
  CHECK(csv_number(std::nan("")).empty());
}

TEST_CASE("a label that a spreadsheet would compute is text there, and the same label when it is read") {
  const std::vector<std::string> labels = {"=1+1", "+x", "-x", "@sum(1)", "-5", "+1e3", "-inf", "a=b", "'quoted'", ""};
  std::ostringstream out;
  write_csv_row(out, {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"});
  write_csv_row(out, labels);
  CHECK(out.str().find("\n\"'=1+1\",\"'+x\",\"'-x\",\"'@sum(1)\",-5,+1e3,-inf,a=b,'quoted',\n") != std::string::npos);
  CHECK(parse_csv(out.str(), "a.csv").rows.front() == labels);
}

TEST_CASE("fields that would break the row are quoted") {
  std::ostringstream out;
  write_csv_row(out, {"A", "", "a,b", "say \"hi\"", "two\nlines"});
  write_csv_row(out, {"kcal/(mol e)"});
  CHECK(out.str() == "A,,\"a,b\",\"say \"\"hi\"\"\",\"two\nlines\"\nkcal/(mol e)\n");
}

TEST_CASE("a label that looks like a comment, or has blanks at its ends, is the same when it is read") {
  const std::vector<std::string> labels = {"#1", " before", "behind ", "\tTab", "a\tb", " # ", "'", "\r"};
  std::ostringstream out;
  write_csv_row(out, {"a", "b", "c", "d", "e", "f", "g", "h"});
  write_csv_row(out, labels);
  const CsvTable table = parse_csv(out.str(), "a.csv");
  REQUIRE(table.rows.size() == 1);
  CHECK(table.rows.front() == labels);
}
