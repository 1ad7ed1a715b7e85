// own_inputs.cpp: no verb replaces what it reads, and no two outputs have one name; all is as before, and exit is 2.
#include <sys/stat.h>

#include <map>

#include "cli/linked_outputs.h"
#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// A folder of inputs whose content must not change.
struct OwnInputs {
  ScratchFolder folder;
  std::map<std::string, std::string> before;

  OwnInputs() {
    folder.write("a.pqr", row_of_atoms(6));
    folder.write("b.pqr", row_of_atoms(6, 0.2));
    folder.write("a.dx", constant_dx(17, 3.0, 1.0));
    folder.write("r.json", row_of_atoms(6));  // a structure under a name that a result would have
    folder.write("r.residues.csv", row_of_atoms(6));
    folder.write("t.csv", "frame,rmsd_A\n0,1\n1,2\n");
    folder.write("list.csv", "structure\na.pqr\nb.pqr\n");
    std::filesystem::create_symlink("a.pqr", folder.file("link.pqr"));
    std::filesystem::create_hard_link(folder.file("a.pqr"), folder.file("hard.pqr"));
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("")))
      before[entry.path().string()] = read_file(entry.path().string());
  }

  void check_refused(const std::string& arguments, const std::string& expected) {
    CAPTURE(arguments);
    const Outcome outcome = run_espdiff(arguments, "cd " + folder.file("") + " &&");
    CHECK_MESSAGE(outcome.status == 2, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, "espdiff: " + expected), outcome.err);
    CHECK(n_lines(outcome.err) == 1);
    CHECK(folder.n_files() == before.size());
    for (const auto& [path, content] : before) CHECK(read_file(path) == content);
  }
};

}  // namespace

TEST_CASE("an output that is an input is refused by every verb") {
  OwnInputs in;
  const std::string replaces = "an output would replace an input: ";
  in.check_refused("surface a.pqr -o a.pqr --device cpu", replaces + "'a.pqr'");
  in.check_refused("surface a.pqr -o link.pqr --device cpu", replaces + "'link.pqr' and 'a.pqr', which are one file");
  in.check_refused("surface a.pqr -o hard.pqr --device cpu", replaces + "'hard.pqr' and 'a.pqr'");
  in.check_refused("surface a.pqr --map a.dx -o s.vtp --density a.dx --device cpu", replaces + "'a.dx'");
  in.check_refused("compare a.pqr b.pqr -o r2 --residue-pdb a.pqr --device cpu", replaces + "'a.pqr'");
  in.check_refused("compare r.json b.pqr -o r --device cpu", replaces + "'r.json'");
  in.check_refused("compare a.pqr r.residues.csv -o ./r --device cpu",
                   replaces + "'./r.residues.csv' and 'r.residues.csv'");
  in.check_refused("potential a.pqr -o a.pqr --device cpu", replaces + "'a.pqr'");
  in.check_refused("trajectory a.pqr b.pqr -o b.pqr --overwrite --device cpu", replaces + "'b.pqr'");
  in.check_refused("trajectory t.csv a.pqr -o t.csv --overwrite --device cpu", replaces + "'t.csv'");
  in.check_refused("matrix a.pqr r.json -o r --overwrite --device cpu", replaces + "'r.json'");
  in.check_refused("matrix --list list.csv -o list --overwrite --device cpu", replaces + "'list.csv'");
  in.folder.write("p.svg", "frame,rmsd_A\n0,1\n1,2\n");
  in.before[in.folder.file("p.svg")] = read_file(in.folder.file("p.svg"));
  in.check_refused("plot p.svg --metric rmsd_A -o p.svg", replaces + "'p.svg'");
  in.check_refused("render a.dx -o a.dx", "");
}

