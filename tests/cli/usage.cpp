// usage.cpp: help, versions and wrong usage of the command line.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

#include "cli/run_espdiff.h"
#include "engine/compute_thread.h"

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
  const Outcome compare = run_espdiff("compare --help-all");
  for (const char* option : {"--source-map", "--target-map", "--potential", "--method", "--deform-field", "--field",
                             "--align", "--grid-spacing", "--radius-scale", "--isovalue", "--device", "--threads",
                             "--sigma", "--mu", "--rho", "--max-iterations"}) {
    CHECK_MESSAGE(contains(compare.out, option), option);
  }
  const Outcome brief = run_espdiff("compare --help");
  CHECK(n_lines(brief.out) <= 36);
  CHECK(contains(brief.out, "All options: espdiff compare --help-all\n"));
  CHECK(run_espdiff("help compare").out == brief.out);
  CHECK(run_espdiff("compare -h").out == brief.out);
}

TEST_CASE("help says which numbers an option takes") {
  const std::string render = run_espdiff("render --help").out;
  CHECK(contains(render, "Percentage of the values that an automatic scale covers; a number from\n"));
  CHECK(contains(render, "Pixels; a whole number from 400 to 6000 (default 1800)\n"));
  CHECK(contains(run_espdiff("man plot").out, "0 for all, in file order; a whole number from 0 to 100000\n"));
  CHECK(contains(run_espdiff("trajectory --help-all").out, "a whole number from 0 to 1024 (default 0)\n"));
}

TEST_CASE("threads look briefly for work before they sleep, unless the user's settings say otherwise") {
  const auto last_told = [](const std::string& settings) {
    const std::string told =
        run_espdiff("doctor", "unset OMP_WAIT_POLICY GOMP_SPINCOUNT; " + settings + " OMP_DISPLAY_ENV=VERBOSE").err;
    const std::size_t at = told.rfind("GOMP_SPINCOUNT = '");
    return at == std::string::npos ? std::string() : told.substr(at + 18, told.find('\'', at + 18) - at - 18);
  };
  const std::string usual = last_told("");
  if (usual.empty()) {
    MESSAGE("SKIPPED: OpenMP's library is not libgomp, which tells its settings");
    return;
  }
  CHECK(usual == espdiff::kBriefSpins);
  CHECK(last_told("GOMP_SPINCOUNT=77") == "77");
  CHECK(last_told("OMP_WAIT_POLICY=passive") == "0");
}

TEST_CASE("help starts the program once, and a computation a second time, so that its threads sleep while they wait") {
  const auto n_starts = [](const std::string& arguments) {
    const std::string statistics =
        run_espdiff(arguments, "unset OMP_WAIT_POLICY GOMP_SPINCOUNT; LD_DEBUG=statistics").err;
    int n = 0;
    for (std::size_t at = 0; (at = statistics.find("total startup time", at)) != std::string::npos; ++at) ++n;
    return n;
  };
  const int n_doctor = n_starts("doctor");
  if (n_doctor == 0) return;  // not the GNU C library
  CHECK(n_doctor == 2);
  for (const char* arguments : {"--help", "compare -h", "--version"}) CHECK(n_starts(arguments) == 1);
}

TEST_CASE("wrong usage exits 2 with one line that says what and where to look") {
  struct Case {
    const char* arguments;
    const char* expected;
  };
  for (const Case& c : {Case{"", "nothing to do"},
                        {"frobnicate", "frobnicate"},
                        {"compare", "SOURCE"},
                        {"trajectory a.pqr b.pqr", "--output is missing: espdiff trajectory SOURCE FRAMES ..."},
                        {"compare a b -o x --device tpu", "--device"},
                        {"compare a b -o x --threads -1", "--threads"},
                        {"compare a b -o x --grid-spacing 0", "--grid-spacing"},
                        {"compare a b -o x --no-such-option", "'--no-such-option': there is no such option"},
                        {"compare a b -o x --no-such-option value", "'--no-such-option': there is no such option"},
                        {"compare a b c -o x", "'c' is one argument too many: espdiff compare SOURCE TARGET"},
                        {"compare a b -o x -o y", "--output: is given more than once; give it once"},
                        {"compare a b -o x --potential", "--potential: a value is missing behind it"}}) {
    const Outcome outcome = run_espdiff(c.arguments);
    CHECK_MESSAGE(outcome.status == 2, c.arguments);
    CHECK_MESSAGE(contains(outcome.err, c.expected), outcome.err);
    CHECK_MESSAGE(n_lines(outcome.err) == 1, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, " --help\n"), outcome.err);
  }
}

TEST_CASE("a shell accepts the completion, which offers commands, options and choices") {
  const ScratchFolder folder;
  const auto offered = [&](const std::string& words) {
    std::string quoted;
    for (const char c : words) quoted += c == ' ' ? std::string("' '") : std::string(1, c);
    const std::string script = "source <(" ESPDIFF_BINARY " completion bash); COMP_WORDS=('" + quoted +
                               "'); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _espdiff; echo ${COMPREPLY[@]}";
    folder.write("ask.sh", script);
    const int status = std::system(("bash " + folder.file("ask.sh") + " >" + folder.file("answer")).c_str());
    CHECK(status == 0);
    return read_file(folder.file("answer"));
  };
  CHECK(offered("espdiff com") == "compare complementarity completion\n");
  CHECK(offered("espdiff compare --source-m") == "--source-map --source-map-unit --source-model\n");
  CHECK(offered("espdiff compare a.pdb b.pdb --potential p") == "pb pme\n");
  CHECK(offered("espdiff ensemble --check") == "--check-template\n");
  if (std::system("command -v zsh >/dev/null") != 0) {
    MESSAGE("SKIPPED: zsh is not installed");
    return;
  }
  folder.write("_espdiff", run_espdiff("completion zsh").out);
  CHECK(std::system(("zsh -n " + folder.file("_espdiff")).c_str()) == 0);
}

