// report_page.cpp: a result as a page: what it holds, that hostile texts stay texts, and that a browser draws it.
#include <doctest/doctest.h>
#include <fstream>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "base/error.h"
#include "base/text/citation.h"
#include "base/version.h"
#include "cli/run_espdiff.h"
#include "io/vtk/read_vtp.h"
#include "page/browser.h"
#include "page/page_arrays.h"
#include "page/page_surface.h"
#include "page/page_texts.h"
#include "page/report_page.h"
#include "page/result_page.h"
#include "scene/reasons.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

bool has_three() {
  const bool found = page_texts().count("three.min.js") > 0;
  if (!found) MESSAGE("SKIPPED: this build has no three.js");
  return found;
}

/// A comparison of two rows of atoms, whose residues have a name.
struct SmallResult {
  ScratchFolder folder;
  std::string prefix = folder.file("pair");
  explicit SmallResult(const std::string& residue = "ALA") {
    folder.write("a.pqr", row_of_atoms(8, 0, residue));
    folder.write("b.pqr", row_of_atoms(8, 0.4, residue));
    REQUIRE(run_espdiff(folder.file("a.pqr") + " " + folder.file("b.pqr") + " --potential coulomb -q -o " + prefix)
                .status == 0);
  }
};

}  // namespace

TEST_CASE("arrays keep their values to a step of their range, and say what has none") {
  PageArrays arrays;
  arrays.add_integers({7});
  const std::vector<double> values = {-1, 10, 0.25, std::nan(""), 3, 9.5};
  const auto described = arrays.add_numbers(values, PageArrays::kColourSteps, 2);
  CHECK(described.at("offset") == 4);
  CHECK(described.at("min") == -1);
  CHECK(described.at("max") == 10);
  // As the page's decode(): low bytes, high bytes, each the difference from the one before of its kind.
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(arrays.bytes().at(4 + i)); };
  std::vector<std::uint16_t> steps(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    steps[i] = static_cast<std::uint16_t>((i < 2 ? 0 : steps[i - 2]) + byte(i) + 256 * byte(values.size() + i));
    const double width = 11.0 / PageArrays::kColourSteps;
    if (std::isnan(values[i]))
      CHECK(steps[i] == 65535);
    else
      CHECK(-1 + steps[i] * width == doctest::Approx(values[i]).epsilon(width));
  }
  const auto triangles = arrays.add_triangles({{0, 1, 2}, {2, 1, 3}});
  CHECK(triangles.at("n") == 2);
  CHECK(triangles.at("offset") == 16);
  CHECK(arrays.bytes().size() == 16 + 24);
}

TEST_CASE("what is too large for a page is refused with the remedy") {
  CHECK_NOTHROW(require_page_size(kMaxPageTriangles, "out"));
  CHECK_THROWS_WITH_AS(
      require_page_size(kMaxPageTriangles + 1, "out"),
      doctest::Contains("out.vtp: 500001 triangles; a page takes at most 500000: compare with a larger "), InputError);
}

TEST_CASE("a page of prepared states names the files that the user gave") {
  if (!has_three()) return;
  const SmallResult result;
  auto json = nlohmann::ordered_json::parse(read_file(result.prefix + ".json"));
  json["inputs"].push_back({{"role", "source_file"}, {"path", "entries/1t24.pdb"}, {"sha256", std::string(64, '0')}});
  std::ofstream(result.prefix + ".json") << json.dump(2) << '\n';
  const auto record = nlohmann::json::parse(element(report_page(result.prefix, ""), "record"));
  CHECK(record.at("title") == "b.pqr against 1t24.pdb");
}

