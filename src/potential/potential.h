// potential.h: how potentials are computed from charges: the method, the cell, the grid over it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/molecule/unit_cell.h"
#include "base/types.h"
#include "engine/poisson_boltzmann.h"
#include "engine/potential_stage.h"

namespace espdiff {

/// @throws InputError for anything but pme, coulomb, pb
PotentialMethod parse_potential_method(const std::string& text);

/// Number of grid points: `size` if it is not zero, otherwise enough for steps of at most `resolution_A`.
struct GridChoice {
  std::array<int, 3> size{0, 0, 0};
  double resolution_A = 1;
};
/// Reads what PMEPot's -grid takes: three numbers of points; one number of points from 8 on; or, below 8, a resolution
/// in Angstrom.
/// @throws InputError
GridChoice parse_grid_choice(const std::string& text);
/// Default order of the B-splines: PMEPot's in its mode, otherwise that of PmeOptions.
int usual_order(bool compatible);
/// Reads a cell: `ox oy oz ax ay az bx by bz cx cy cz` (o the centre), with or without braces and commas; PMEPot's
/// -cell is one form.
/// @throws InputError
PmeCell parse_cell(const std::string& text);

/// How potentials are computed.
struct PotentialOptions {
  PotentialMethod method = PotentialMethod::kPme;
  std::string because;  ///< the reason, if the user did not ask for this method; shown in results
  /// Cell of every frame. None: the frame's own; if it has none, or with `pad_A`, a box around the atoms.
  std::optional<PmeCell> cell;
  std::optional<double> pad_A;  ///< space on each side of the atoms; 10 A if no cell is known
  GridChoice grid;
  PmeOptions pme;  ///< except the grid's size
  CoulombOptions coulomb;
  PoissonBoltzmannOptions pb;
  double pb_spacing_A = kUsualPbSpacing_A;
  double pb_padding_A = kUsualPbPadding_A;  ///< of the grid beyond every atom's sphere
  /// Superposes each frame on the first by these atoms without water, and samples all maps on the first frame's
  /// lattice, so that the average follows the molecule. In a periodic cell the molecule is unwrapped first
  /// (unwrapped()). kNone: frames are not moved.
  AlignAtoms align = AlignAtoms::kNone;
  bool around_aligned = false;       ///< centres the lattice of a periodic cell on the superposed atoms
  std::size_t frames_per_block = 1;  ///< for the error bar
};

/// @throws InputError that says where charges come from, when the molecule has none or all are zero
void require_charges(const Molecule& molecule);

/// The middle of the box around the atoms, along the coordinate axes. @throws InputError without atoms
Vec3d middle_of(const std::vector<Vec3d>& positions);
/// The box around the atoms, wider by `pad_A` on each side, as PMEPot makes it.
/// @throws InputError (no atoms, a negative pad)
PmeCell padded_cell(const std::vector<Vec3d>& positions, double pad_A);
/// Edge vectors from lengths and angles: a along x, b in the x-y plane.
/// @throws InputError (impossible angles)
PmeCell cell_from(const UnitCell& cell, Vec3d centre);

/// The cell of a frame: the given one, its own, or a box around its atoms.
/// @throws InputError
PmeCell choose_cell(const PotentialOptions& options, const std::vector<Vec3d>& positions,
                    const std::optional<UnitCell>& own_cell);

/// Points along each edge: the given number, otherwise the least product of 2, 3, 5 and 7 with steps of at most the
/// resolution. With `compatible` the number that PMEPot takes (even, from its list, at most 512).
/// @throws InputError (resolution)
std::array<int, 3> choose_grid_size(const PmeCell& cell, const GridChoice& choice, bool compatible);

}  // namespace espdiff