TEST_CASE("each output of each verb, found by running it, is refused as a link to an input") {
  OwnInputs in;
  const ScratchFolder& folder = in.folder;
  for (const char* name : {"r.json", "r.residues.csv", "link.pqr", "hard.pqr"})
    std::filesystem::remove(folder.file(name));
  folder.write("two.pqr", "MODEL 1\n" + row_of_atoms(6) + "ENDMDL\nMODEL 2\n" + row_of_atoms(6, 0.1) + "ENDMDL\n");
  folder.write("groups.csv", "label,group\na,x\nb,y\n");
  const std::string end = " --device cpu --threads 1 -q", coarse = " --grid-spacing 2" + end,
                    none = " --potential none" + coarse;
  check_linked_outputs(folder, "compare a.pqr b.pqr --charges-from two.pqr -o r --residue-pdb r.pdb --exit-zero" + none,
                       {"a.pqr", "b.pqr", "two.pqr"}, "--overwrite");
  check_linked_outputs(folder, "compare a.pqr b.pqr --source-map a.dx --target-map a.dx -o r --exit-zero" + coarse,
                       {"a.dx", "a.pqr", "b.pqr"}, "--overwrite");
  check_linked_outputs(folder, "surface a.pqr --map a.dx -o s.vtp --density d.dx" + coarse, {"a.pqr", "a.dx"},
                       "--overwrite");
  check_linked_outputs(folder, "potential two.pqr --averaging each --pad 5 --grid 4 -o c.dx" + end, {"two.pqr"});
  check_linked_outputs(folder, "potential two.pqr --variance v.dx --standard-error e.dx --pad 5 --grid 4 -o c.dx" + end,
                       {"two.pqr"});
  check_linked_outputs(folder, "prepare a.pqr -o p.pqr -q", {"a.pqr"});
  check_linked_outputs(folder, "trajectory a.pqr two.pqr --frames-of b.pqr -o o.csv --residues o.residues.csv" + none,
                       {"a.pqr", "two.pqr", "b.pqr"}, "--overwrite");
  check_linked_outputs(folder, "trajectory a.pqr two.pqr --source-frames b.pqr --frames 0 -o o.csv" + none,
                       {"a.pqr", "two.pqr", "b.pqr"}, "--overwrite");
  check_linked_outputs(folder, "matrix --list list.csv --groups groups.csv -o m" + none,
                       {"a.pqr", "b.pqr", "list.csv", "groups.csv"}, "--overwrite");
  const std::string shard = "matrix a.pqr b.pqr two.pqr -o m" + none;
  for (const char* part : {" --shard 1/2", " --shard 2/2"})
    REQUIRE(run_espdiff(shard + part, "cd " + folder.file("") + " &&").status == 0);
  check_linked_outputs(folder, "merge m.shard-1-of-2.state m.shard-2-of-2.state -q -o all",
                       {"m.shard-1-of-2.state", "m.shard-2-of-2.state"}, "--overwrite");
}

TEST_CASE("what is printed and does not arrive is an error; a reader that goes away is none") {
  OwnInputs in;
  const auto status_of = [&](const std::string& arguments, const std::string& where) {
    const std::string command = "cd " + in.folder.file("") + " && bash -o pipefail -c '" ESPDIFF_BINARY " " +
                                arguments + " 2>err " + where + "'";
    return WEXITSTATUS(std::system(command.c_str()));
  };
  const std::string surface = "surface a.pqr --grid-spacing 2 --device cpu --overwrite -o s.vtp";
  if (std::filesystem::exists("/dev/full")) {
    for (const std::string& arguments : {surface, std::string("--help"), std::string("doctor")}) {
      CHECK(status_of(arguments, ">/dev/full") == 1);
      CHECK(read_file(in.folder.file("err")) ==
            "espdiff: the standard output cannot be written: No space left on device; files that were asked for are "
            "complete\n");
    }
    CHECK(std::filesystem::file_size(in.folder.file("s.vtp")) > 1000);
    CHECK(status_of(surface + " -q", ">/dev/full") == 0);
    // A verdict that nobody read does not count.
    CHECK(status_of("compare a.pqr a.pqr -q --potential coulomb --grid-spacing 2 --device cpu -o c", ">/dev/full") ==
          1);
  }
  CHECK(status_of(surface, "| true") == 0);
  CHECK(read_file(in.folder.file("err")).empty());
}

