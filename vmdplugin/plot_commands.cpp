// plot_commands.cpp: plot_lines draws lines into a file, as the command line's `espdiff plot` does.
#include <cmath>

#include "commands.h"
#include "plot/line_plot.h"
#include "tcl_values.h"

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

}  // namespace

std::vector<Command> plot_commands() { return {{"plot_lines", 2, 2, "file plot", plot_lines}}; }

}  // namespace espdiff::vmdplugin
