// study_page.cpp: trajectories and matrices as pages: what they hold, and that a click selects a frame or a pair.
#include "page/study_page.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/text/citation.h"
#include "base/version.h"
#include "cli/run_espdiff.h"
#include "page/browser.h"
#include "page/result_page.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

/// Three rows of atoms, compared with each other and as frames.
struct SmallStudy {
  ScratchFolder folder;
  std::string matrix = folder.file("rows"), trajectory = folder.file("frames");
  SmallStudy() {
    std::string files;
    for (int i = 0; i < 3; ++i) {
      const std::string name = std::string(1, static_cast<char>('a' + i)) + "<b>.pqr";
      files += " '" + folder.write(name, row_of_atoms(6, 0.3 * i)) + "'";
    }
    REQUIRE(run_espdiff("matrix" + files + " --potential coulomb -q -o " + matrix).status == 0);
    const std::string source = " '" + folder.file("a<b>.pqr") + "'";
    REQUIRE(run_espdiff("trajectory" + source + files + " --potential coulomb -q --residues " +
                        folder.file("frames.residues.csv") + " -o " + trajectory + ".csv")
                .status == 0);
  }
};

}  // namespace

TEST_CASE("the kind of a page follows from the files of the result") {
  const SmallStudy study;
  CHECK(page_kind(study.matrix) == PageKind::kMatrix);
  CHECK(page_kind(study.trajectory) == PageKind::kTrajectory);
  CHECK(page_kind(study.folder.file("none")) == PageKind::kPair);
  study.folder.write("many.json", "{\"plan\": {}, \"noise_floor\": {}}");
  CHECK(page_kind(study.folder.file("many")) == PageKind::kEnsemble);
  study.folder.write("list.json", "[]");
  CHECK_THROWS_WITH_AS(page_kind(study.folder.file("list")), doctest::Contains("not a record that espdiff wrote"),
                       FormatError);
}

TEST_CASE("a matrix' page has every pair at its place, and names stay texts") {
  const SmallStudy study;
  const std::string page = matrix_page(study.matrix, "");
  CHECK(!contains(element(page, "record"), "<"));
  const auto record = nlohmann::json::parse(element(page, "record"));
  CHECK(record.at("labels") == nlohmann::json({"a<b>", "b<b>", "c<b>"}));
  CHECK(record.at("trust").size() == 9);
  CHECK(record.at("trust").at(0).is_null());
  CHECK(record.at("trust").at(1).is_boolean());
  CHECK(record.at("order").size() == 3);
  CHECK(record.at("provenance").at(0).at(0) == "Program");
  CHECK(record.at("provenance").back().at(0) == "How to cite");
  for (const auto& metric : record.at("metrics")) CHECK(metric.at("n") == 9);
}

TEST_CASE("a trajectory's page has every frame, and its residues") {
  const SmallStudy study;
  const auto record = nlohmann::json::parse(element(trajectory_page(study.trajectory, "Three"), "record"));
  CHECK(record.at("title") == "Three");
  CHECK(record.at("labels").size() == 3);
  CHECK(record.at("residues").at("names").at(0) == "A:ALA 1");
  CHECK(record.at("residues").at("n") == 18);
  CHECK(record.at("residues").at("label") == "Mean absolute difference [kT/e in vacuum]");
  CHECK(contains(record.at("verdict").at("text").get<std::string>(), " of 3 frames are trustworthy"));
  const auto& provenance = record.at("provenance");
  CHECK(provenance.at(0).at(0) == "Program");
  CHECK(provenance.back().at(1) == citation_of(kVersion));
  CHECK(contains(provenance.dump(), "[\"Options\",\"all have their defaults\"]"));
  for (const auto& row : provenance) CHECK_MESSAGE(!contains(row.at(0).get<std::string>(), "_"), row.dump());
}

TEST_CASE("a frame's reason that is a warning, too, stands once") {
  const SmallStudy study;
  study.folder.write("frames.csv", "frame,rmsd_A,trustworthy,reasons,warnings\n0,1,0,far off,far off\n1,1,1,,\n");
  const auto record = nlohmann::json::parse(element(trajectory_page(study.trajectory, ""), "record"));
  CHECK(record.at("remarks").dump() == R"({"0":["far off"]})");
}

TEST_CASE("a study that is damaged or of another version is refused") {
  const SmallStudy study;
  study.folder.write("rows.json", "{\"variants\": [{\"label\": \"x\"}]}");
  CHECK_THROWS_WITH_AS(matrix_page(study.matrix, ""), doctest::Contains("names a variant that "), FormatError);
  study.folder.write("rows.json", "{\"variants\": [3], \"format_version\": 2}");
  CHECK_THROWS_WITH_AS(matrix_page(study.matrix, ""),
                       doctest::Contains("rows.json: version 2 of the format; this espdiff reads version 1: use that "),
                       FormatError);
  study.folder.write("rows.json", "{\"variants\": [3]}");
  CHECK_THROWS_WITH_AS(matrix_page(study.matrix, ""),
                       doctest::Contains("not a matrix of this version of espdiff; compute it again"), FormatError);
  study.folder.write("frames.csv", "frame,other\n0,1\n");
  CHECK_THROWS_WITH_AS(trajectory_page(study.trajectory, ""),
                       doctest::Contains("no column holds a metric of this version"), FormatError);
  study.folder.write("frames.csv", "frame,rmsd_A\n");
  CHECK_THROWS_WITH_AS(trajectory_page(study.trajectory, ""), doctest::Contains("there are no rows"), FormatError);
}

TEST_CASE("a click in a browser selects a pair, and a frame with a residue") {
  const SmallStudy study;
  const auto matrix = shown_in_browser(
      matrix_page(study.matrix, ""),
      "document.querySelector('rect[data-place=\"5\"]').dispatchEvent(new MouseEvent('click', {bubbles: true})); "
      "document.documentElement.dataset.seen = [document.querySelectorAll('rect').length, "
      "document.getElementById('chosen').textContent, document.querySelectorAll('rect.picked').length].join('|');",
      study.folder);
  if (!matrix) return;
  CHECK_MESSAGE(contains(*matrix, "data-seen=\"6|b&lt;b&gt; to c&lt;b&gt;|1\""), matrix->substr(0, 400));
  CHECK(!contains(*matrix, "data-failed"));
  const auto frames = shown_in_browser(
      trajectory_page(study.trajectory, ""),
      "const map = document.querySelector('#residues canvas'), box = map.getBoundingClientRect(); "
      "map.dispatchEvent(new MouseEvent('click', {clientX: box.left + 0.9 * box.width, clientY: box.top + 1})); "
      "document.documentElement.dataset.seen = [document.getElementById('chosen').textContent, "
      "document.querySelectorAll('svg').length, document.getElementById('picked').textContent.includes('A:ALA 1'), "
      "[...document.querySelectorAll('svg')].every((plot) => "
      "plot.getBoundingClientRect().width > 0.99 * plot.viewBox.baseVal.width)].join('|');",
      study.folder, 500);
  REQUIRE(frames);
  // The last: texts of the plots are not smaller than those around them.
  CHECK_MESSAGE(contains(*frames, "data-seen=\"Frame 2|2|true|true\""), frames->substr(0, 400));
}