TEST_CASE("a page holds the numbers, the residues and the verdict of its result, and fetches nothing") {
  if (!has_three()) return;
  const SmallResult result;
  const std::string page = report_page(result.prefix, "");
  const auto record = nlohmann::json::parse(element(page, "record"));
  const auto json = nlohmann::json::parse(read_file(result.prefix + ".json"));
  CHECK(record.at("title") == "b.pqr against a.pqr");
  CHECK(record.at("n_vertices") == json.at("n_vertices"));
  CHECK(record.at("triangles").at("n") == json.at("n_triangles"));
  CHECK(record.at("residues").at("rows").size() == 8);
  CHECK(record.at("verdict").at("trustworthy") == json.at("certificate").at("trustworthy"));
  CHECK(record.at("numbers").at(0).at("rows").at(0).at("label") == "Mean absolute difference");
  CHECK(record.at("quantities").at(0).at("name") == "potential_difference");
  CHECK(contains(page, "default-src 'none'"));
  for (const char* fetched : {" src=", "<link", "@import", "url("}) {
    const std::string ours = page_texts().at("report.html") + page_texts().at("report.css");
    CHECK_MESSAGE(!contains(ours, fetched), fetched);
  }
}

TEST_CASE("what is not trusted or unmatched ends at a smooth line, as in pictures") {
  VtpContent sheet;  // 21 x 21 vertices: the left is not trusted, a square is unmatched, and lost
  std::vector<Vec3d> start;
  PageMarks marks;
  constexpr int kSide = 21;
  const auto is_lost = [](int x, int y) { return x > 12 && x < 18 && y > 7 && y < 13; };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      start.push_back({x + 0.0, y + 0.0, 0});
      sheet.positions.push_back(is_lost(x, y) ? Vec3d{50, 50, 50} : Vec3d{x + 0.0, y + 0.0, 2});
    }
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const auto at = static_cast<std::uint32_t>(y * kSide + x), up = at + kSide;
      for (const Triangle& t : {Triangle{at, at + 1, up}, Triangle{at + 1, up + 1, up}}) {
        sheet.triangles.push_back(t);
        marks.unmatched.push_back(
            std::any_of(t.begin(), t.end(), [&](auto corner) { return sheet.positions[corner].x == 50; }) ? 1 : 0);
        marks.untrusted.push_back(x < 6 ? 1 : 0);
      }
    }
  }
  nlohmann::ordered_json page;
  PageArrays arrays;
  add_page_mesh(page, arrays, sheet, start, marks);
  const auto share = [&](const char* name, int x, int y) {
    const auto& cover = page.at("cover").at(name);
    const std::size_t offset = cover.at("offset"), n = cover.at("n"), end = static_cast<std::size_t>(y * kSide + x);
    std::uint16_t step = 0;
    for (std::size_t v = 0; v <= end; ++v)
      step = static_cast<std::uint16_t>(step + static_cast<unsigned char>(arrays.bytes().at(offset + v)) +
                                        256 * static_cast<unsigned char>(arrays.bytes().at(offset + n + v)));
    const double low = cover.at("min"), high = cover.at("max");
    return low + step * (high - low) / cover.at("steps").get<double>();
  };
  CHECK(share("trusted", 0, 10) < 0.1);
  CHECK(share("trusted", 20, 0) == doctest::Approx(1));
  double before = 0;
  for (int x = 0; x < 12; ++x) {  // rises over several vertices, and crosses the half where the triangles end
    const double here = share("trusted", x, 3);
    CHECK(here >= before);
    CHECK(here - before < 0.3);
    if (x < 6) CHECK(here < 0.5);
    if (x > 6) CHECK(here > 0.5);
    before = here;
  }
  CHECK(share("matched", 15, 10) < 0.2);
  CHECK(share("matched", 13, 8) < 0.5);
  CHECK(share("matched", 10, 10) > 0.5);
  CHECK(page.at("cover").at("matched").at("text") == "unmatched");
  CHECK(page.at("cover").at("trusted").at("text") == "not trusted");
  CHECK(page.at("positions").at("target").at("max") == doctest::Approx(20));  // lost vertices follow their surroundings
  nlohmann::ordered_json whole;
  add_page_mesh(whole, arrays, sheet, start, {});
  CHECK(whole.at("cover").empty());
}