TEST_CASE("a manual page names every option of its command") {
  const std::string page = run_espdiff("man compare").out;
  for (const char* part :
       {".TH ESPDIFF\\-COMPARE 1", ".SH SYNOPSIS", "\\-\\-grid\\-spacing NUMBER", ".SH REGULARIZATION"})
    CHECK_MESSAGE(contains(page, part), part);
  const std::string all = run_espdiff("man").out;
  CHECK(contains(all, ".TH ESPDIFF 1 "));
  CHECK(contains(all, ".B compare\nCompare the electrostatic surface potentials"));
  CHECK(contains(all, ".BR espdiff\\-trajectory (1)"));
  const Outcome outcome = run_espdiff("man rendr");
  CHECK(outcome.status == 2);
  CHECK(outcome.err == "espdiff: there is no command 'rendr'; espdiff --help lists them\n");
}

TEST_CASE("doctor names the back ends and the readers") {
  const Outcome outcome = run_espdiff("doctor");
  CHECK(outcome.status == 0);
  CHECK(contains(outcome.out, "espdiff " ESPDIFF_VERSION));
  for (const char* line :
       {"cpu            ok", "cuda", "--device auto", "pme on cpu", "pme on cuda", "structures", "maps"})
    CHECK_MESSAGE(contains(outcome.out, line), line);
}

TEST_CASE("doctor finds the module where packages put it, and says how VMD does") {
  const ScratchFolder folder;
  for (const char* modules : {"lib/espdiff", "."}) {
    const std::string root = folder.file(*modules == 'l' ? "usr" : "unpacked");
    const std::filesystem::path module = std::filesystem::path(root) / modules / "molfile";
    std::filesystem::create_directories(root + "/bin");
    std::filesystem::copy_file(ESPDIFF_BINARY, root + "/bin/espdiff");
    const auto doctor = [&] {
      REQUIRE(std::system((root + "/bin/espdiff doctor >" + folder.file("out")).c_str()) == 0);
      return read_file(folder.file("out"));
    };
    CHECK(contains(doctor(), "vmd module     --   none beside this program: a build has it where Tcl 8.6 is found"));
    std::filesystem::create_directories(module);
    std::filesystem::copy_file(ESPDIFF_BINARY, module / "espdiffplugin.so");  // any file
    const std::string place = (std::filesystem::path(root) / (*modules == 'l' ? "lib/espdiff" : "")).string();
    CHECK_MESSAGE(contains(doctor(), "vmd module     ok   "), doctor());
    CHECK_MESSAGE(contains(doctor(), "lappend auto_path {" + place), doctor());
  }
}

TEST_CASE("the program starts without the libraries of its modules") {
  const ScratchFolder folder;
  REQUIRE(std::system(("LD_TRACE_LOADED_OBJECTS=1 " ESPDIFF_BINARY " >" + folder.file("out")).c_str()) == 0);
  const std::string libraries = read_file(folder.file("out"));
  CHECK(contains(libraries, "libstdc++"));
  for (const char* library : {"libvtk", "libhdf5", "libX11", "libGL"})
    CHECK_FALSE_MESSAGE(contains(libraries, library), libraries);
}

#if defined(ESPDIFF_HAVE_VTK)
TEST_CASE("a module that is missing, damaged or of another version is one line with the remedy") {
  const ScratchFolder folder;
  const std::string root = folder.file("alone"), module = root + "/lib/espdiff/espdiff_vtk.so";
  std::filesystem::create_directories(root + "/bin");
  std::filesystem::create_directories(root + "/lib/espdiff");
  std::filesystem::copy_file(ESPDIFF_BINARY, root + "/bin/espdiff");
  const auto outcome = [&](const std::string& words) {
    const int status =
        std::system((root + "/bin/espdiff " + words + " >" + folder.file("out") + " 2>" + folder.file("err")).c_str());
    return Outcome{WEXITSTATUS(status), read_file(folder.file("out")), read_file(folder.file("err"))};
  };
  const std::string part = "this program's part with VTK, for pictures and `verify`, " + module + ", ";
  const std::string missing = part + "is missing; install espdiff as a whole, not the program alone\n";
  for (const char* words : {"verify x", "view x.vtp", "render x.vtp -o x.png"}) {
    const Outcome alone = outcome(words);
    CHECK(alone.status == 1);
    CHECK(alone.err == "espdiff: " + missing);
  }
  const std::string doctor = outcome("doctor").out;
  CHECK_MESSAGE(contains(doctor, "render         --   " + missing), doctor);
  if (contains(run_espdiff("doctor").out, "ensemble       ok"))
    CHECK_MESSAGE(contains(doctor, "ensemble       --   this program's part with HDF5, for files of ensembles, "),
                  doctor);
  folder.write("alone/lib/espdiff/espdiff_vtk.so", "no library");
  const std::string damaged = outcome("verify x").err;
  CHECK_MESSAGE(damaged.compare(0, 9 + part.size() + 19, "espdiff: " + part + "cannot be loaded (/") == 0, damaged);
  CHECK_MESSAGE(contains(damaged, "); install the libraries of VTK 9 that it was built with (Debian: "), damaged);
  // Any library will do that lacks the function.
  std::filesystem::copy_file(ESPDIFF_OTHER_LIBRARY, module, std::filesystem::copy_options::overwrite_existing);
  CHECK(outcome("verify x").err ==
        "espdiff: " + part + "is not of version " ESPDIFF_VERSION "; install espdiff as a whole again\n");
}
#endif

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
