// types.h: plain host data passed between stages: molecule, grid, mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/chemical_formula.h"
#include "base/units.h"
#include "base/vector.h"

namespace espdiff {

/// An atom's record in a structure file, without numbers.
struct Atom {
  std::string name;          ///< "CA", without padding
  std::string element;       ///< "C", "Na"; empty if neither file nor name determines it
  std::int32_t residue = 0;  ///< index into Molecule::residues
  bool hetero = false;       ///< from a HETATM record
  /// How well a structure file knows the place, as it says: B factor (Angstrom^2; of a predicted model its confidence),
  /// NaN where no file says one, as of atoms that a preparation added; occupancy; whether there are other places.
  float b_factor = std::numeric_limits<float>::quiet_NaN();
  float occupancy = 1;
  bool has_alternates = false;
};

/// A residue: atoms that share chain, number, insertion code and name, in file order.
struct Residue {
  std::string name;   ///< "ALA", without padding
  std::string chain;  ///< empty when the file has none
  std::int32_t number = 0;
  char insertion_code = ' ';
};

/// A residue of a molecule's file that is no part of the molecule, because an option left it out.
struct LeftOutResidue {
  Residue residue;
  std::vector<Atom> atoms;  ///< those that were left out
  std::vector<Vec3d> positions;
  double charge = 0;  ///< elementary charges; NaN where it is not known
};

/// Origin of a molecule's radii or charges; results report it. kVmd: from VMD, which guesses radii from names, or from
/// its user.
enum class ValueOrigin { kNone, kFile, kElement, kVmd };

/// One conformation of a molecule: arrays of equal length, in file order. For a potential of charges alone, atoms,
/// residues and radii may be empty.
struct Molecule {
  std::vector<Atom> atoms;
  std::vector<Residue> residues;
  std::vector<Vec3d> positions;  ///< [atom], Angstrom
  std::vector<float> radii;      ///< [atom], Angstrom; 0 adds no density
  std::vector<float> charges;    ///< [atom], elementary charges; empty when the file has none
  ValueOrigin radii_origin = ValueOrigin::kNone;
  std::string name;  ///< for messages: the path, or VMD's molecule name
  std::vector<LeftOutResidue> left_out{};
  std::map<std::string, ChemicalFormula> formulas{};  ///< by residue name, where the file gives them

  std::size_t size() const { return positions.size(); }
};

/// A lattice of points: origin + i*step[0] + j*step[1] + k*step[2], 0 <= i < size[0] and so on. Angstrom. Axes may be
/// skewed.
struct Lattice {
  std::array<int, 3> size{0, 0, 0};
  Vec3d origin{};
  std::array<Vec3d, 3> step{};

  std::size_t n_points() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
};

/// A scalar on a lattice, i fastest: values[i + size[0]*(j + size[1]*k)].
struct Grid {
  Lattice lattice;
  std::vector<float> values;
  /// The lattice repeats after size[i] * step[i] along each axis: samples wrap around at the border.
  bool periodic = false;
  PotentialUnit unit = PotentialUnit::kUnknown;
  std::string name;  ///< for messages: the path
  /// What the file calls its values where that is no potential, or one in another unit than `unit`: a warning's text.
  std::string contradicting_title;
};

using Triangle = std::array<std::uint32_t, 3>;  ///< vertex indices, counter-clockwise seen from outside

/// A triangle mesh on the host.
struct Mesh {
  std::vector<Vec3f> positions;          ///< [vertex], Angstrom
  std::vector<Vec3f> normals;            ///< [vertex], unit, outward; empty if not requested
  std::vector<Triangle> triangles;       ///< [triangle]
  std::vector<std::uint32_t> component;  ///< [vertex], index of its connected component; empty if not requested
};

}  // namespace espdiff
