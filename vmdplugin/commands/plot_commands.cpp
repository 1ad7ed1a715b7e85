// plot_commands.cpp: plot_lines draws lines into a file, as the command line's `espdiff plot` does.
#include <cmath>

#include "base/error.h"
#include "commands.h"
#include "io/files/read_csv.h"
#include "plot/line_plot.h"
#include "trajectory/residue_plot.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

/// The list under `key`; empty without it.
std::vector<Tcl_Obj*> list_of(DictReader& reader, const char* key) {
  Tcl_Obj* const value = reader.find(key);
  return value == nullptr ? std::vector<Tcl_Obj*>() : to_vector(value, std::string("plot ") + key);
}

/// An empty string has no value.
std::vector<double> numbers(const std::vector<Tcl_Obj*>& values, const std::string& what) {
  std::vector<double> result;
  result.reserve(values.size());
  for (Tcl_Obj* const value : values) result.push_back(to_string(value).empty() ? NAN : to_double(value, what));
  return result;
}

LineSeries line_series(Tcl_Obj* dict) {
  DictReader reader(dict, "series");
  LineSeries series{reader.text("title"), reader.text("unit"), {}, {}};
  series.values = numbers(list_of(reader, "values"), "'" + series.title + "'");
  reader.finish();
  return series;
}

Tcl_Obj* plot_lines(const Call& call) {
  const std::string path = call.text(0);
  const PictureFormat format = picture_format(path);
  DictReader reader(call.arguments[1], "plot");
  LinePlot plot;
  plot.title = reader.text("title");
  plot.x_title = reader.text("x_title");
  plot.normalized = reader.boolean("normalize", false);
  plot.x = numbers(list_of(reader, "x"), "x");
  for (Tcl_Obj* const label : list_of(reader, "labels")) plot.labels.push_back(to_string(label));
  for (Tcl_Obj* const trust : list_of(reader, "trustworthy")) plot.trustworthy.push_back(to_bool(trust, "trustworthy"));
  for (Tcl_Obj* const series : list_of(reader, "series")) plot.series.push_back(line_series(series));
  reader.finish();
  write_picture(path, line_plot_script(plot, format));
  return to_obj(path);
}

/// FILE TABLE: draws a trajectory's table of residues.
Tcl_Obj* plot_residues(const Call& call) {
  const std::string path = call.text(0);
  const PictureFormat format = picture_format(path);
  write_picture(path, frame_map_script(residue_map(read_csv(call.text(1))), format));
  return to_obj(path);
}

Tcl_Obj* has_residue_table(const Call& call) { return to_obj(is_residue_table(read_csv(call.text(0)))); }

/// FILE: {title T unit U frames LIST residues LIST partners LIST rows LIST low L high H}, a row for each residue that
/// has a value, each a list by frame, empty where it has none. Partners are the target's names of the residues; no list
/// where they are the same.
Tcl_Obj* read_residue_map(const Call& call) {
  const CsvTable table = read_csv(call.text(0));
  if (!is_residue_table(table))
    throw FormatError(table.path, 1, "this is not a trajectory's table of residues; give another file");
  const FrameMap map = residue_map(table);
  std::vector<Tcl_Obj*> frames, rows;
  for (const int frame : map.frames) frames.push_back(to_obj(frame));
  for (std::size_t row = 0; row < map.labels.size(); ++row) {
    std::vector<Tcl_Obj*> values;
    for (std::size_t column = 0; column < map.frames.size(); ++column) {
      const double value = map.values[row * map.frames.size() + column];
      values.push_back(std::isfinite(value) ? to_obj(value) : Tcl_NewObj());
    }
    rows.push_back(to_list(values));
  }
  const auto [low, high] = drawn_range(map);
  return to_dict({{"title", to_obj(map.title)},
                  {"unit", to_obj(map.unit)},
                  {"frames", to_list(frames)},
                  {"residues", to_list(map.labels)},
                  {"partners", to_list(map.partners)},
                  {"rows", to_list(rows)},
                  {"low", to_obj(low)},
                  {"high", to_obj(high)}});
}

}  // namespace

std::vector<Command> plot_commands() {
  return {{"plot_lines", 2, 2, "file plot", plot_lines},
          {"plot_residues", 2, 2, "file table", plot_residues},
          {"residue_map", 1, 1, "table", read_residue_map},
          {"is_residue_table", 1, 1, "file", has_residue_table}};
}

}  // namespace espdiff::vmdplugin
