// cause_plot.cpp: horizontal bars with their labels on the left.
#include "plot/cause_plot.h"

#include <cmath>
#include <sstream>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr double kPlotWidth = 460, kBarHeight = 15, kPanelFrame = 70;  // points

void check_panels(const std::vector<CausePanel>& panels) {
  if (panels.empty()) throw InputError("there is nothing to draw: no reading");
  for (const CausePanel& panel : panels) {
    if (panel.bars.empty()) throw InputError("there is nothing to draw: '" + panel.title + "' has no residues");
    for (const CauseBar& bar : panel.bars) {
      if (!std::isfinite(bar.value)) throw InputError("'" + bar.label + "' has a value that is not finite");
    }
  }
}

void add_panel(std::ostream& out, const CausePanel& panel, double top, double bottom) {
  out << "set tmargin at screen " << gnuplot_number(top) << "\nset bmargin at screen " << gnuplot_number(bottom)
      << "\nset title " << gnuplot_string(panel.title) << " offset 0,-0.5\nset xlabel " << gnuplot_string(panel.unit)
      << "\nset yrange [" << panel.bars.size() << ":-1]\nset ytics scale 0 (";
  for (std::size_t i = 0; i < panel.bars.size(); ++i)
    out << (i == 0 ? "" : ", ") << gnuplot_tic(panel.bars[i].label) << ' ' << i;
  out << ")\nunset object\n";
  for (std::size_t i = 0; i < panel.bars.size(); ++i) {
    const CauseBar& bar = panel.bars[i];
    const double row = static_cast<double>(i);
    out << "set object rectangle from 0," << gnuplot_number(row - 0.35) << " to " << gnuplot_number(bar.value) << ','
        << gnuplot_number(row + 0.35) << " fillcolor rgb '" << (bar.value < 0 ? "#b2182b" : "#2166ac") << "' fillstyle "
        << (bar.is_uncertain ? "transparent solid 0.35" : "solid 1") << " noborder\n";
  }
  out << "plot '-' using 1:2 with points pointsize 0 notitle\n";
  for (std::size_t i = 0; i < panel.bars.size(); ++i) out << gnuplot_number(panel.bars[i].value) << ' ' << i << '\n';
  out << "0 0\ne\n";
}

}  // namespace

std::string cause_plot_script(const std::vector<CausePanel>& panels, PictureFormat format) {
  check_panels(panels);
  double height = 0;
  for (const CausePanel& panel : panels) height += kPanelFrame + kBarHeight * static_cast<double>(panel.bars.size());
  std::ostringstream out;
  out << picture_head(format, {kPlotWidth, height, 3}) << "set multiplot\nset lmargin at screen 0.42\n"
      << "set rmargin at screen 0.97\nset border 1\nset xtics nomirror\nset arrow 1 from 0, graph 0 to 0, graph 1 "
         "nohead linecolor rgb '"
      << kInk << "'\n";
  double from_top = 0;
  for (const CausePanel& panel : panels) {
    const double first = from_top + 0.4 * kPanelFrame,
                 last = first + kBarHeight * static_cast<double>(panel.bars.size());
    add_panel(out, panel, 1 - first / height, 1 - last / height);
    from_top += kPanelFrame + kBarHeight * static_cast<double>(panel.bars.size());
  }
  out << "unset multiplot\n";
  return out.str();
}

}  // namespace espdiff
