// fuzz_csv.cpp: tables: lists of variants, groups, trajectories.
#include "fuzz/fuzz_file.h"
#include "io/files/read_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::CsvTable table = espdiff::read_csv(path);
    for (const auto& row : table.rows) {
      if (row.size() != table.columns.size()) std::abort();
    }
  });
}
