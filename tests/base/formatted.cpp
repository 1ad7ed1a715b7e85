// formatted.cpp: numbers have a decimal point where the program around us writes a comma.
#include "base/formatted.h"

#include <doctest/doctest.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/test_data.h"

using namespace espdiff;
namespace fs = std::filesystem;

namespace {

/// What the C library prints in the locale that was chosen.
std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

/// Chooses a locale with a decimal comma: one that is installed, or one made in `folder`.
bool choose_comma(const std::string& folder) {
  for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8", "it_IT.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) return true;
  }
  const std::string command = "localedef -i de_DE -f UTF-8 " + folder + "/de_DE.UTF-8 >/dev/null 2>&1";
  if (std::system(command.c_str()) != 0) return false;
  setenv("LOCPATH", folder.c_str(), 1);
  const bool chosen = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  unsetenv("LOCPATH");
  return chosen;
}

}  // namespace

TEST_CASE("text of any length") {
  CHECK(formatted("%d of %s", 3, "4") == "3 of 4");
  CHECK(formatted("%s", "").empty());
  CHECK(formatted("%s|", std::string(5000, 'x').c_str()) == std::string(5000, 'x') + "|");
  CHECK(formatted(0.15) == "0.15");
  CHECK(formatted(1e30) == "1e+30");
}

TEST_CASE("a decimal point whatever the locale, which stays the program's") {
  const espdiff_test::ScratchFolder folder;
  if (!choose_comma(folder.file(""))) {
    MESSAGE("SKIPPED: there is no locale with a decimal comma, and localedef made none (Debian: locales)");
    return;
  }
  REQUIRE(printed(0.15) == "0,15");
  CHECK(formatted("%.2f", 0.15) == "0.15");
  CHECK(formatted(0.15) == "0.15");
  CHECK(printed(0.15) == "0,15");
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("nothing else prints numbers by the locale") {
  const fs::path root = ESPDIFF_SOURCE_DIR;
  int n = 0;
  for (const char* const room : {"src", "cuda", "vmdplugin", "python/src"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / room)) {
      if (!entry.is_regular_file() || entry.path().filename().string().rfind("formatted.", 0) == 0) continue;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        INFO(entry.path().string(), ": ", line);
        CHECK(line.find("snprintf(") == std::string::npos);
        CHECK(line.find("std::printf(") == std::string::npos);
      }
      ++n;
    }
  }
  CHECK(n > 500);
}