TEST_CASE("a page has the backbones, or says why not") {
  if (!has_three()) return;
  const SmallResult result;
  const auto with = nlohmann::json::parse(element(report_page(result.prefix, ""), "record"));
  for (const char* side : {"source", "target"}) {
    CHECK(with.at("backbone").at(side).at("chains") == nlohmann::json({8}));
    CHECK(with.at("backbone").at(side).at("points").at("n") == 24);
  }
  result.folder.write("a.pqr", row_of_atoms(7));
  const auto without = nlohmann::json::parse(element(report_page(result.prefix, ""), "record"));
  CHECK(!without.contains("backbone"));
  CHECK(contains(without.at("molecule_because").get<std::string>(), "no molecule: "));
  CHECK(contains(without.at("molecule_because").get<std::string>(), "a.pqr"));
}

TEST_CASE("a page has the causes of each reading, in words and by residue") {
  if (!has_three()) return;
  const SmallResult result;
  REQUIRE(run_espdiff(result.folder.file("a.pqr") + " " + result.folder.file("b.pqr") +
                      " --potential coulomb --region //A/2 --causes region -q --overwrite -o " + result.prefix)
              .status == 0);
  const auto table = nlohmann::json::parse(element(report_page(result.prefix, ""), "record")).at("tables").at(0);
  CHECK(table.at("title") == "Causes of the difference, region");
  CHECK(contains(table.at("help").get<std::string>(), "The difference is "));
  CHECK(table.at("rows").size() > 1);
  CHECK(table.at("rows").at(0).size() == table.at("columns").size());
}

TEST_CASE("names in files are texts to the page") {
  if (!has_three()) return;
  const SmallResult result("</s");
  const std::string page = report_page(result.prefix, "</script><script>alert(1)</script>");
  const std::string record = element(page, "record");
  CHECK(nlohmann::json::parse(record).at("title") == "</script><script>alert(1)</script>");
  CHECK(!contains(record, "<"));
}

TEST_CASE("a result that is not whole, or not a comparison's, is refused with the remedy") {
  if (!has_three()) return;
  const SmallResult result;
  CHECK_THROWS_WITH_AS(report_page(result.folder.file("none"), ""),
                       doctest::Contains("none.json: cannot be read: No such file or directory"), IoError);
  result.folder.write("other.json", "{\"matrix\": 1}");
  CHECK_THROWS_WITH_AS(report_page(result.folder.file("other"), ""),
                       doctest::Contains("not a record that `espdiff compare` wrote; compare again"), FormatError);
  const std::string record = read_file(result.prefix + ".json");
  result.folder.write("pair.json",
                      std::regex_replace(record, std::regex("\"format_version\": 1"), "\"format_version\": 7"));
  CHECK_THROWS_WITH_AS(report_page(result.prefix, ""),
                       doctest::Contains("pair.json: version 7 of the format, written by espdiff "), FormatError);
  CHECK_THROWS_WITH_AS(
      report_page(result.prefix, ""),
      doctest::Contains("; this espdiff reads version 1: use that espdiff, or compute the result again"), FormatError);
  auto changed = nlohmann::json::parse(record);
  changed["causes"] = {{"reading", 3}};
  result.folder.write("pair.json", changed.dump());
  CHECK_THROWS_WITH_AS(report_page(result.prefix, ""),
                       doctest::Contains("pair.json: a part of it is not as `espdiff compare` writes it"), FormatError);
  result.folder.write("pair.json", record);
  const std::string surface = read_file(result.prefix + ".vtp");
  for (const std::string array : {"source_position", "residue_index", "potential_difference"}) {
    std::string without = surface;
    without.replace(without.find("Name=\"" + array + '"') + 6, array.size(), std::string(array.size(), 'x'));
    result.folder.write("pair.vtp", without);
    CHECK_THROWS_WITH_AS(report_page(result.prefix, ""),
                         doctest::Contains(("has no point array '" + array + "'; compare again").c_str()), FormatError);
  }
  result.folder.write("pair.vtp", surface);
  const std::string residues = read_file(result.prefix + ".residues.csv");
  result.folder.write("pair.residues.csv", residues.substr(0, residues.find('\n', residues.find('\n') + 1) + 1));
  CHECK_THROWS_WITH_AS(report_page(result.prefix, ""), doctest::Contains("pair.residues.csv: there is no row 2, and "),
                       FormatError);
  std::filesystem::remove(result.prefix + ".residues.csv");
  CHECK_THROWS_WITH_AS(report_page(result.prefix, ""), doctest::Contains("pair.residues.csv"), IoError);
}

