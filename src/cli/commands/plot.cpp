// plot.cpp: `espdiff plot FILE -o OUT.svg`.
#include "cli/commands/plot.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "base/error.h"
#include "base/formatted.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/plot_pair.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "io/files/check_outputs.h"
#include "io/files/read_csv.h"
#include "io/text/text_cursor.h"
#include "matrix/read_matrix.h"
#include "plot/cause_plot.h"
#include "plot/heat_map.h"
#include "plot/line_plot.h"
#include "report/records/metrics.h"
#include "report/sections/field_json.h"
#include "trajectory/residue_plot.h"

namespace espdiff::cli {
namespace {

struct PlotArguments {
  std::string input, output, source, order = "given", x, title, field, kind = "bars";
  int top = 20;
  std::vector<std::string> metrics, range_of;
  std::vector<double> range;
  bool both_ways = false, normalize = false, no_marks = false, causes = false, overwrite = false;
};

/// Its numbers and words.
const std::vector<OptionRow<PlotArguments>>& plot_settings() {
  using Rows = RowsOf<PlotArguments>;
  static const std::vector<Rows::Row> all{
      Rows::word(
          "kind", "Comparison", {"bars", "scatter"}, [](auto& o) -> auto& { return o.kind; },
          "Residues of a comparison as signed bars with both states, or as a scatter"),
      Rows::count(
          "top", "Comparison", {0, 100000}, [](auto& o) -> auto& { return o.top; },
          "Number of residues as bars, those that differ most; 0 for all, in file order"),
      Rows::word(
          "order", "Heat map", {"given", "dendrogram"}, [](auto& o) -> auto& { return o.order; },
          "Order of a heat map; dendrogram draws the clustering too")};
  return all;
}

constexpr const char* kAngstrom = "\u00C5";

/// Units as printed; fractions as percent.
struct Quantity {
  std::string title, unit;
  double factor = 1;
};

/// @param fields whose columns there are
Quantity quantity_of(const std::string& name, const std::string& potential_unit,
                     const std::vector<espdiff::Quantity>& fields = {}) {
  const Metric* const metric = metric_of_column(name, fields);
  if (metric == nullptr) return {name, "", 1};
  const ShownUnit shown = shown_unit(*metric, potential_unit);
  if (metric->unit == MetricUnit::kAngstrom) return {metric->label, kAngstrom, 1};
  if (metric->unit == MetricUnit::kSquareAngstrom) return {metric->label, std::string(kAngstrom) + "\u00B2", 1};
  return {metric->label, shown.unit, shown.factor};
}

/// Of a matrix, whose file names what this version does not know.
Quantity quantity_in(const MatrixFileMetric& metric) {
  const Quantity known = quantity_of(metric.name, metric.unit);
  return known.title == metric.name ? Quantity{metric.title, metric.unit, 1} : known;
}

bool is_antisymmetric(const std::string& name) {
  const Metric* const metric = metric_of_column(name);
  return metric != nullptr && (metric->flags & kAntisymmetric) != 0;
}

std::string only_metric(const PlotArguments& a, const std::string& otherwise) {
  if (a.metrics.size() > 1) throw InputError("a heat map shows one metric; name one, or one variant by --source");
  return a.metrics.empty() ? otherwise : a.metrics.front();
}

/// Ends of the colours; equal if none were chosen.
std::pair<double, double> chosen_range(const PlotArguments& a) {
  if (a.range.empty()) return {0, 0};
  if (!(a.range[0] < a.range[1])) throw InputError("--range: the lower end comes first, and both differ");
  return {a.range[0], a.range[1]};
}

HeatMap heat_map(const PlotArguments& a, const MatrixFile& matrix) {
  const MatrixFileMetric& metric = matrix.metric(only_metric(a, matrix.clustered_by));
  const Quantity quantity = quantity_in(metric);
  HeatMap map;
  map.labels = matrix.labels;
  map.groups = matrix.groups;
  map.values = metric.values;
  for (double& value : map.values) value *= quantity.factor;
  map.title = quantity.title;
  map.unit = quantity.unit;
  map.diverging = is_antisymmetric(metric.name);
  std::tie(map.low, map.high) = chosen_range(a);
  for (std::size_t at = 0; !a.no_marks && at < map.values.size(); ++at)
    map.marked.push_back(std::isfinite(map.values[at]) && !matrix.trustworthy[at]);
  if (std::count(map.marked.begin(), map.marked.end(), true) > 0) map.mark_title = "not trustworthy";
  if (a.order == "dendrogram") {
    for (const ClusterMerge& merge : matrix.merges) map.dendrogram.push_back({merge.left, merge.right, merge.distance});
    map.dendrogram_title = "clustered by " + lower_case(quantity_of(matrix.clustered_by, "").title);
  }
  return map;
}

/// One variant as the source against all others; with both_ways the mean of both directions, with bars that reach to
/// each.
LinePlot one_against_all(const PlotArguments& a, const MatrixFile& matrix) {
  const std::size_t n = matrix.n(), one = matrix.find(a.source);
  LinePlot plot;
  plot.x_title = a.both_ways ? "Variant" : "Target";
  plot.title = a.title.empty() ? matrix.labels[one] + " against all others" : a.title;
  for (std::size_t other = 0; other < n; ++other) {
    if (other == one) continue;
    plot.labels.push_back(matrix.labels[other]);
    plot.groups.push_back(matrix.groups[other]);
    plot.trustworthy.push_back(matrix.trustworthy[one * n + other] &&
                               (!a.both_ways || matrix.trustworthy[other * n + one]));
  }
  const std::vector<std::string> names = a.metrics.empty() ? std::vector<std::string>{matrix.clustered_by} : a.metrics;
  for (const std::string& name : names) {
    const MatrixFileMetric& metric = matrix.metric(name);
    const Quantity quantity = quantity_in(metric);
    const double sign = is_antisymmetric(name) ? -1 : 1;
    LineSeries series{quantity.title, quantity.unit, {}, {}};
    for (std::size_t other = 0; other < n; ++other) {
      if (other == one) continue;
      const double there = quantity.factor * metric.values[one * n + other];
      const double back = sign * quantity.factor * metric.values[other * n + one];
      series.values.push_back(a.both_ways ? 0.5 * (there + back) : there);
      if (a.both_ways) series.errors.push_back(0.5 * std::fabs(there - back));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// The potentials' unit, from any row that has one.
std::string potential_unit_of(const CsvTable& table) {
  const int column = table.find("potential_unit");
  for (const auto& row : table.rows) {
    if (column >= 0 && !row[static_cast<std::size_t>(column)].empty()) return row[static_cast<std::size_t>(column)];
  }
  return "";
}

/// Columns of a table along another column, such as the frames of a trajectory. A column NAME_error gives NAME error
/// bars.
LinePlot along_table(const PlotArguments& a, const CsvTable& table) {
  if (!a.source.empty() || a.both_ways)
    throw InputError("--source and --both-ways need a matrix; give its OUT.json instead of " + table.path);
  if (is_matrix_table(table))
    throw InputError(table.path + ": a matrix is drawn from its JSON file, and there is no " +
                     matrix_json_of(table.path) + "; give that file");
  if (table.rows.empty()) throw FormatError(table.path, 0, "there are no rows to draw");
  const std::string x_name = a.x.empty() ? (table.find("frame") >= 0 ? "frame" : table.columns.front()) : a.x;
  const std::size_t x = table.require(x_name);
  LinePlot plot;
  plot.x_title = x_name == "frame" ? "Frame" : x_name;
  double ignored = 0;
  const bool numbers =
      std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) { return parse_number(row[x], ignored); });
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (numbers) plot.x.push_back(table.number(row, x));
    if (!numbers) plot.labels.push_back(table.rows[row][x]);
  }
  if (const int trust = table.find("trustworthy"); trust >= 0 && !a.no_marks) {
    for (const auto& row : table.rows) plot.trustworthy.push_back(row[static_cast<std::size_t>(trust)] != "0");
  }
  const std::string unit = potential_unit_of(table);
  const std::vector<espdiff::Quantity> fields = fields_in_head(table.comments);
  std::vector<std::string> names = a.metrics;
  if (names.empty()) names = {unit.empty() ? "mean_displacement_A" : "mean_abs_difference"};
  for (const std::string& name : names) {
    const Quantity quantity = quantity_of(name, unit, fields);
    LineSeries series{quantity.title, quantity.unit, {}, {}};
    const std::size_t column = table.require(name);
    const int error = table.find(name + "_error");
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      series.values.push_back(quantity.factor * table.number(row, column));
      if (error >= 0) series.errors.push_back(quantity.factor * table.number(row, static_cast<std::size_t>(error)));
    }
    plot.series.push_back(std::move(series));
  }
  plot.title = a.title;
  return plot;
}

HeatMap heat_map_of(const PlotArguments& a, const PlotInput& input) {
  if (!input.is_json) throw InputError(input.path + ": is no matrix; --range-of takes results of one kind");
  return heat_map(a, read_matrix_json(input.path));
}

StatePlot states_of(const PlotArguments& a, const PlotInput& input) {
  if (input.is_json || !is_pair_table(input.table))
    throw InputError(input.path + ": is no comparison's; --range-of takes results of one kind");
  return state_plot(input.table, a.kind == "bars", static_cast<std::size_t>(a.top), a.title, a.field);
}

StatePlot groups_of(const PlotArguments& a, const PlotInput& input) {
  if (input.is_json || !is_ensemble_table(input.table))
    throw InputError(input.path + ": is no ensemble's; --range-of takes results of one kind");
  return group_plot(input.table, a.kind == "bars", static_cast<std::size_t>(a.top), a.title);
}

FrameMap frame_map_of(const PlotArguments&, const PlotInput& input) {
  if (input.is_json || !is_residue_table(input.table))
    throw InputError(input.path + ": is no trajectory's table of residues; --range-of takes results of one kind");
  return residue_map(input.table);
}

/// The plot of a result, with the widest range of it and of the others, which are drawn alike.
template <typename Plot>
Plot with_shared_range(const PlotArguments& a, const PlotInput& input,
                       Plot (*plot_of)(const PlotArguments&, const PlotInput&)) {
  Plot plot = plot_of(a, input);
  if (a.range_of.empty()) return plot;
  if (!a.range.empty()) throw InputError(kTwoRanges);
  auto [low, high] = drawn_range(plot);
  for (const std::string& given : a.range_of) {
    const PlotInput other = plot_input(given);
    const Plot alike = plot_of(a, other);
    if (alike.unit != plot.unit)
      throw InputError(other.path + ": in '" + alike.unit + "', and " + input.path + " in '" + plot.unit +
                       "'; results that share a scale have one unit");
    const auto range = drawn_range(alike);
    low = std::min(low, range.first);
    high = std::max(high, range.second);
  }
  plot.low = low;
  plot.high = high;
  return plot;
}

/// What the options of other plots would do here is refused.
void refuse_others(const PlotArguments& a, const PlotInput& input) {
  const bool has_lines = a.normalize || !a.metrics.empty() || !a.x.empty();
  if (input.is_json) return;
  if (is_pair_table(input.table)) {
    if (has_lines || !a.range.empty())
      throw InputError("--normalize, --metric, --x and --range are of other tables, and " + input.path +
                       " is one of a comparison's residues");
    return;
  }
  if (is_residue_table(input.table) && has_lines)
    throw InputError("--normalize, --metric and --x are for lines, and " + input.path + " is a table of residues");
  if (is_cause_table(input.table) && (has_lines || !a.range.empty() || !a.range_of.empty()))
    throw InputError("--normalize, --metric, --x, --range and --range-of are of other tables, and " + input.path +
                     " is one of causes");
}

/// The gnuplot script of a file.
std::string plot_script(const PlotArguments& a, const PlotInput& input, PictureFormat format) {
  refuse_others(a, input);
  if (input.is_json && a.source.empty()) {
    if (a.normalize || a.both_ways) throw InputError("--normalize and --both-ways are for lines; name one --source");
    return heat_map_script(with_shared_range(a, input, heat_map_of), format);
  }
  if (!input.is_json && is_pair_table(input.table)) {
    const StatePlot plot = with_shared_range(a, input, states_of);
    return a.kind == "bars" ? state_bars_script(plot, format) : state_scatter_script(plot, format);
  }
  if (!input.is_json && is_ensemble_table(input.table) && a.metrics.empty() && a.x.empty() && a.field.empty()) {
    if (a.normalize || !a.range.empty())
      throw InputError("--normalize and --range are of other tables, and " + input.path +
                       " is one of an ensemble's residues");
    const StatePlot plot = with_shared_range(a, input, groups_of);
    return a.kind == "bars" ? state_bars_script(plot, format) : state_scatter_script(plot, format);
  }
  if (!a.field.empty())
    throw InputError("--field is of a comparison's residues, and " + input.path + " is no table of them");
  if (!input.is_json && is_residue_table(input.table)) {
    FrameMap map = with_shared_range(a, input, frame_map_of);
    if (!a.range.empty()) std::tie(map.low, map.high) = chosen_range(a);
    return frame_map_script(map, format);
  }
  if (!input.is_json && is_cause_table(input.table)) return cause_plot_script(cause_panels(input.table), format);
  if (!a.range.empty() || !a.range_of.empty() || a.order != "given")
    throw InputError(
        "--range, --range-of and --order are for heat maps; leave out --source, and give a matrix's OUT.json");
  LinePlot plot = input.is_json ? one_against_all(a, read_matrix_json(input.path)) : along_table(a, input.table);
  if (a.no_marks) plot.trustworthy.clear();
  plot.normalized = a.normalize;
  return line_plot_script(plot, format);
}

int plot_verb(const PlotArguments& a, const Context&) {
  const PictureFormat format = picture_format(a.output);
  const PlotInput input = plot_input(a.causes ? cause_table_of(a.input) : a.input);
  std::vector<std::string> inputs = {input.path};
  for (const std::string& other : a.range_of) inputs.push_back(file_to_plot(other));
  check_outputs(inputs, {a.output}, a.overwrite);
  write_picture(a.output, plot_script(a, input, format));
  return 0;
}

}  // namespace

