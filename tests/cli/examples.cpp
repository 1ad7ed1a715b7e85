// examples.cpp: the scripts of docs/examples that compute a matrix in parts: the same bytes as one process.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

bool has(const char* program) {
  const bool found = std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
  if (!found) MESSAGE("SKIPPED: ", std::string(program), " is not installed");
  return found;
}

struct ExampleFiles {
  ScratchFolder folder;
  std::string molecules, list = "structure\n";
  ExampleFiles() {
    for (int i = 0; i < 4; ++i) {
      const std::string name = "m" + std::to_string(i) + ".pqr";
      molecules += " " + folder.write(name, row_of_atoms(9 + i, 0.3 * i));
      list += folder.file(name) + "\n";
    }
    list = folder.write("list.csv", list);
    REQUIRE(run_espdiff("matrix --list " + list + " -q -o " + folder.file("whole")).status == 0);
  }
  /// Runs an example with our `espdiff` first on PATH.
  int run(const std::string& line, const std::string& before = "") const {
    const std::string folder_of_program = std::filesystem::path(ESPDIFF_BINARY).parent_path().string();
    return std::system(("cd " + folder.file("") + " && PATH=" + folder_of_program + ":$PATH " + before + " " +
                        ESPDIFF_SOURCE_DIR "/docs/examples/" + line + " >" + folder.file("log") + " 2>&1 </dev/null")
                           .c_str());
  }
  void check_same(const std::string& name) const {
    for (const char* ending : {".csv", ".json"}) {
      CHECK_MESSAGE(read_file(folder.file(name + ending)) == read_file(folder.file(std::string("whole") + ending)),
                    read_file(folder.file("log")));
    }
  }
};

}  // namespace

TEST_CASE("GNU parallel") {
  if (!has("parallel")) return;
  const ExampleFiles files;
  CHECK(files.run("matrix_parallel.sh 2 par" + files.molecules) == 0);
  files.check_same("par");
}

TEST_CASE("mpirun") {
  if (!has("mpirun")) return;
  const ExampleFiles files;
  CHECK(files.run("matrix_mpi.sh 2 mpi" + files.molecules,
                  "MPIRUN_OPTIONS=--oversubscribe OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1") == 0);
  files.check_same("mpi");
}

TEST_CASE("the tasks of a Slurm array, as Slurm calls them") {
  const ExampleFiles files;
  for (int task = 1; task <= 3; ++task) {
    const std::string environment =
        "SLURM_ARRAY_TASK_COUNT=3 SLURM_CPUS_PER_TASK=1 SLURM_ARRAY_TASK_ID=" + std::to_string(task);
    CHECK(files.run("matrix_slurm.sh part " + files.list + " array", environment) == 0);
  }
  CHECK(files.run("matrix_slurm.sh merge " + files.list + " array") == 0);
  files.check_same("array");
  CHECK(files.run("matrix_slurm.sh other " + files.list + " array") != 0);
}
