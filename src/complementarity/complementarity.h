// complementarity.h: the electrostatic complementarity of an interface, in one complex and between two.
//
// McCoy, Epa and Colman, J. Mol. Biol. 268, 570 (1997): on the surface that each partner buries in the other, the
// correlation of the potentials of both partners, each made by its own charges alone in the dielectric of the whole
// complex; with reversed sign, the mean of both surfaces. 1 is complementary, 0 unrelated, -1 alike.
//
// Departures: the surface is that of all comparisons (a level set of Gaussians); both potentials of a point are read on
// the van der Waals sphere of its nearest atom, as at the contact part of Connolly's surface. Buried is where a probe
// of 1.4 A that touches the sphere there would overlap the partner. Correlations are weighted by area instead of taken
// over dots of one density. As there, what lies within 1.5 A of surface that is not buried is left out (Lawrence and
// Colman, J. Mol. Biol. 234, 946 (1993)).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/types.h"
#include "certificate/interface_numbers.h"
#include "field/field.h"
#include "field/interface_request.h"
#include "potential/computed_map.h"

namespace espdiff {

class Engine;
struct CompareOptions;
struct CompareResult;
struct LoadedState;

constexpr double kProbe_A = 1.4, kTrimmedBorder_A = 1.5;

/// Both potentials on a partner's surface.
struct InterfaceSurface {
  std::vector<Vec3d> positions;  ///< [vertex] in the complex' own frame
  std::vector<Vec3f> normals;    ///< [vertex] outward
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> residue;   ///< [vertex] of the partner, -1 for none
  std::vector<std::uint8_t> left_out;  ///< [triangle] nonzero where there is no surface; empty for none
  std::vector<float> own, other;       ///< [vertex] the partner's own potential, and that of the other, kT/e
  std::vector<std::uint8_t> inside;    ///< [vertex] whether it belongs to the interface
  /// [vertex] -z_own z_other with the potentials less their mean over their standard deviation: its mean over the
  /// interface is -r. NaN elsewhere.
  std::vector<float> local;
};

/// One partner of one complex.
struct InterfaceSide : SideComplementarity {
  Molecule molecule;
  InterfaceSurface surface;
  std::vector<InterfaceResidue> residues;  ///< [residue of the molecule]
};

/// The complementarity of one complex.
struct Complementarity {
  InterfaceSide sides[2];
  double pearson = 0, spearman = 0;  ///< means of both sides
  std::size_t n_left_out = 0;        ///< atoms of neither partner
  std::string potential;             ///< in words

  StateComplementarity numbers() const;
};

/// The potential of a complex whose charges are those of one partner.
using MapOfComplex = std::function<ComputedMap(const LoadedState& charged)>;

/// The potentials of both partners and the interface of one complex.
/// @param complex with charges; its radii make the potentials
/// @throws InputError (partners, as atoms_of(); an interface that buries nothing; a periodic potential; as map_of)
class InterfaceOfComplex {
 public:
  InterfaceOfComplex(Engine& engine, const LoadedState& complex, const InterfaceRequest& request,
                     const MapOfComplex& map_of, const CompareOptions& options, const Progress& progress);

  const Complementarity& result() const { return result_; }
  /// The local complementarity on any surface of a side, as a field. Refers to this object.
  StateField field(std::size_t side) const;
  /// Reads both potentials on another form of a side's surface, and finds the interface there.
  void read(std::size_t side, InterfaceSurface& surface) const;

 private:
  void fill_side(std::size_t side, const CompareOptions& options, const Progress& progress);

  Engine& engine_;
  RigidTransform to_common_;
  GridPtr maps_[2];
  Complementarity result_;
};

/// A side's surface mapped from one complex to the other.
struct InterfaceChange {
  InterfaceSurface source, target;       ///< one topology
  std::vector<std::uint8_t> why;         ///< [triangle] 0 where the mapping is trusted
  std::vector<std::int32_t> partner_of;  ///< [residue of the source] in the target, -1 for none
  std::string verdict;
};

/// Maps a side's surface from one complex onto the other by shape, and reads both there.
InterfaceChange change_of_side(Engine& engine, const InterfaceOfComplex& source, const InterfaceOfComplex& target,
                               std::size_t side, const CompareOptions& options, const Progress& progress);

}  // namespace espdiff
