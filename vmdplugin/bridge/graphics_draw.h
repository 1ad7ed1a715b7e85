// graphics_draw.h: a coloured surface into a graphics molecule of VMD.
#pragma once

#include <tcl.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Triangles with a normal and a colour at each vertex. The arrays must outlive the drawing.
struct TriangleSoup {
  const std::vector<Vec3f>* positions = nullptr;     ///< [vertex], Angstrom
  const std::vector<Vec3f>* normals = nullptr;       ///< [vertex], unit
  const std::vector<Triangle>* triangles = nullptr;  ///< indices of vertices
  std::vector<int> colour;                           ///< [vertex] colour id of VMD; 33 to 1056 are the colour scale
  std::vector<std::uint8_t> drawn;                   ///< [triangle] 0 leaves it out; empty draws all
};

inline constexpr int kMostColourId = 1056;

/// Appends the triangles to graphics molecule `mol` by `graphics MOL tricolor`, whose own procedure is called: VMD has
/// no other primitive with a colour at each vertex of a continuous scale. Positions are passed to 0.001 A. VMD keeps
/// the ids, and turns them into red, green and blue when it next builds the molecule's display list: after anything was
/// added to it, at the next redraw or at `molinfo MOL set frame N`. Later changes of the colour scale do not reach it.
/// Leaves the interpreter's result empty.
/// @returns the number of triangles drawn
/// @throws InputError (no command `graphics`, no such molecule, arrays that do not agree, positions or normals that are
///         not numbers within 1e7)
std::size_t draw_triangles(Tcl_Interp* interp, int mol, const TriangleSoup& soup);

/// Appends points to graphics molecule `mol` that are not drawn and that a click can pick, by `graphics MOL pickpoint`.
/// @param positions Angstrom
/// @throws InputError as draw_triangles()
void add_pick_points(Tcl_Interp* interp, int mol, const std::vector<Vec3f>& positions);

}  // namespace espdiff
