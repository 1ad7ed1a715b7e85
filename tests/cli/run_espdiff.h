// run_espdiff.h: runs the built command line and takes what it prints and how it ends.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/test_data.h"
#include "support/text.h"

namespace espdiff_test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal when killed
  std::string out, err;
};

/// Runs `espdiff ARGUMENTS` through the shell.
inline Outcome run_espdiff(const std::string& arguments, const std::string& before = "") {
  const ScratchFolder folder;
  const std::string command = before + " " ESPDIFF_BINARY " " + arguments + " >" + folder.file("out") + " 2>" +
                              folder.file("err") + " </dev/null";
  const int status = std::system(command.c_str());
  Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = read_file(folder.file("out"));
  outcome.err = read_file(folder.file("err"));
  return outcome;
}

inline std::size_t n_lines(const std::string& text) {
  std::size_t n = 0;
  for (const char c : text) n += c == '\n' ? 1 : 0;
  return n;
}

/// Whether there is a PDB2PQR to prepare structures with; says so where there is none.
inline bool has_pdb2pqr() {
  if (contains(run_espdiff("doctor").out, "prepare        ok")) return true;
  MESSAGE("SKIPPED: no PDB2PQR on PATH");
  return false;
}

/// A PQR of a row of atoms along x from `first_x`, one residue each.
inline std::string row_of_atoms(int n, double first_x = 0, const std::string& residue = "ALA") {
  std::string text;
  for (int i = 0; i < n; ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "ATOM  %5d  CA  %3s A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n", i + 1, residue.c_str(),
                  i + 1, first_x + 3.0 * i, 0.7 * (i % 3), 0.4 * (i % 2), 0.5, 2.0);
    text += line;
  }
  return text;
}

/// A DX map of constant value on n^3 points of the given spacing, centred on the origin, in APBS' form. `count` values
/// are promised and `written` written.
inline std::string constant_dx(int n, double spacing, double value, const std::string& unit = "kT/e",
                               double centre_x = 0, int written = -1) {
  const double low = -0.5 * spacing * (n - 1);
  char head[1024];
  std::snprintf(
      head, sizeof head,
      "# POTENTIAL (%s)\nobject 1 class gridpositions counts %d %d %d\norigin %g %g %g\ndelta %g 0 0\ndelta 0 %g "
      "0\ndelta 0 0 %g\n"
      "object 2 class gridconnections counts %d %d %d\nobject 3 class array type double rank 0 items %d data follows\n",
      unit.c_str(), n, n, n, low + centre_x, low, low, spacing, spacing, spacing, n, n, n, n * n * n);
  std::string text = head;
  const int n_values = written < 0 ? n * n * n : written;
  for (int i = 0; i < n_values; ++i) text += std::to_string(value) + (i % 3 == 2 ? "\n" : " ");
  return text + "\nattribute \"dep\" string \"positions\"\n";
}

}  // namespace espdiff_test
