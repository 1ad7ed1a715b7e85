// Runs of other programs: their outputs, their end, and that nothing of them stays.
#include "io/files/run_program.h"

#include <doctest/doctest.h>

#include <chrono>
#include <fstream>

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

TEST_CASE("run_program: outputs apart, input, exit status, no shell") {
  const ProgramResult result = run_program({{"sh", "-c", "cat; echo wrong >&2; exit 3"}, "input $HOME", {}, 0, {}});
  CHECK(result.status == 3);
  CHECK(result.output == "input $HOME");
  CHECK(result.messages == "wrong\n");
  CHECK(run_program({{"echo", "$HOME;", "*"}, {}, {}, 0, {}}).output == "$HOME; *\n");
}

TEST_CASE("run_program: a working folder, and none of our open files") {
  const ScratchFolder folder;
  CHECK(run_program({{"pwd"}, {}, folder.file(""), 0, {}}).output.find("espdiff-test-") != std::string::npos);
  const std::ofstream open(folder.file("open"));
  const std::string files = run_program({{"ls", "/proc/self/fd"}, {}, {}, 0, {}}).output;
  CHECK(files == "0\n1\n2\n3\n");  // the last one is the listing itself
}

TEST_CASE("run_program: a signal, a missing program") {
  CHECK(run_program({{"sh", "-c", "kill -9 $$"}, {}, {}, 0, {}}).status == 128 + 9);
  CHECK(message_of([] {
          run_program({{"no-such-program-1"}, {}, {}, 0, {}});
        }) == "there is no program 'no-such-program-1'");
  CHECK(find_program("no-such-program-1").empty());
  CHECK(find_program("sh").find("/sh") != std::string::npos);
}

TEST_CASE("run_program: names are words, whatever they contain; a program that never stops printing is ended") {
  const ScratchFolder folder;
  for (const char* name : {"with blank", "-dash", "quote'\"", "$(touch left)", "semi;colon", "new\nline"})
    CHECK(run_program({{"printf", "%s", name}, {}, folder.file(""), 0, {}}).output == name);
  CHECK(folder.n_files() == 0);
  CHECK(message_of([] { run_program({{"yes"}, {}, {}, 60, {}}); }) == "yes printed more than 64 MB and was ended");
}

TEST_CASE("run_program: ends the program and its children when it may not continue") {
  const ScratchFolder folder;
  const auto begun = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(); };
  CHECK(message_of([] {
          run_program({{"sleep", "30"}, {}, {}, 0.2, {}});
        }) == "sleep ran for more than 0 s and was ended");
  int n = 0;
  const auto stop = [&] {
    if (++n > 5) throw Cancelled();
  };
  // The child would write the file after a second, if it lived: of the group, of a session of its own, and there of one
  // whose parent has ended.
  for (const char* command : {"(sleep 1; echo > left) & wait", "setsid sh -c 'sleep 1; echo > left' & wait",
                              "setsid sh -c '(sleep 1; echo > left) &'; sleep 2"}) {
    n = 0;
    CHECK_THROWS_AS(run_program({{"sh", "-c", command}, {}, folder.file(""), 0, stop}), Cancelled);
  }
  CHECK(seconds() < 10);
  run_program({{"sleep", "1.3"}, {}, {}, 0, {}});
  CHECK(folder.n_files() == 0);
}
