// plot.h: what a trajectory draws by itself.
#pragma once

#include <string>

namespace espdiff::cli {

/// As `espdiff plot TABLE -o PICTURE`, of a trajectory's table.
/// @throws as line_plot_script(), write_picture()
void plot_frames(const std::string& table, const std::string& picture);

}  // namespace espdiff::cli
