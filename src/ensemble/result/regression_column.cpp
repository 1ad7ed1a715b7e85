// regression_column.cpp: which value of a table belongs to which replicate.
#include "ensemble/result/regression_column.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/files/read_csv.h"

namespace espdiff {

RegressionColumn read_regression_column(const std::string& text, const EnsemblePlan& plan) {
  const std::size_t sign = text.rfind(':');
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size())
    throw InputError(option("regress", text) + " is not FILE.csv:COLUMN, such as activities.csv:log_kcat");
  const CsvTable table = read_csv(text.substr(0, sign));
  RegressionColumn column{text.substr(sign + 1),
                          std::vector<double>(plan.replicates.size(), std::numeric_limits<double>::quiet_NaN())};
  const std::size_t value = table.require(column.name), name = table.require("replicate");
  const int group = table.find("group");
  std::vector<char> seen(plan.replicates.size(), 0);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string& replicate = table.rows[row][name];
    const std::string in_group = group < 0 ? std::string() : table.rows[row][static_cast<std::size_t>(group)];
    const auto is_it = [&](const EnsembleReplicate& r) {
      return r.name == replicate && (group < 0 || r.group == in_group);
    };
    const auto n = std::count_if(plan.replicates.begin(), plan.replicates.end(), is_it);
    const std::string what = group < 0 ? replicate : in_group + ", " + replicate;
    if (n != 1)
      throw FormatError(table.path, table.lines[row],
                        "'" + what +
                            (n == 0 ? "' is no replicate of this ensemble; there are "
                                    : "' are several; give the column group; there are ") +
                            plan.replicates.front().group + ", " + plan.replicates.front().name + " and " +
                            std::to_string(plan.replicates.size() - 1) + " others");
    const auto r = static_cast<std::size_t>(std::find_if(plan.replicates.begin(), plan.replicates.end(), is_it) -
                                            plan.replicates.begin());
    if (seen[r] != 0) throw FormatError(table.path, table.lines[row], "'" + what + "' stands here a second time");
    seen[r] = 1;
    column.values[r] = table.number(row, value);
  }
  return column;
}

}  // namespace espdiff