TEST_CASE("pages of a study have the widest range of all its results") {
  if (!has_three()) return;
  const SmallResult one;
  const std::string other = one.folder.file("other");
  one.folder.write("c.pqr", std::regex_replace(row_of_atoms(8), std::regex(" 0\\.5000"), " -2.000"));
  REQUIRE(run_espdiff(one.folder.file("a.pqr") + " " + one.folder.file("c.pqr") + " --potential coulomb -q -o " + other)
              .status == 0);
  const auto range_in = [](const std::string& page) {
    return nlohmann::json::parse(element(page, "record")).at("quantities").at(0).at("range").get<double>();
  };
  const double alone = range_in(report_page(one.prefix, "")), widest = range_in(report_page(other, ""));
  REQUIRE(alone < widest);
  CHECK(range_in(report_page(one.prefix, "", {other + ".vtp"})) == widest);
  CHECK(range_in(report_page(other, "", {one.prefix + ".vtp"})) == widest);
  CHECK_THROWS_WITH_AS(result_page(other, "", {one.folder.file("none.vtp")}), doctest::Contains("none.vtp"), IoError);
  one.folder.write("frames.csv", "frame,rmsd_A\n0,1\n");
  CHECK_THROWS_WITH_AS(result_page(one.folder.file("frames"), "", {other + ".vtp"}),
                       doctest::Contains("is for surfaces, and "), InputError);
}

TEST_CASE("nothing in a file's or a residue's name runs in a browser") {
  if (!has_three()) return;
  const SmallResult result("<b>");
  const std::string hostile = "<img src=x onerror=alert(1)>\"'&lt;</script><svg onload=alert(1)>.pqr";
  std::string name = hostile;
  for (char& c : name) c = c == '/' ? '|' : c;  // no file has it in its name
  std::filesystem::copy(result.folder.file("b.pqr"), result.folder.file(name));
  REQUIRE(run_espdiff(result.folder.file("a.pqr") + " '" +
                      std::regex_replace(result.folder.file(name), std::regex("'"), "'\\''") +
                      "' --potential coulomb -q --overwrite -o " + result.prefix)
              .status == 0);
  const auto dom =
      shown_in_browser(report_page(result.prefix, hostile),
                       "document.querySelector('#residues tbody tr').click(); const own = "
                       "document.querySelectorAll('body > script').length; "
                       "document.documentElement.dataset.seen = [document.querySelectorAll('img, svg, b').length, "
                       "document.getElementById('title').textContent === " +
                           std::regex_replace(nlohmann::json(hostile).dump(), std::regex("<"), "\\u003c") +
                           ", "
                           "document.getElementById('picked').textContent.includes('<b>')].join('|');",
                       result.folder);
  if (!dom) return;
  CHECK(!contains(*dom, "data-failed"));
  CHECK_MESSAGE(contains(*dom, "data-seen=\"0|true|true\""), dom->substr(0, 400));
}

