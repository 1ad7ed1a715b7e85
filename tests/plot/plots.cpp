// plots.cpp: heat maps and lines: every label, unit and number in the SVG's text, the order and range of the drawing,
// and refusals.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/error.h"
#include "plot/colour_map.h"
#include "plot/heat_map.h"
#include "plot/line_plot.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;  // NOLINT: a test
using espdiff_test::contains;
using espdiff_test::message_of;
using espdiff_test::read_file;
using espdiff_test::ScratchFolder;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool has_gnuplot() {
  static const bool found = std::system("gnuplot --version >/dev/null 2>&1") == 0;
  if (!found) MESSAGE("SKIPPED: gnuplot is not installed (Debian: gnuplot-nox)");
  return found;
}

/// Difficult labels that users may write.
HeatMap four() {
  HeatMap map;
  map.labels = {"50 % \"EtOH\" & <water>", "b_2", "c^3\\n", "\u03B2-lactamase"};
  map.groups = {"A", "A", "B", "A"};
  map.values = {9, 1, 2, 3, 4, 9, 5, 6, 7, 8, 9, kNan, 2.5, 3.5, 4.5, 9};
  map.marked = std::vector<bool>(16, false);
  map.marked[1] = true;
  map.mark_title = "not trustworthy";
  map.title = "Mean displacement";
  map.unit = "\u00C5";
  return map;
}

LinePlot two_units() {
  LinePlot plot;
  plot.title = "one against all";
  plot.x_title = "Target";
  plot.labels = {"m01", "m02", "m03"};
  plot.groups = {"A", "A", "B"};
  plot.series = {{"Mean absolute difference", "kT/e", {1, kNan, 3}, {0.1, 0, 0.2}},
                 {"RMS difference", "kT/e", {2, 3, 4}, {}},
                 {"RMSD", "\u00C5", {0.5, 1.5, 1}, {}}};
  plot.trustworthy = {true, false, true};
  return plot;
}

/// The text of an SVG without markup, with its entities decoded.
std::string text_of(const std::string& svg) {
  std::string text;
  bool inside = false;
  for (const char c : svg) {
    if (c == '<') inside = true;
    if (!inside) text += c;
    if (c == '>') inside = false;
  }
  for (const auto& [entity, character] :
       {std::pair<const char*, const char*>{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}}) {
    const std::string name = entity;
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) text.replace(at, name.size(), character);
  }
  return text;
}

}  // namespace

TEST_SUITE_BEGIN("plots");

TEST_CASE("every label, group, title and unit of a heat map is text in the SVG") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string path = folder.file("map.svg");
  write_picture(path, heat_map_script(four(), PictureFormat::kSvg));
  const std::string text = text_of(read_file(path));
  for (const std::string& label : four().labels) CHECK_MESSAGE(contains(text, label), text);
  for (const char* word : {"Mean displacement (\u00C5)", "Source", "Target", "\u2022 not trustworthy", "A", "B"})
    CHECK_MESSAGE(contains(text, word), std::string(word));
}

TEST_CASE("a title longer than the matrix is written in letters that fit into the picture") {
  const std::string beside = "center rotate by 90 font ',", centred = "screen 0.5 " + beside;
  HeatMap map = four();
  CHECK(contains(heat_map_script(map, PictureFormat::kSvg), beside + "10'"));
  CHECK_FALSE(contains(heat_map_script(map, PictureFormat::kSvg), centred));
  map.title = "Mean absolute difference, hydrophobicity of the residues";
  const std::string script = heat_map_script(map, PictureFormat::kSvg);
  REQUIRE(contains(script, centred));
  const double font = std::stod(script.substr(script.find(centred) + centred.size()));
  CHECK(font > 4);
  CHECK(font < 10);
}

TEST_CASE("every title, unit, name and key of lines is text in the SVG") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string path = folder.file("lines.svg");
  LinePlot plot = two_units();
  write_picture(path, line_plot_script(plot, PictureFormat::kSvg));
  const std::string apart = text_of(read_file(path));
  for (const char* word : {"one against all", "Target", "m01", "m02", "m03", "Mean absolute difference",
                           "RMS difference", "kT/e", "RMSD (\u00C5)", "hollow points: not trustworthy"})
    CHECK_MESSAGE(contains(apart, word), std::string(word));
  CHECK_FALSE(contains(read_file(path), "scale(0.00)"));  // which readers of SVG refuse
  plot.normalized = true;
  write_picture(path, line_plot_script(plot, PictureFormat::kSvg));
  const std::string together = text_of(read_file(path));
  CHECK(contains(together, "Mean absolute difference (0: 1 kT/e, 1: 3 kT/e)"));
  CHECK(contains(together, "RMSD (0: 0.5 \u00C5, 1: 1.5 \u00C5)"));
  CHECK(contains(together, "Normalized"));
}

TEST_CASE("a PNG has the size of its layout, and trajectories have numbers on their axis") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  LinePlot plot = two_units();
  plot.labels.clear();
  plot.groups.clear();
  plot.x = {0, 50, 100};
  plot.x_title = "Frame";
  const std::string png = folder.file("lines.png"), svg = folder.file("lines.svg");
  write_picture(png, line_plot_script(plot, PictureFormat::kPng));
  const std::string bytes = read_file(png);
  CHECK(bytes.substr(1, 3) == "PNG");
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i])); };
  CHECK(byte(18) * 256 + byte(19) == 3 * 520);
  write_picture(svg, line_plot_script(plot, PictureFormat::kSvg));
  CHECK(contains(text_of(read_file(svg)), "Frame"));
  CHECK(contains(text_of(read_file(svg)), "100"));
}

