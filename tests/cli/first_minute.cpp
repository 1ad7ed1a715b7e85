// first_minute.cpp: a newcomer's first minute in a terminal, against the transcript beside this file.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// A folder with two molecules and a folder in it, and `espdiff` on PATH.
struct FirstFolder {
  ScratchFolder folder;
  FirstFolder() {
    folder.write("wild.pqr", row_of_atoms(12));
    folder.write("mutant.pqr", row_of_atoms(12, 0.25));
    std::filesystem::create_directory(folder.file("folder"));
  }
  /// What a terminal shows of a line, and its exit status in brackets.
  std::string shown(const std::string& line) const {
    const ScratchFolder log;
    const std::string programs = std::filesystem::path(ESPDIFF_BINARY).parent_path().string();
    const int status = std::system(("cd " + folder.file("") + " && PATH=" + programs + ":$PATH && { " + line + "; } >" +
                                    log.file("log") + " 2>&1 </dev/null")
                                       .c_str());
    return "$ " + line + '\n' + read_file(log.file("log")) + '[' + std::to_string(WEXITSTATUS(status)) + "]\n";
  }
};

}  // namespace

TEST_CASE("what a newcomer types first gets the answers of the transcript") {
  const FirstFolder first;
  std::ifstream transcript(ESPDIFF_SOURCE_DIR "/tests/cli/first_minute.txt");
  std::string expected, got;
  for (std::string line; std::getline(transcript, line);) {
    expected += line + '\n';
    if (line.rfind("$ ", 0) == 0) got += first.shown(line.substr(2));
  }
  REQUIRE(!expected.empty());
  CHECK(got == expected);
}