TEST_CASE("a browser has the numbers of the file; a field's target is the sum of its source and the difference") {
  if (!has_three()) return;
  const SmallResult result;
  REQUIRE(run_espdiff(result.folder.file("a.pqr") + " " + result.folder.file("b.pqr") +
                      " --potential coulomb --field curvature -q --overwrite -o " + result.prefix)
              .status == 0);
  const std::string page = report_page(result.prefix, "");
  const auto record = nlohmann::json::parse(element(page, "record"));
  const VtpContent surface = read_vtp(result.prefix + ".vtp");
  nlohmann::json wanted;
  for (const auto& quantity : record.at("quantities")) {
    const std::string name = quantity.at("name");
    CHECK(quantity.at("label") != name);
    if (name == "why") continue;  // the last; the file has it by triangle
    CHECK(quantity.contains("sum_of") == (name == "potential_target" || name == "curvature_target"));
    if (name == "curvature_target") {
      CHECK(quantity.at("label") == "Mean curvature, target");
      CHECK(quantity.at("unit") == "1/A");
    }
    wanted.push_back(find_array(surface.point_arrays, name)->values);  // NaN becomes null
  }
  const auto dom = shown_in_browser(
      page,
      "const wanted = " + wanted.dump() +
          "; const all = Page.decodeAll(Page.record.quantities); let worst = 0; "
          "wanted.forEach((list, q) => { const size = Math.max(...list.map(Math.abs), 1e-9); list.forEach((x, v) => { "
          "worst = Math.max(worst, x === null ? (isNaN(all[q][v]) ? 0 : 9) : Math.abs(all[q][v] - x) / size); }); }); "
          "document.documentElement.dataset.seen = (all.length - 1) + '|' + (worst < 1e-3 ? 'same' : worst);",
      result.folder);
  if (!dom) return;
  CHECK(!contains(*dom, "data-failed"));
  CHECK_MESSAGE(contains(*dom, "data-seen=\"" + std::to_string(wanted.size()) + "|same\""), dom->substr(0, 400));
}

TEST_CASE("a browser marks what is unmatched and what is not trusted, each with its key") {
  if (!has_three()) return;
  const SmallResult result;
  const std::string whole = report_page(result.prefix, "");
  auto record = nlohmann::json::parse(element(whole, "record"));
  CHECK(record.at("cover").empty());
  CHECK(!contains(whole, "REVISION"));  // three.js is packed
  // Every vertex is half trusted in one page, and is unmatched in the other: one number for all.
  const std::size_t n = record.at("n_vertices");
  const auto with = [&](const char* part, double share) {
    auto changed = record;
    changed["cover"][part] = {{"offset", 0}, {"n", n},      {"min", share}, {"max", share},
                              {"steps", 1},  {"stride", n}, {"text", part}};
    std::string page = whole;
    const std::string old = element(whole, "record");
    return page.replace(page.find(old), old.size(), changed.dump());
  };
  const std::string look =
      "const gl = document.querySelector('#canvas canvas'), copy = document.createElement('canvas'); "
      "const grey = () => { copy.width = gl.width; copy.height = gl.height; const context = copy.getContext('2d'); "
      "context.drawImage(gl, 0, 0); const p = context.getImageData(0, 0, gl.width, gl.height).data; let some = 0, all "
      "= 0; "
      "for (let i = 0; i < p.length; i += 4) { if (p[i + 3] < 255) continue; ++all; "
      "some += Math.abs(p[i] - p[i + 1]) < 6 && Math.abs(p[i + 1] - p[i + 2]) < 6; } return all > 1000 && some > 0.9 * "
      "all; }; "
      "const keys = () => ['untrusted', 'unmatched'].filter((id) => document.getElementById(id).offsetWidth > "
      "0).join('+'); "
      "const choose = document.getElementById('quantity'), own = [...choose.options].map((o) => o.textContent); "
      "const of = (name) => { choose.value = Page.record.quantities.findIndex((q) => q.name === name); "
      "choose.onchange(); "
      "return keys() + ':' + grey(); }; "
      "document.documentElement.dataset.seen = [of('potential_difference'), of('potential_source')].join('|');";
  const auto unmarked = shown_in_browser(whole, look, result.folder);
  if (!unmarked) return;
  CHECK_MESSAGE(contains(*unmarked, "data-seen=\":false|:false\""), unmarked->substr(0, 400));
  const auto untrusted = shown_in_browser(with("trusted", 0.25), look, result.folder);
  CHECK_MESSAGE(contains(*untrusted, "data-seen=\"untrusted:true|:false\""), untrusted->substr(0, 400));
  const auto unmatched = shown_in_browser(with("matched", 0.25), look, result.folder);
  CHECK_MESSAGE(contains(*unmatched, "data-seen=\"unmatched:true|unmatched:true\""), unmatched->substr(0, 400));
}