TEST_CASE("a title that is longer than its panel stands above it") {
  LinePlot plot;
  plot.x = {0, 1, 2};
  plot.series = {{"Mean absolute difference", "kT/e", {1, 2, 3}, {}}, {"RMSD", "A", {1, 2, 3}, {}}};
  const std::string two = line_plot_script(plot, PictureFormat::kSvg);
  CHECK(contains(two, "title \"Mean absolute difference (kT/e)\""));
  CHECK(!contains(two, "set label 4 \"Mean"));
  CHECK(contains(two, "set label 4 \"RMSD (A)\""));
  plot.series.pop_back();  // the only panel is higher
  CHECK(contains(line_plot_script(plot, PictureFormat::kSvg), "set label 4 \"Mean absolute difference (kT/e)\""));
}

TEST_CASE("the colour range excludes the diagonal and is symmetric for signed values") {
  HeatMap map = four();
  CHECK(drawn_range(map).first == 1);
  CHECK(drawn_range(map).second == 8);
  map.diverging = true;
  CHECK(drawn_range(map).first == -8);
  map.low = -2;
  map.high = 3;
  CHECK(drawn_range(map).first == -2);
  map.low = 4;
  CHECK(contains(message_of([&] { heat_map_script(map, PictureFormat::kSvg); }), "from 4 down to 3"));
  map.low = map.high = 0;
  map.values.assign(16, kNan);
  CHECK(contains(message_of([&] { heat_map_script(map, PictureFormat::kSvg); }), "there is nothing to draw"));
}

TEST_CASE("a dendrogram orders rows and columns and is labelled") {
  HeatMap map = four();
  map.dendrogram = {{0, 2, 1}, {4, 3, 2}, {5, 1, kNan}};
  map.dendrogram_title = "clustered by RMSD";
  CHECK(drawing_order(map) == std::vector<std::size_t>{0, 2, 3, 1});
  const std::string script = heat_map_script(map, PictureFormat::kSvg);
  CHECK(contains(script, "; clustered by RMSD"));
  // Row of thing 2, column of thing 3 has no value; that of 3 and 1 is 3.5, in row 2 and column 3.
  CHECK(contains(script, "\n3 2 3.5\n"));
  CHECK_FALSE(contains(script, "\n2 1 "));
  if (!has_gnuplot()) return;
  CHECK(contains(text_of(run_gnuplot(script)), "clustered by RMSD"));
}

TEST_CASE("only neighbours of one group share a frame") {
  const std::string script = heat_map_script(four(), PictureFormat::kSvg);
  std::size_t n = 0;
  for (std::size_t at = 0; (at = script.find("linewidth 1.8", at)) != std::string::npos; ++at) ++n;
  CHECK(n == 1);
  CHECK(contains(script, "from -0.5,-0.5 to 1.5,1.5 front"));
}

TEST_CASE("the sequential colours step evenly in lightness") {
  // Relative luminance to CIE L*.
  const auto lightness = [](double t) {
    const Rgb c = sequential_colour(t);
    const auto linear = [](double v) {
      v /= 255;
      return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    return 116 * std::cbrt(0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue)) - 16;
  };
  for (int i = 0; i < 10; ++i)
    CHECK(lightness(0.1 * i) - lightness(0.1 * (i + 1)) == doctest::Approx(6.7).epsilon(0.1));
}

TEST_CASE("texts with any content are strings to gnuplot") {
  CHECK(gnuplot_string("a\"b\\c`d\ne") == "\"a\\\"b\\\\c\\`d e\"");
  CHECK(gnuplot_number(kNan) == "NaN");
  CHECK(gnuplot_number(0.1) == "0.1");
}

TEST_CASE("invalid plots are refused with the reason and leave no file") {
  const ScratchFolder folder;
  CHECK(contains(message_of([] { picture_format("a.pdf"); }), "ends in .png or .svg"));
  LinePlot plot = two_units();
  plot.series[0].values = {kNan, kNan, kNan};
  CHECK(contains(message_of([&] { line_plot_script(plot, PictureFormat::kSvg); }), "has no values"));
  plot.series.clear();
  CHECK(contains(message_of([&] { line_plot_script(plot, PictureFormat::kSvg); }), "no metric"));
  if (!has_gnuplot()) return;
  const std::string message = message_of([&] { write_picture(folder.file("x.svg"), "set no_such_thing\n"); });
  CHECK(contains(message, "gnuplot could not draw (exit status 1); version 5.2 or later with its terminals pngcairo"));
  CHECK(!contains(message, "no_such_thing"));
  CHECK(folder.n_files() == 0);
}

TEST_CASE("without gnuplot the message says what to install") {
  const std::string before = std::getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  const std::string message = message_of([] { run_gnuplot("plot x\n"); });
  setenv("PATH", before.c_str(), 1);
  CHECK(contains(message, "gnuplot, which is not installed"));
  CHECK(contains(message, "gnuplot-nox"));
}

TEST_SUITE_END();