TEST_CASE("a signal at a pipe that nobody writes into, or slowly, ends the run as cancelled") {
  OwnInputs in;
  REQUIRE(::mkfifo(in.folder.file("pipe.pqr").c_str(), 0600) == 0);
  const std::string run = "surface pipe.pqr -o s.vtp --device cpu", where = "cd " + in.folder.file("") + " && ";
  for (const std::string& writer :
       {std::string(), std::string("(timeout 5 sh -c 'sleep 3 >pipe.pqr' >/dev/null 2>&1 &) ; ")}) {
    CAPTURE(writer);
    const Outcome outcome = run_espdiff(run, where + writer + "timeout -s TERM 1.5 ");
    CHECK_MESSAGE(contains(outcome.err, "espdiff: cancelled; nothing was written\n"), outcome.err);
    CHECK(n_lines(outcome.err) == 1);
  }
}

TEST_CASE("an output that is a file named by a setting is refused by every verb that has the setting") {
  OwnInputs in;
  const std::string replaces = "an output would replace an input: ";
  for (const char* setting : {"topology", "source-topology", "target-topology", "charges-from", "ligand"}) {
    const std::string option = std::string(" --") + setting + " ";
    in.check_refused("compare a.pqr b.pqr -o r --device cpu" + option + "r.json", replaces + "'r.json'");
  }
  in.check_refused("trajectory a.pqr b.pqr -o t.csv --overwrite --device cpu --topology t.csv", replaces + "'t.csv'");
  in.check_refused("matrix a.pqr b.pqr -o r --overwrite --device cpu --charges-from r.json", replaces + "'r.json'");
  in.check_refused("prepare a.pqr -o b.pqr --topology b.pqr", replaces + "'b.pqr'");
  in.check_refused("prepare a.pqr -o c.pqr --json r.json --ligand b.pqr --ligand r.json", replaces + "'r.json'");
  in.check_refused("prepare a.pqr -o r.pqr --charges-from r.json", replaces + "'r.json'");
  in.check_refused("prepare a.pqr -o link.pqr", replaces + "'link.pqr' and 'a.pqr', which are one file");
}

TEST_CASE("two outputs of one name are refused") {
  OwnInputs in;
  const std::string twice = "two outputs would have one name: ";
  in.check_refused("surface a.pqr -o d --density d --device cpu", twice + "'d'");
  in.check_refused("surface a.pqr -o d.vtp --density ./d.vtp --device cpu", twice + "'d.vtp' and './d.vtp'");
  in.check_refused("potential a.pqr --frames 0 -o c.dx --variance c.dx --device cpu", "");
  in.folder.write("two.pqr", "MODEL 1\n" + row_of_atoms(6) + "ENDMDL\nMODEL 2\n" + row_of_atoms(6, 0.1) + "ENDMDL\n");
  in.before[in.folder.file("two.pqr")] = read_file(in.folder.file("two.pqr"));
  in.check_refused("potential two.pqr -o c.dx --variance c.dx --device cpu --pad 5 --grid 4", twice + "'c.dx'");
  in.check_refused("compare a.pqr b.pqr -o r2 --residue-pdb r2.vtp --device cpu", twice + "'r2.vtp'");
}

TEST_CASE("outputs appear together: one that cannot be written leaves none") {
  OwnInputs in;
  in.check_refused("surface a.pqr -o d.vtp --density no/x.dx --device cpu", "no/x.dx: cannot write: the folder no");
}

TEST_CASE("numbers that mean nothing are refused in our words") {
  OwnInputs in;
  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const Outcome outcome = run_espdiff(arguments, "cd " + in.folder.file("") + " &&");
    CHECK_MESSAGE(outcome.status == 2, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, expected), outcome.err);
    CHECK(outcome.err.size() < 300);
  };
  refused("potential a.pqr -o o.dx --pad nan", "--pad: 'nan' is not a number from 0 to 10000");
  refused("compare a.pqr b.pqr -o o --max-step 1e-12", "a number from 0.001 to 1000");
  refused("surface a.pqr -o o.vtp --threads 10000", "--threads: '10000' is not a whole number from 0 to 1024");
  refused("surface a.pqr -o o.vtp --threads 2147483647", "is not a whole number from 0 to 1024");
  refused("surface a.pqr -o o.vtp --threads -1", "--threads: '-1' is not a whole number from 0 to 1024");
}

