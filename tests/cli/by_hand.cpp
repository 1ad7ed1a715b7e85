// by_hand.cpp: from a PDB entry to the difference, beside pdb2pqr and apbs run by hand as their documentation says.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "cli/run_espdiff.h"
#include "io/files/run_program.h"

using namespace espdiff_test;  // NOLINT: a test
using Json = nlohmann::json;

namespace {

/// Name, residue, number, x, y, z, charge, radius.
using PqrAtom = std::tuple<std::string, std::string, std::string, double, double, double, double, double>;

std::vector<PqrAtom> atoms_of(const std::string& path) {
  std::vector<PqrAtom> atoms;
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) != 0 && line.rfind("HETATM", 0) != 0) continue;
    std::istringstream words(line);
    std::string record, serial, name, residue, chain, number;
    double x = 0, y = 0, z = 0, charge = 0, radius = 0;
    words >> record >> serial >> name >> residue >> chain >> number >> x >> y >> z >> charge >> radius;
    REQUIRE(static_cast<bool>(words));
    atoms.emplace_back(name, residue, number, x, y, z, charge, radius);
  }
  std::sort(atoms.begin(), atoms.end());
  return atoms;
}

bool has_programs() {
  for (const char* program : {"pdb2pqr30", "apbs"}) {
    if (!espdiff::find_program(program).empty()) continue;
    MESSAGE("SKIPPED: no ", program, " on PATH");
    return false;
  }
  return true;
}

}  // namespace

TEST_CASE("charges are those of pdb2pqr to the last digit, and a difference that of apbs' maps within 2 %") {
  const auto entry = real_input("bad_parmed/2igd.pdb");
  if (!entry || !has_programs()) return;
  const ScratchFolder folder;
  // The protein at two pH, https://pdb2pqr.readthedocs.io: PARSE, PROPKA, and the input that it writes for apbs.
  for (const char* ph : {"7", "2"}) {
    const std::string name = std::string("hand") + ph;
    const std::string by_hand = "cd " + folder.file("") +
                                " && pdb2pqr30 --ff=PARSE --titration-state-method=propka --with-ph=" + ph +
                                " --keep-chain --drop-water --apbs-input=" + name + ".in " + *entry + " " + name +
                                ".pqr >log 2>&1 && apbs " + name + ".in >>log 2>&1";
    REQUIRE_MESSAGE(std::system(by_hand.c_str()) == 0, read_file(folder.file("log")));
    const std::string ours = folder.file(std::string("ours") + ph + ".pqr");
    const Outcome prepared = run_espdiff("prepare " + *entry + " --no-cache -q --ph " + ph + " -o " + ours);
    REQUIRE_MESSAGE(prepared.status == 0, prepared.err);
    CHECK(atoms_of(ours) == atoms_of(folder.file(name + ".pqr")));
    CHECK(atoms_of(ours).size() > 900);
  }
  const auto compared = [&](const std::string& arguments, const std::string& output) {
    const Outcome outcome =
        run_espdiff("compare " + arguments + " --offset 0,1.4,3 --device cpu -q -o " + folder.file(output));
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    return Json::parse(read_file(folder.file(output + ".json")));
  };
  const auto file = [&](const std::string& name) { return folder.file(name); };
  const Json by_hand = compared(file("hand7.pqr") + " " + file("hand2.pqr") + " --source-map " +
                                    file("hand7.pqr-PE0.dx") + " --target-map " + file("hand2.pqr-PE0.dx"),
                                "by_hand");
  // That input has no salt, and 298.15 K.
  const Json ours = compared(
      file("ours7.pqr") + " " + file("ours2.pqr") + " --potential pb --ionic-strength 0 --temperature 298.15", "ours");
  for (std::size_t i = 0; i < 3; ++i) {
    const Json &a = by_hand["by_offset"][i], &b = ours["by_offset"][i];
    const double difference = a["mean_abs_difference"], own = b["mean_abs_difference"];
    MESSAGE(a["offset_A"].get<double>(), " A outside: ", difference, " kT/e by hand, ", own, " by espdiff");
    CHECK(difference > 1);
    CHECK(std::fabs(own - difference) < 0.02 * difference);
  }
}
