// bulk_zero.h: moves the zero of a periodic potential to its bulk solvent (see Engine::zero_in_bulk).
#pragma once

#include <memory>
#include <vector>

#include "cuda/surface/sample.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

std::shared_ptr<MapGrid> zero_in_bulk(const MapGrid& map, const std::vector<Vec3d>& solute, double distance_A,
                                      BulkZero* report);

/// [point] the weights of the mean over the bulk. @param solute in the lattice's frame
Buffer<float> bulk_weights(const Lattice& lattice, const std::vector<Vec3d>& solute, double distance_A);

}  // namespace espdiff::ESPDIFF_BACKEND