TEST_CASE("a plot needs no folder for temporary files and does not read the user's own settings of gnuplot") {
  OwnInputs in;
  in.folder.write(".gnuplot", "set title 'MINE'\nexit\n");
  const std::string where = "cd " + in.folder.file("") + " && HOME=" + in.folder.file("") + " TMPDIR=/nowhere/at/all";
  const Outcome outcome = run_espdiff("plot t.csv --metric rmsd_A -o p.svg", where);
  if (contains(outcome.err, "not installed")) {
    MESSAGE("SKIPPED: gnuplot is not installed");
    return;
  }
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK_FALSE(contains(read_file(in.folder.file("p.svg")), "MINE"));
}

TEST_CASE("no verb replaces a file that is there unless --overwrite says so") {
  OwnInputs in;
  const std::string where = "cd " + in.folder.file("") + " &&", coarse = " --grid-spacing 2 --device cpu -q";
  REQUIRE(run_espdiff("compare a.pqr b.pqr -o p --exit-zero --potential coulomb" + coarse, where).status == 0);
  struct Case {
    std::string command, output;
  };
  const bool draws = std::getenv("DISPLAY") != nullptr;
  std::vector<Case> cases = {
      {"surface a.pqr -o s.vtp" + coarse, "s.vtp"},
      {"surface a.pqr -o s2.vtp --density d.dx" + coarse, "d.dx"},
      {"potential a.pqr --method coulomb --pad 5 --grid 4 -o c.dx --device cpu -q", "c.dx"},
      {"prepare a.pqr -o q.pqr -q", "q.pqr"},
      {"export p --to ply", "p.ply"},
      {"export p --to blender -o b.blender.py", "b.ply"},
      {"plot p -o p.svg", "p.svg"},
      {"report p", "p.html"},
  };
  if (draws) cases.push_back({"render p -o p.png --width 400 --height 400", "p.png"});
  if (draws) cases.push_back({"render p -o p2.png --width 400 --height 400 --save-scene scene.json", "scene.json"});
  for (const auto& one : cases) {
    const auto& [command, output] = one;
    CAPTURE(one.command);
    in.folder.write(output, "somebody's work");
    const std::size_t n_files = in.folder.n_files();
    const Outcome refused = run_espdiff(command, where);
    CHECK(refused.status == 2);
    CHECK_MESSAGE(
        contains(refused.err, "espdiff: " + output + " exists; --overwrite replaces it, another name keeps it"),
        refused.err);
    CHECK(contains(refused.err, "\nnext: espdiff " + command + " --overwrite\n"));
    CHECK(read_file(in.folder.file(output)) == "somebody's work");
    CHECK(in.folder.n_files() == n_files);
    const Outcome replaced = run_espdiff(command + " --overwrite", where);
    CHECK_MESSAGE(replaced.status == 0, replaced.err);
    CHECK(read_file(in.folder.file(output)) != "somebody's work");
  }
}

TEST_CASE("every verb refuses a name that is not UTF-8 before it computes") {
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(6));
  folder.write("\xff.pqr", row_of_atoms(6, 0.2));
  const std::string where = "cd " + folder.file("") + " &&", bad = "'\xff.pqr'";
  for (const std::string& arguments :
       {"compare a.pqr " + bad, "trajectory a.pqr " + bad + " -o t.csv", "matrix a.pqr " + bad + " -o m",
        "surface " + bad + " -o s.vtp", "potential " + bad + " -o p.dx", "prepare " + bad + " -o q.pqr",
        "surface a.pqr -o " + bad, "compare a.pqr a.pqr --charges-from " + bad, "plot " + bad + " -o p.svg"}) {
    CAPTURE(arguments);
    const Outcome outcome = run_espdiff(arguments, where);
    CHECK(outcome.status == 2);
    CHECK_MESSAGE(
        contains(outcome.err, "espdiff: '?.pqr': this name is not UTF-8, so that no result can name the file"),
        outcome.err);
    CHECK(n_lines(outcome.err) == 1);
    CHECK(folder.n_files() == 2);
  }
}
