// usage.cpp: help, versions and wrong usage of the command line.
#include <doctest/doctest.h>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

TEST_CASE("help and version exit 0 and say what there is") {
  const Outcome help = run_espdiff("--help");
  CHECK(help.status == 0);
  for (const char* verb :
       {"compare", "trajectory", "matrix", "merge", "plot", "surface", "potential", "render", "view", "doctor"})
    CHECK(contains(help.out, verb));
  CHECK(run_espdiff("--version").out == "espdiff " ESPDIFF_VERSION "\n");
  for (const char* verb :
       {"compare", "trajectory", "matrix", "merge", "plot", "surface", "potential", "render", "view", "doctor"}) {
    const Outcome outcome = run_espdiff(std::string(verb) + " --help");
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.out, "Usage: espdiff " + std::string(verb)));
  }
  const Outcome compare = run_espdiff("compare --help");
  for (const char* option :
       {"--source-map", "--target-map", "--potential", "--method", "--field", "--align", "--grid-spacing",
        "--radius-scale", "--isovalue", "--device", "--threads", "--sigma", "--mu", "--rho", "--max-iterations"}) {
    CHECK_MESSAGE(contains(compare.out, option), option);
  }
}

TEST_CASE("wrong usage exits 2 with one line that says what and where to look") {
  struct Case {
    const char* arguments;
    const char* expected;
  };
  for (const Case& c : {Case{"", "subcommand"},
                        {"frobnicate", "frobnicate"},
                        {"compare", "SOURCE"},
                        {"compare a.pqr b.pqr", "--output"},
                        {"compare a b -o x --device tpu", "--device"},
                        {"compare a b -o x --threads -1", "--threads"},
                        {"compare a b -o x --grid-spacing 0", "--grid-spacing"},
                        {"compare a b -o x --no-such-option", "'--no-such-option': there is no such option"},
                        {"compare a b -o x --no-such-option value", "'--no-such-option': there is no such option"},
                        {"compare a b c -o x", "'c': there is no such option, and no place for another argument"},
                        {"compare a b -o x -o y", "--output: is given more than once; give it once"},
                        {"compare a b -o x --potential", "--potential: a value is missing behind it"}}) {
    const Outcome outcome = run_espdiff(c.arguments);
    CHECK_MESSAGE(outcome.status == 2, c.arguments);
    CHECK_MESSAGE(contains(outcome.err, c.expected), outcome.err);
    CHECK_MESSAGE(n_lines(outcome.err) == 1, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, " --help\n"), outcome.err);
  }
}

TEST_CASE("doctor names the back ends and the readers") {
  const Outcome outcome = run_espdiff("doctor");
  CHECK(outcome.status == 0);
  CHECK(contains(outcome.out, "espdiff " ESPDIFF_VERSION));
  for (const char* line :
       {"cpu            ok", "cuda", "--device auto", "pme on cpu", "pme on cuda", "structures", "maps"})
    CHECK_MESSAGE(contains(outcome.out, line), line);
}

TEST_CASE("an explicit cuda that is not there is an error, not a silent cpu run") {
  if (contains(run_espdiff("doctor").out, "cuda           ok")) {
    MESSAGE("SKIPPED: this machine has a CUDA device");
    return;
  }
  const ScratchFolder folder;
  const std::string molecule = folder.write("a.pqr", row_of_atoms(6));
  const Outcome outcome =
      run_espdiff("compare " + molecule + " " + molecule + " -o " + folder.file("out") + " --device cuda");
  CHECK(outcome.status == 1);
  CHECK_MESSAGE(contains(outcome.err, "--device cpu"), outcome.err);
  CHECK(folder.n_files() == 1);
}
