// handles.h: opaque objects on an engine's device, passed from stage to stage.
#pragma once

#include <memory>

namespace espdiff {

class Engine;

/// Opaque device objects. Each belongs to the engine that made it and must not outlive it.
/// Atoms sorted into a cell list.
struct DeviceAtoms {
  virtual ~DeviceAtoms() = default;
};
/// A scalar on a lattice.
struct DeviceGrid {
  virtual ~DeviceGrid() = default;
};
/// A scalar and its gradient on a lattice.
struct DeviceField {
  virtual ~DeviceField() = default;
};
/// Positions and shared topology (triangles, one-rings).
struct DeviceMesh {
  virtual ~DeviceMesh() = default;
};
/// One float per vertex or per triangle.
struct DeviceScalars {
  virtual ~DeviceScalars() = default;
};

using AtomsPtr = std::shared_ptr<const DeviceAtoms>;
using GridPtr = std::shared_ptr<const DeviceGrid>;
using FieldPtr = std::shared_ptr<const DeviceField>;
using MeshPtr = std::shared_ptr<const DeviceMesh>;
using ScalarsPtr = std::shared_ptr<const DeviceScalars>;

}  // namespace espdiff
