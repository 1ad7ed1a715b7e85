// order.cpp: the order of residues and atoms in the files changes no number: with the default settings, local motions,
// shapes alone, other potentials, outside of the surface, in a region and by --method deform.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "cli/run_espdiff.h"
#include "support/random.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// The first 25 residues of a PQR; shuffled, residues and their atoms in a drawn order.
std::string part_of_pqr(const std::string& path, int seed) {
  std::map<std::string, std::vector<std::string>> atoms;  // by residue number
  std::vector<std::string> residues;
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) != 0) continue;
    const std::string number = line.substr(22, 4);
    if (atoms.count(number) == 0) residues.push_back(number);
    atoms[number].push_back(line);
  }
  residues.resize(25);
  Random random(static_cast<std::uint64_t>(seed));
  const auto shuffle = [&](std::vector<std::string>& all) {
    for (std::size_t k = all.size(); seed > 0 && k > 1; --k) std::swap(all[k - 1], all[random.below(k)]);
  };
  shuffle(residues);
  std::string text;
  for (const std::string& number : residues) {
    shuffle(atoms[number]);
    for (const std::string& line : atoms[number]) text += line + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("the order of residues and atoms in the files changes no number") {
  const auto a = real_input("series19_ubq_2k39/m00.pqr"), b = real_input("series19_ubq_2k39/m06.pqr");
  if (!a || !b) return;
  const ScratchFolder folder;
  folder.write("a.pqr", part_of_pqr(*a, 0));
  folder.write("b.pqr", part_of_pqr(*b, 0));
  folder.write("c.pqr", part_of_pqr(*a, 1));
  folder.write("d.pqr", part_of_pqr(*b, 2));
  for (const std::string options :
       {"", "--domains local", "--potential none", "--potential coulomb --offset 1 --region //*/3-12",
        "--potential coulomb --method deform"}) {
    const auto result = [&](const std::string& files) {
      const Outcome outcome =
          run_espdiff("compare " + files + " -o r -q --exit-zero --overwrite --device cpu " + options,
                      "cd " + folder.file("") + " &&");
      REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
      return nlohmann::json::parse(read_file(folder.file("r.json")));
    };
    const nlohmann::json one = result("a.pqr b.pqr"), other = result("c.pqr d.pqr");
    CAPTURE(options);
    for (const char* name :
         {"/rmsd_A", "/mean_abs_difference", "/rms_difference", "/hodgkin_index", "/mean_displacement_A",
          "/mean_path_length_A", "/area_A2/mapped", "/certificate/slip/mean_A",
          "/certificate/same_residue_area_fraction", "/certificate/residues/correlation", "/by_offset/0/hodgkin_index",
          "/region/mean_abs_difference"}) {
      const nlohmann::json::json_pointer pointer(name);
      CAPTURE(name);
      if (!one.contains(pointer) || !one.at(pointer).is_number()) continue;  // without potentials, or a region
      CHECK(other.at(pointer).get<double>() == doctest::Approx(one.at(pointer).get<double>()).epsilon(1e-3));
    }
    CHECK(other["certificate"]["trustworthy"] == one["certificate"]["trustworthy"]);
  }
}