TEST_CASE("labels of linked views stand beside each other on a phone") {
  if (!has_three()) return;
  const SmallResult result;
  const auto dom = shown_in_browser(
      report_page(result.prefix, ""),
      "document.getElementById('linked').click(); const canvas = document.getElementById('canvas'), boxes = "
      "[...document.querySelectorAll('.label')].map((label) => label.getBoundingClientRect()); "
      "document.documentElement.dataset.seen = [boxes.length, boxes.every((box, i) => box.right <= (i < 2 ? "
      "boxes[i + 1] : canvas.getBoundingClientRect())[i < 2 ? 'left' : 'right']), "
      "canvas.getBoundingClientRect().top < 600].join('|');",
      result.folder, 500);
  if (!dom) return;
  CHECK_MESSAGE(contains(*dom, "data-seen=\"3|true|true\""), dom->substr(0, 400));  // on the first screen
}

TEST_CASE("a page says how to cite the version that made the result") {
  if (!has_three()) return;
  const SmallResult result;
  const auto record = nlohmann::json::parse(element(report_page(result.prefix, ""), "record"));
  CHECK(record.at("provenance").back() == nlohmann::json({"How to cite", citation_of(kVersion)}));
}

TEST_CASE("a page has the reasons of pictures: their keys, colours and shares of the surface") {
  if (!has_three()) return;
  const SmallResult result;
  const auto record = nlohmann::json::parse(element(report_page(result.prefix, ""), "record"));
  const auto certificate = nlohmann::json::parse(read_file(result.prefix + ".json")).at("certificate");
  const auto& reasons = record.at("reasons");
  REQUIRE(reasons.size() == kDrawnReasons.size());
  double trusted = 0, not_trusted = 0;
  for (std::size_t r = 0; r < reasons.size(); ++r) {
    CHECK(reasons[r].at("key") == kDrawnReasons[r].key);
    CHECK(reasons[r].at("colour") ==
          nlohmann::json{kDrawnReasons[r].colour.red, kDrawnReasons[r].colour.green, kDrawnReasons[r].colour.blue});
    if (!reasons[r].contains("text")) continue;
    const std::string text = reasons[r].at("text"), words = std::string(kDrawnReasons[r].words) + ' ';
    REQUIRE(text.rfind(words, 0) == 0);
    const bool is_trusted = r == 0 || reasons[r].at("key") == "turned_side_chain";
    (is_trusted ? trusted : not_trusted) += std::stod(text.substr(words.size()));
  }
  CHECK(trusted ==
        doctest::Approx(100 * certificate.at("trusted_area_fraction").at("source").get<double>()).scale(0.2));
  CHECK(trusted + not_trusted <= doctest::Approx(100).scale(0.5));
  const auto& last = record.at("quantities").back();
  CHECK(last.at("name") == "why");
  CHECK(last.at("label") == "Where it is trusted, and why not elsewhere");
  VtpContent old = read_vtp(result.prefix + ".vtp");
  old.cell_arrays.clear();  // of an older result
  nlohmann::ordered_json page = {{"quantities", nlohmann::ordered_json::array()}};
  PageArrays arrays;
  add_page_reasons(page, arrays, old);
  CHECK(!page.contains("reasons"));
}

