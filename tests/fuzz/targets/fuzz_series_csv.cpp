// fuzz_series_csv.cpp: the rows of a trajectory that is resumed. Behind the line of columns, unless an input begins
// with
// '#' or 'f', which is then the whole file.
#include <fstream>

#include "fuzz/fuzz_file.h"
#include "trajectory/series_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Locked and written beside it, hence no file in memory.
  static const std::string path = "/dev/shm/espdiff-fuzz-" + std::to_string(getpid()) + ".csv";
  std::string text;
  if (size == 0 || (data[0] != '#' && data[0] != 'f')) {
    for (const std::string& column : espdiff::series_columns()) text += (text.empty() ? "" : ",") + column;
    text += '\n';
  }
  std::ofstream(path, std::ios::binary) << text << espdiff_fuzz::bytes_of(data, size);
  try {
    const espdiff::SeriesCsv csv(path, {{"source", "a.pqr"}}, espdiff::ExistingFile::kResume);
    for (const espdiff::SeriesRow& row : csv.rows()) row.has_mapping();
  } catch (const espdiff::Error& error) {
    if (std::string(error.what()).find(path) == std::string::npos) std::abort();
  }
  unlink(path.c_str());
  return 0;
}
