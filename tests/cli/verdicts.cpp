// verdicts.cpp: the verdict of each kind of potential, computed and given as maps, on a right pair; each result is
// verified.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test
using Json = nlohmann::json;

namespace {

/// Compares, and expects a trustworthy result that verify confirms.
Json trusted(const ScratchFolder& folder, const std::string& pair) {
  const Outcome compared =
      run_espdiff("compare " + pair + " --device cpu -q --exit-zero --overwrite -o " + folder.file("out"));
  REQUIRE_MESSAGE(compared.status == 0, compared.err);
  CHECK_MESSAGE(compared.out.rfind("TRUSTWORTHY", 0) == 0, compared.out);
  Json json = Json::parse(read_file(folder.file("out.json")));
  CHECK_MESSAGE(json["certificate"]["trustworthy"] == true, json["certificate"]["reasons"].dump());
  const Outcome verified = run_espdiff("verify " + folder.file("out"));
  CHECK_MESSAGE(verified.status == 0, verified.out);
  return json;
}

}  // namespace

TEST_CASE("a right pair is trustworthy by every kind of potential, computed or given as maps") {
  const auto a = real_input("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr"), b = real_input("pqr_pdb2pqr/1AJJ_pH14_AMBER.pqr");
  if (!a || !b) return;
  const ScratchFolder folder;
  for (const char* const kind : {"pb --pb-spacing 1", "coulomb", "pme", "none"}) {
    CAPTURE(kind);
    trusted(folder, *a + " " + *b + " --potential " + kind);
  }
  const std::pair<const char*, const char*> maps[] = {{"pb --pb-spacing 1", "salt water"},
                                                      {"pb --pb-spacing 2", "salt water"},
                                                      {"pb --pb-spacing 1 --ionic-strength 0", "salt water"},
                                                      {"coulomb", "vacuum"},
                                                      {"coulomb --dielectric 4", "vacuum"},
                                                      {"pme", "vacuum, smooth part"},
                                                      {"pme --grid 2", "vacuum, smooth part"},
                                                      {"pme --compatible", "vacuum, smooth part"}};
  const std::string source_map = folder.file("a.dx"), target_map = folder.file("b.dx");
  for (const auto& map : maps) {
    const char *const method = map.first, *const kind = map.second;
    CAPTURE(method);
    for (const auto& [state, path] : {std::pair(*a, source_map), std::pair(*b, target_map)})
      REQUIRE(run_espdiff("potential " + state + " --method " + method + " --overwrite -q -o " + path).status == 0);
    const Json json = trusted(folder, *a + " " + *b + " --source-map " + source_map + " --target-map " + target_map);
    for (const char* side : {"source", "target"}) CHECK(json["given_maps"][side]["kind"] == kind);
    CHECK((json["potential_unit"] == "kT/e in vacuum") == (std::string(kind) != "salt water"));
  }
}

TEST_CASE("a pair with maps of APBS is trustworthy") {
  const auto a = real_input("pair_tim_maps/scTIM_chainA.pqr"), b = real_input("pair_tim_maps/dTIM_chainA.pqr"),
             source = real_input("pair_tim_maps/scTIM_chainA_pot-PE0.dx"),
             target = real_input("pair_tim_maps/dTIM_chainA_pot-PE0.dx");
  if (!a || !b || !source || !target) return;
  const ScratchFolder folder;
  const Json json = trusted(folder, *a + " " + *b + " --source-map " + *source + " --target-map " + *target +
                                        " --source-map-unit kT/e --target-map-unit kT/e");
  CHECK(json["given_maps"]["source"]["kind"] == "salt water");
}
