// ensemble_object.h: an ensemble's handle: its run and its answer. Only builds with HDF5 have it.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/ensemble_study.h"
#include "frame_exchange.h"
#include "handles.h"

namespace espdiff::vmdplugin {

/// Groups of simulations, through one template.
struct EnsembleObject : Object {
  const char* kind() const override { return "ensemble"; }
  Computation computation;
  EnsembleStudy study;
  FrameExchange frames;                // of molecules in VMD
  const Progress* progress = nullptr;  // the job's, while it runs
  std::vector<std::string> warnings;   ///< of the design, before the run
  EnsembleAnswer answer;
  // Of drawings, made when first needed.
  mutable std::map<std::string, std::vector<std::uint8_t>> untested;  // by field, empty for the potential: [triangle]
  mutable std::map<std::pair<std::string, int>, std::vector<float>> faded;  // by field and patch, 0 for all: [vertex]
};

}  // namespace espdiff::vmdplugin