void plot_frames(const std::string& table, const std::string& picture) {
  PlotArguments a;
  a.input = table;
  a.output = picture;
  a.overwrite = true;  // as the trajectory has found it may
  plot_verb(a, {});
}

Verb add_plot(CLI::App& app) {
  auto a = std::make_shared<PlotArguments>();
  CLI::App* parser =
      app.add_subcommand("plot", "Draw a matrix, one variant against all, or a trajectory and its residues");
  parser->footer(
      "OUT.json of a matrix becomes a heat map, with --source a plot of one variant against all others; a CSV file, "
      "such as "
      "a\ntrajectory's, becomes lines along its frames, and its table of residues a map, a row a residue. A "
      "comparison becomes bars\nof its residues, with --causes of those whose charges make the difference. "
      "Drawn by gnuplot; text stays text in an SVG.");
  parser->add_option("FILE", a->input, "A result: its prefix OUT, OUT.json, OUT.vtp, or a CSV file")->required();
  parser->add_option("-o,--output", a->output, "Picture to write (.png or .svg)")->required();
  add_overwrite(*parser, a->overwrite);
  parser->add_option("--metric", a->metrics,
                     "Columns to draw; several for lines (default: the clustering metric; for a "
                     "trajectory mean_abs_difference)");
  parser->add_option("--title", a->title, "Title of a plot of lines");
  parser->add_option("--field", a->field, "Residues of a comparison: a field in the place of the potential");
  add_rows(*parser, plot_settings(), *a);
  parser
      ->add_flag(
          "--causes", a->causes,
          "The residues that make a comparison's difference, as bars for each of its readings (compare --causes)")
      ->group("Comparison");
  parser->add_option("--range", a->range, "Ends of the colours (default: range off the diagonal)")
      ->expected(2)
      ->group("Heat map");
  add_range_of(*parser, a->range_of);
  parser->add_option("--source", a->source, "Label of the variant to draw against all others")->group("Lines");
  parser->add_flag("--both-ways", a->both_ways, "Mean of both directions, with bars that reach to each")
      ->group("Lines");
  parser->add_flag("--normalize", a->normalize, "Scale each metric from its minimum, 0, to its maximum, 1")
      ->group("Lines");
  parser->add_option("--x", a->x, "Column of a CSV file that is the x axis (frame)")->group("Lines");
  parser->add_flag("--no-marks", a->no_marks, "Do not mark results that are not trustworthy");
  set_help(*parser, {"",
                     {"espdiff plot ldh -o ldh.svg", "espdiff plot ldh --kind scatter -o scatter.svg",
                      "espdiff plot ubiquitin.json --order dendrogram -o map.svg",
                      "espdiff plot ubiquitin.json --source m00 --metric mean_abs_difference --normalize -o m00.png",
                      "espdiff plot adk.csv --metric mean_displacement_A --metric rmsd_A -o adk.svg",
                      "espdiff plot adk.residues.csv -o residues.png", "espdiff plot ldh --causes -o causes.svg"}});
  return {parser, [a](const Context& context) { return plot_verb(*a, context); }};
}

}  // namespace espdiff::cli
