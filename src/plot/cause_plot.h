// cause_plot.h: plots what residues add to readings as bars.
#pragma once

#include <string>
#include <vector>

#include "plot/gnuplot.h"

namespace espdiff {

struct CauseBar {
  std::string label;
  double value = 0;
  bool is_uncertain = false;  ///< drawn pale: the residue's place is poorly known
};

/// One reading: a panel of bars, the first at the top.
struct CausePanel {
  std::string title, unit;
  std::vector<CauseBar> bars;
};

/// The gnuplot script of the panels, above each other: red for bars to the left (negative), blue to the right, as the
/// surfaces' colours are.
/// @throws InputError (no panels, a panel without bars, a value that is not finite)
std::string cause_plot_script(const std::vector<CausePanel>& panels, PictureFormat format);

}  // namespace espdiff