TEST_CASE("a browser draws the reason that most of the surroundings have, with its key instead of the scale") {
  if (!has_three()) return;
  const SmallResult result;
  const std::string whole = report_page(result.prefix, "");
  // 0.4 of every vertex's surroundings slipped, and 0.3 are on another residue and trusted.
  auto record = nlohmann::json::parse(element(whole, "record"));
  const std::size_t n = record.at("n_vertices");
  for (std::size_t r = 0; r < kDrawnReasons.size(); ++r) {
    const double share = r == 0 ? 0.3 : r == 1 ? 0.4 : r == 2 ? 0.3 : 0;
    const auto colour = record["reasons"][r]["colour"];
    record["reasons"][r] = {{"offset", 0}, {"n", n}, {"min", share}, {"max", share}, {"steps", 1}, {"stride", n}};
    record["reasons"][r]["colour"] = colour;
    record["reasons"][r]["key"] = kDrawnReasons[r].key;
    if (share > 0) record["reasons"][r]["text"] = std::string(kDrawnReasons[r].words) + " 40 %";
  }
  std::string page = whole;
  const std::string old = element(whole, "record");
  page.replace(page.find(old), old.size(), record.dump());
  const auto dom = shown_in_browser(
      page,
      "const gl = document.querySelector('#canvas canvas'), copy = document.createElement('canvas'); "
      "copy.width = gl.width; copy.height = gl.height; const context = copy.getContext('2d'); "
      "const choose = document.getElementById('quantity'); "
      "const orange = (name) => { choose.value = Page.record.quantities.findIndex((q) => q.name === name); "
      "choose.onchange(); context.clearRect(0, 0, gl.width, gl.height); context.drawImage(gl, 0, 0); "
      "const p = context.getImageData(0, 0, gl.width, gl.height).data; let some = 0, all = 0; "
      "for (let i = 0; i < p.length; i += 4) { if (p[i + 3] < 255) continue; ++all; "
      "some += Math.abs(p[i + 1] / p[i] - 94 / 213) < 0.05 && p[i + 2] < 0.1 * p[i]; } "
      "const seen = ['scale', 'ranges', 'colour-maps', 'reasons'].filter((id) => !document.getElementById(id).hidden); "
      "return (all > 1000 && some > 0.9 * all) + ':' + seen.join('+'); }; "
      "document.documentElement.dataset.seen = [orange('why'), orange('potential_difference'), "
      "document.querySelectorAll('#reasons > span').length].join('|');",
      result.folder);
  if (!dom) return;
  CHECK(!contains(*dom, "data-failed"));
  CHECK_MESSAGE(contains(*dom, "data-seen=\"true:reasons|false:scale+ranges+colour-maps|3\""), dom->substr(0, 400));
}

TEST_CASE("a browser draws the surface, and a click on a residue shows it") {
  if (!has_three()) return;
  const SmallResult result;
  const auto dom = shown_in_browser(
      report_page(result.prefix, ""),
      "document.querySelector('#residues tbody tr:nth-child(2)').click(); "
      "document.getElementById('linked').click(); const gl = document.querySelector('#canvas canvas'); "
      "const copy = document.createElement('canvas'); copy.width = gl.width; copy.height = gl.height; "
      "const context = copy.getContext('2d'); context.drawImage(gl, 0, 0); "
      "const pixels = context.getImageData(0, 0, gl.width, gl.height).data; let drawn = 0, changed = 0; "
      "for (let i = 3; i < pixels.length; i += 4) drawn += pixels[i] > 0; "
      "document.getElementById('molecule').click(); context.clearRect(0, 0, gl.width, gl.height); "
      "context.drawImage(gl, 0, 0); const after = context.getImageData(0, 0, gl.width, gl.height).data; "
      "for (let i = 0; i < pixels.length; ++i) changed += pixels[i] !== after[i]; "
      "document.documentElement.dataset.seen = [drawn > 1000, changed > 1000, "
      "document.querySelectorAll('.label').length, "
      "document.querySelectorAll('.picked').length, document.getElementById('picked').textContent, "
      "touched()].join('|'); "
      // A finger on the middle of the first panel; the controls take the browser's own click from it.
      "function touched() { document.getElementById('linked').click(); const box = gl.getBoundingClientRect(); "
      "document.getElementById('picked').textContent = ''; for (const type of ['pointerdown', 'pointerup']) "
      "gl.dispatchEvent(new PointerEvent(type, {pointerType: 'touch', isPrimary: true, clientX: box.left + box.width / "
      "2, "
      "clientY: box.top + box.height / 2})); return document.getElementById('picked').textContent; }",
      result.folder);
  if (!dom) return;
  CHECK(!contains(*dom, "data-failed"));
  CHECK_MESSAGE(contains(*dom, "data-seen=\"true|true|3|1|A:ALA"), dom->substr(0, 400));
  CHECK_MESSAGE(contains(*dom, " A|A:ALA"), dom->substr(0, 600));
}
