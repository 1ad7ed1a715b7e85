// amber.cpp: Amber's restart files and NetCDF trajectories as a format of structures, whose atoms a topology gives.
#include <memory>
#include <utility>

#include "io/structures/amber_frames.h"
#include "io/structures/frame_models.h"
#include "io/structures/structure_format.h"

namespace espdiff {

StructureFormat amber_format() {
  return {"Amber restart",
          [](std::string_view /*head*/, FileKind kind) {
            return kind == FileKind::kAmberRestart || kind == FileKind::kNetcdf;
          },
          [](FileContent file) -> std::unique_ptr<StructureModels> {
            return std::make_unique<FrameModels>(amber_frames(std::move(file)), nullptr);
          }};
}

}  // namespace espdiff
