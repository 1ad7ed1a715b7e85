// ensemble_page.cpp: ensembles as pages: what they hold, what is refused, and that a click selects a patch.
#include "page/ensemble_page.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "cli/run_espdiff.h"
#include "ensemble/planted_file.h"
#include "ensemble/result/ensemble_result.h"
#include "ensemble/result/write_ensemble.h"
#include "page/browser.h"
#include "page/page_texts.h"
#include "page/result_page.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

bool can_draw() {
  const bool found = page_texts().count("three.min.js") > 0;
  if (!found) MESSAGE("SKIPPED: this build has no three.js");
  return found;
}

/// Four runs of each group, of ten frames; `effect` is what a part of the first residue's surface differs by.
struct PlantedResult {
  ScratchFolder folder;
  std::string prefix = folder.file("planted");
  EnsembleResult result;
  explicit PlantedResult(double effect, std::size_t n_mutants = 4, const std::string& backbone = "") {
    EnsemblePlan plan = planted_plan(4, n_mutants, 10);
    plan.template_backbone = backbone;
    plan.residues = {"</script><b>ALA 1", "GLY 2"};
    plant_file(prefix + ".h5", plan, effect, 7);
    const EnsembleFile file(prefix + ".h5", false);
    result = analyse_ensemble(file, EnsembleOptions());
    write_ensemble(prefix, file, result);
  }
};

}  // namespace

TEST_CASE("an ensemble's page has the surface with p, the patches, their series, and the conclusion") {
  if (!can_draw()) return;
  const PlantedResult planted(6);
  REQUIRE(planted.result.patches.size() == 1);
  CHECK(page_kind(planted.prefix) == PageKind::kEnsemble);
  const std::string text = element(result_page(planted.prefix, ""), "record");
  CHECK(!contains(text, "<"));
  const auto record = nlohmann::json::parse(text);
  CHECK(record.at("title") == "mutant against wild");
  CHECK(contains(record.at("verdict").at("text").get<std::string>(), "differ on "));
  CHECK(record.at("fade").at("text") == "fainter where not significant, p > 0.05");
  CHECK(record.at("fade").at("from") == record.at("fade").at("to"));  // a limit, whose border is drawn smooth
  CHECK(record.at("linked").at(2).at(1) == "mutant - wild");
  CHECK(record.at("patches").size() == 1);
  CHECK(record.at("series").at("frames").size() == 80);
  CHECK(record.at("series").at("runs").size() == 8);
  CHECK(record.at("residues").at("names").at(0) == "</script><b>ALA 1");
  CHECK(record.at("tables").at(0).at("rows").size() == 8);
  std::string names;
  for (const auto& quantity : record.at("quantities")) names += quantity.at("name").get<std::string>() + ' ';
  CHECK(contains(names, "potential_difference potential_source potential_target p_family_wise"));
}

TEST_CASE("the verdict on a page is that of an answer where replicates suffice for one, and of none where not") {
  if (!can_draw()) return;
  const auto verdict = [](const PlantedResult& planted) {
    return nlohmann::json::parse(element(ensemble_page(planted.prefix, ""), "record")).at("verdict");
  };
  CHECK(verdict(PlantedResult(6)).at("trustworthy") == true);
  const auto of_few = verdict(PlantedResult(6, 2));  // 15 permutations
  CHECK(contains(of_few.at("text").get<std::string>(), "NO CONCLUSION"));
  CHECK(of_few.at("trustworthy") == false);
}

TEST_CASE("an ensemble's page draws the template's backbone, or says why not") {
  if (!can_draw()) return;
  const auto page_with = [](const std::string& backbone) {
    return nlohmann::json::parse(element(ensemble_page(PlantedResult(0, 4, backbone).prefix, ""), "record"));
  };
  const auto drawn = page_with("2: 0.00 0.00 0.00 0.00 0.00 1.00 3.80 0.00 0.00 0.00 1.00 0.00");
  for (const char* side : {"source", "target"}) {
    CHECK(drawn.at("backbone").at(side).at("chains") == nlohmann::json({2}));
    CHECK(drawn.at("backbone").at(side).at("points").at("n") == 6);
  }
  for (const auto& [backbone, because] :
       {std::pair("", "no molecule: the ensemble was computed by a version that did not keep it"),
        {"2: 0 0 0", "no molecule: the trace of a backbone is damaged"}}) {
    const auto without = page_with(backbone);
    CHECK(!without.contains("backbone"));
    CHECK(without.at("molecule_because") == because);
  }
}

TEST_CASE("one group has a page of its mean, without patches and significance") {
  if (!can_draw()) return;
  const PlantedResult planted(0, 0);
  const auto record = nlohmann::json::parse(element(ensemble_page(planted.prefix, ""), "record"));
  CHECK(record.at("title") == "wild");
  CHECK(record.at("patches").empty());
  CHECK(!record.contains("patch"));
  CHECK(!record.contains("fade"));
  CHECK(record.at("quantities").at(0).at("label") == "Mean potential of wild");
}

TEST_CASE("an ensemble of another version, or whose files do not belong together, is refused with the remedy") {
  if (!can_draw()) return;
  const PlantedResult planted(0);
  auto record = nlohmann::json::parse(read_file(planted.prefix + ".json"));
  const auto refused = [&](const nlohmann::json& changed, const char* words) {
    planted.folder.write("planted.json", changed.dump());
    CHECK_THROWS_WITH_AS(ensemble_page(planted.prefix, ""), doctest::Contains(words), FormatError);
  };
  auto changed = record;
  changed["format_version"] = 99;
  refused(changed, "not an ensemble of this version of espdiff; compute its statistics again (ensemble, from ");
  changed = record;
  changed["n_vertices"] = 3;
  refused(changed, "vertices, and not those of ");
  changed = record;
  changed.erase("equilibrium");
  refused(changed, "lacks what an ensemble's record has; compute its statistics again");
  planted.folder.write("planted.json", record.dump());
  std::filesystem::remove(planted.prefix + ".residues.csv");
  CHECK_THROWS_WITH_AS(ensemble_page(planted.prefix, ""), doctest::Contains("planted.residues.csv"), IoError);
}

TEST_CASE("a browser draws an ensemble, and a click in the series reads a frame") {
  if (!can_draw()) return;
  const PlantedResult planted(6);
  const auto dom = shown_in_browser(
      ensemble_page(planted.prefix, ""),
      "document.querySelector('tr.choice').click(); const svg = document.querySelector('#series svg'), "
      "box = svg.getBoundingClientRect(); svg.dispatchEvent(new MouseEvent('click', {clientX: box.left + box.width - "
      "12, "
      "clientY: box.top + 40})); document.documentElement.dataset.seen = [document.querySelectorAll('tr.choice.picked')"
      ".length, document.querySelectorAll('#series path').length, document.getElementById('frame').textContent, "
      "document.getElementById('morphs').hidden].join('|');",
      planted.folder);
  if (!dom) return;
  CHECK_MESSAGE(contains(*dom, "data-seen=\"1|8|mutant, 4, frame 9: "), dom->substr(0, 400));
  CHECK(contains(*dom, "kT/e|true\""));
  CHECK(!contains(*dom, "data-failed"));
}
