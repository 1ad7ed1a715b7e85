// compare_pair.cpp: a comparison by the library, as another program calls it.
// Usage: compare_pair SOURCE.pqr SOURCE.dx TARGET.pqr TARGET.dx OUT
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "base/types.h"
#include "certificate/result.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/grids/read_grid.h"
#include "io/structures/structure_file.h"
#include "mapping/input.h"
#include "options/options.h"
#include "report/records/metrics.h"
#include "report/sections/provenance.h"
#include "report/write_compare.h"

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  try {
    const espdiff::Molecule source = espdiff::read_structure(argv[1]), target = espdiff::read_structure(argv[3]);
    const espdiff::Grid source_map = espdiff::read_grid(argv[2]), target_map = espdiff::read_grid(argv[4]);
    const std::unique_ptr<espdiff::Engine> engine = espdiff::select_engine(espdiff::parse_device("cpu"), 2);
    espdiff::CompareInput from, to;
    from.molecule = &source;
    from.map = &source_map;
    to.molecule = &target;
    to.map = &target_map;
    const espdiff::CompareOptions options;
    const espdiff::CompareResult result = espdiff::compare(*engine, from, to, options, espdiff::Progress());
    const espdiff::Metric& metric = *espdiff::find_metric_or_null("mean_abs_difference");
    std::printf("%.6g\n", espdiff::value_of(metric, result));
    espdiff::Provenance provenance;
    provenance.device = engine->back_end();
    espdiff::write_compare(argv[5], source, target, result, options, provenance);
    return 0;
  } catch (const espdiff::Error& error) {
    std::fprintf(stderr, "compare_pair: %s\n", error.what());
    return 1;
  }
}
