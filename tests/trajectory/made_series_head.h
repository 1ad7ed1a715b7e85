// made_series_head.h: the head of the series files that tests write.
#pragma once

#include "trajectory/series_csv.h"

namespace espdiff_test {

inline const espdiff::SeriesHead kSeriesHead = {{"espdiff", "1"}, {"frames", "all"}, {"settings", ""}};

}  // namespace espdiff_test
