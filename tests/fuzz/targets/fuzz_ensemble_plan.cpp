// fuzz_ensemble_plan.cpp: the description of the run (JSON) inside an ensemble's HDF5 file.
#include "ensemble/frames/ensemble_plan.h"
#include "fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const espdiff::EnsemblePlan plan = espdiff::parse_ensemble_plan(espdiff_fuzz::bytes_of(data, size), "a.h5");
    const espdiff::EnsemblePlan same = espdiff::parse_ensemble_plan(espdiff::plan_text(plan), "a.h5");
    if (!espdiff::plan_difference(plan, same).empty()) std::abort();
    const std::size_t n = plan.n_frames();
    if (n > 0) plan.name_of(n - 1);
    plan.groups();
    espdiff::design_warning(plan);
  } catch (const espdiff::Error& error) {
    if (std::string(error.what()).find("a.h5") == std::string::npos) std::abort();
  }
  return 0;
}
