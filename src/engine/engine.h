// engine.h: what a back end offers: the numerical stages, on data that stays on its device.
//
// One source in cuda/ implements this interface twice, for OpenMP threads and for CUDA. The pipeline calls the stages
// in order and passes opaque handles; nothing is copied to the host but what a download function or a returned struct
// holds.
//
// Frame: every position is relative to the *common frame* that the pipeline chooses (source and target superposed,
// origin near the molecules), so that single precision suffices. Maps keep their own frame; sample() gets the transform
// into it.
//
// Same input, same bits, at any number of threads. Density is high inside: *inside* means density > isovalue.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/screw.h"
#include "base/types.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff {

/// Opaque device objects. Each belongs to the engine that made it and may not outlive it.
struct DeviceAtoms {
  virtual ~DeviceAtoms() = default;
};  ///< atoms sorted into a cell list
struct DeviceGrid {
  virtual ~DeviceGrid() = default;
};  ///< a scalar on a lattice
struct DeviceField {
  virtual ~DeviceField() = default;
};  ///< a scalar and its gradient on a lattice
struct DeviceMesh {
  virtual ~DeviceMesh() = default;
};  ///< positions and shared topology (triangles, one-rings)
struct DeviceScalars {
  virtual ~DeviceScalars() = default;
};  ///< one float per vertex or per triangle

using AtomsPtr = std::shared_ptr<const DeviceAtoms>;
using GridPtr = std::shared_ptr<const DeviceGrid>;
using FieldPtr = std::shared_ptr<const DeviceField>;
using MeshPtr = std::shared_ptr<const DeviceMesh>;
using ScalarsPtr = std::shared_ptr<const DeviceScalars>;

enum class Interpolation { kTrilinear, kTricubic };

/// A connected component of a closed mesh.
struct ComponentSummary {
  std::uint32_t n_vertices = 0;
  std::uint32_t n_triangles = 0;
  double area_A2 = 0;
  double volume_A3 = 0;  ///< signed: negative for a cavity, whose normals point into the void
};

/// Parameters of the force iteration (thesis section 3.5.4); defaults are its study's values for the mapping.
struct DeformOptions {
  double sigma = 0.1;                ///< step scale, > 0
  double mu = 0.75;                  ///< weight of the external against the internal force, 0 to 1
  double rho = 0.3;                  ///< rigidity (thin plate) against tension (membrane), 0 to 1
  double min_displacement_A = 1e-3;  ///< converged when the mean displacement of an iteration falls below it
  int max_iterations = 1000;
  Interpolation interpolation = Interpolation::kTrilinear;
  /// Multiplies the internal force; 1 is the thesis' iteration. That force moves vertices along the surface only, so a
  /// larger one lets them spread into what the surface has been drawn into sooner, and the surface itself no less
  /// exact.
  double tangential_gain = 1;
  /// Measures the internal force from a rest shape (see Engine::deform), so that it resists distortion; else from
  /// equal edges (the thesis), so that the mesh goes on sliding along the surface even when nothing is to be deformed.
  bool rest_shape = false;
};

struct DeformReport {
  int iterations = 0;
  double mean_displacement_A = 0;  ///< of the last iteration
  bool converged = false;
  ScalarsPtr path_length;  ///< [vertex] length of the way that the iterations took it, Angstrom
};

/// Parameters of gvf_field().
struct VectorFlowOptions {
  double weight_A2 = 0.05;  ///< mu: smoothness against the normals at the surface; they are blended over its root
  double tolerance = 1e-3;  ///< converged when no point would move by more in a sweep; normals are 1 long
  int max_sweeps = 1000;
};

struct VectorFlowReport {
  int sweeps = 0;
  double residual = 0;  ///< largest move of a point in the last sweep looked at
  bool converged = false;
};

/// Area-weighted comparison of two potentials on the mapped mesh. Weights are a third of the area of each counted
/// triangle at each of its vertices. Potentials in the unit of the samples.
struct Metrics {
  double area_A2 = 0;  ///< of the counted triangles of the mapped mesh; all else is NaN when it is 0
  double mean_abs_difference = 0;
  double rms_difference = 0;
  double mean_signed_difference = 0;     ///< target - source
  double sign_change_area_fraction = 0;  ///< a vertex with a potential of exactly 0 agrees with anything
  double hodgkin_index = 0;              ///< 2<ab> / (<aa> + <bb>)
  double carbo_index = 0;                ///< <ab> / sqrt(<aa><bb>)
  double mean_displacement_A = 0;        ///< |mapped - source| in the common frame
  double mean_path_length_A = 0;         ///< of the vertices' ways from the one to the other; NaN where not given
};

/// Distances of one surface's vertices to the other surface's triangles, area-weighted over its vertices. Angstrom.
struct DistanceSummary {
  double mean = 0;
  double p95 = 0;  ///< 95 % of the area lies nearer
  double max = 0;
  double area_fraction_beyond_limit = 0;
  double mean_within_limit = 0;  ///< of the area within the limit
  ScalarsPtr beyond;             ///< [triangle of the first surface] 1 where a corner lies beyond the limit, else 0
};

/// How well a mapped mesh fits its target.
struct FitReport {
  double corrupt_area_fraction =
      0;  ///< triangles whose analytic density at the centroid is off the isovalue by more than 0.1
  double flipped_area_fraction = 0;  ///< triangles whose normal opposes the density's outward normal at their centroid
  double irregularity_A = 0;         ///< mean length of the umbrella Laplacian
  double area_A2 = 0;
  ScalarsPtr corrupt;  ///< [triangle] 1 where corrupt, else 0
  ScalarsPtr flipped;  ///< [triangle] 1 where flipped, else 0
};

/// A periodic cell: `edges` span it, `centre` lies in its middle. Angstrom.
struct PmeCell {
  Vec3d centre{};
  std::array<Vec3d, 3> edges{};
};

/// The points of a grid over a cell, symmetric about its centre: (0, 0, 0) lies at centre - sum_i (K_i - 1) / (2 K_i)
/// edge_i, steps are edge_i / K_i. As PMEPot lays them.
inline Lattice lattice_over(const PmeCell& cell, const std::array<int, 3>& size) {
  Lattice lattice;
  lattice.size = size;
  lattice.origin = cell.centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = size[axis];
    lattice.step[axis] = (1.0 / n) * cell.edges[axis];
    lattice.origin += (-0.5 * (n - 1) / n) * cell.edges[axis];
  }
  return lattice;
}

enum class Precision { kSingle, kDouble };

/// Parameters of pme_potential().
struct PmeOptions {
  std::array<int, 3> size{0, 0, 0};  ///< grid points along each edge
  double ewald_factor = 0.25;        ///< beta, 1/A: charges are smeared into Gaussians of variance 1 / (2 beta^2)
  int order = 6;                     ///< of the B-splines, 4 to 8; 4 with `compatible`
  Precision precision = Precision::kSingle;
  /// As VMD's PMEPot 1.0.4 computes it: the splines' factor squared, the volume truncated to whole A^3.
  bool compatible = false;
  /// Later samples of the map use splines of `order` instead of trilinear interpolation, and err no more between the
  /// grid's points than on them. Not with `compatible`.
  bool smooth_samples = false;
  double temperature_K = 300;
};

/// Parameters of coulomb_potential().
struct CoulombOptions {
  double dielectric = 1;            ///< epsilon, > 0
  bool distance_dependent = false;  ///< epsilon * r / (1 A) instead of epsilon
  double temperature_K = 300;
};

/// An atom's way from the source to the target, in a straight line, for Engine::morph(). Common frame, Angstrom.
struct MovingAtom {
  Vec3d start{}, end{};
  Screw motion{};                         ///< of the rigid piece that it belongs to; its own way is straight beside it
  Vec3d own_turn{};                       ///< of its surroundings beside the piece's motion: axis times angle, radians
  double start_width = 0, end_width = 0;  ///< standard deviation of its Gaussian; 0 counts as absent
  /// Atoms without a counterpart are absent at one end. They appear and vanish in the half of the way that lies at that
  /// end.
  bool at_start = true, at_end = true;

  Vec3d position_at(double time) const { return motion.apply(start + time * own_way(), time); }
  Vec3d velocity_at(double time) const { return motion.velocity_at(position_at(time)) + motion.turn(own_way(), time); }
  /// Angular velocity of its surroundings.
  Vec3d spin_at(double time) const { return motion.angle * motion.axis + motion.turn(own_turn, time); }
  /// From where it starts to where it would end if its piece stood still.
  Vec3d own_way() const { return motion.apply(end, -1) - start; }

  static constexpr double kFadingShare = 0.5;
  /// Share of the Gaussian that is there at a time from 0 (source) to 1 (target).
  double weight_at(double time) const {
    const double appeared = at_start ? 1.0 : std::min(1.0, time / kFadingShare);
    const double left = at_end ? 1.0 : std::min(1.0, (1.0 - time) / kFadingShare);
    return std::min(appeared, left);
  }
  /// Its derivative; at a kink that of the later side.
  double weight_rate_at(double time) const {
    if (!at_start && time < kFadingShare) return 1.0 / kFadingShare;
    if (!at_end && time >= 1.0 - kFadingShare) return -1.0 / kFadingShare;
    return 0.0;
  }
};

/// Parameters of morph(). Lengths in Angstrom.
struct MorphOptions {
  double isovalue = 0.5;
  double max_step_A = 0.35;  ///< no atom moves farther in one step
  double max_edge_A = 1.4;   ///< longer edges are halved
  double max_stretch = 20;   ///< where an edge to be halved has grown by more the surface counts as torn
};

struct MorphReport {
  int steps = 0;
  std::size_t n_vertices_added = 0;
  std::size_t n_vertices_lost = 0;  ///< without counterpart
};

/// What morph() gives: meshes of one topology, that of the source with some edges halved.
struct MorphResult {
  MeshPtr source;  ///< where each vertex comes from, on the source's surface
  MeshPtr mapped;  ///< where it lies on the target's
  /// [triangle] 1 where the surface was torn or crushed on the way, so that there is no counterpart; the mapped
  /// positions there mean nothing.
  ScalarsPtr lost;
  ScalarsPtr path_length;  ///< [vertex] length of its way, Angstrom; an added vertex begins with its ends' mean
  MorphReport report;
};

/// What subdivide() gives: both meshes with the same edges halved. Old vertices keep their numbers and places.
struct SubdivisionResult {
  MeshPtr source, mapped;
  std::vector<std::array<std::uint32_t, 2>> ends;  ///< [new vertex] the vertices that it lies in the middle of
};

/// How a mapping changes areas and shapes; see Engine::distortion(). Quantiles by the source's area.
struct DistortionReport {
  double area_ratio_p05 = 1, area_ratio_median = 1, area_ratio_p95 = 1;  ///< mapped area / source area
  /// Symmetric Dirichlet energy (|J|^2 + |J^-1|^2) / 4, J the triangle's linear map: 1 where nothing is distorted,
  /// infinite for a triangle without area.
  double dirichlet_median = 1, dirichlet_p95 = 1;
  ScalarsPtr excessive;  ///< [triangle] 1 where the area around it has grown by more than the limit, else 0
};

/// The triangles of a closed mesh that intersect one another; see Engine::self_intersections().
struct IntersectionReport {
  std::size_t n_pairs = 0;       ///< of triangles that intersect, and each triangle without area as a pair with itself
  std::size_t n_degenerate = 0;  ///< the latter
  ScalarsPtr intersecting;       ///< [triangle] 1 where it takes part in a pair, else 0
};

/// One back end on one device.
class Engine {
 public:
  virtual ~Engine() = default;

  /// "cpu" or "cuda".
  virtual std::string back_end() const = 0;
  /// The device in words, such as "16 OpenMP threads".
  virtual std::string description() const = 0;
  /// Threads used by the CPU back end; 0 on a device.
  virtual int n_threads() const = 0;
  /// Milliseconds that calls of this engine take: between two events on a device's stream, by the clock on the CPU.
  /// For benchmarks.
  virtual double elapsed_ms(const std::function<void()>& calls) = 0;

  /// Sorts atoms into a cell list.
  /// @param positions [atom] Angstrom, common frame
  /// @param widths    [atom] standard deviation s = radius scale * radius of each Gaussian, Angstrom; atoms of width 0
  /// are left out
  /// @param residues  [atom] residue index that vertex_residues() reports
  /// @throws InputError if no atom has a positive width, MemoryError
  virtual AtomsPtr upload_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                                const std::vector<std::int32_t>& residues) = 0;

  /// rho(x) = sum_i exp(-|x - x_i|^2 / (2 s_i^2)) (thesis eq. 3.1) on a cubic lattice of the given spacing that reaches
  /// so far beyond the atoms that rho vanishes on its border. Terms beyond 4.5 s are dropped: the sum errs by less than
  /// 1e-3.
  /// @throws InputError (spacing), MemoryError (more lattice points than memory holds; says which spacing would fit)
  virtual GridPtr density(const AtomsPtr& atoms, double spacing_A) = 0;

  /// Marching tetrahedra on the Freudenthal division: a closed, welded, consistently oriented mesh with its one-rings.
  /// @throws GeometryError when no lattice point is inside
  virtual MeshPtr isosurface(const GridPtr& density, float isovalue) = 0;

  /// Connected components in the order of their first vertex.
  virtual std::vector<ComponentSummary> components(const MeshPtr& mesh) = 0;
  /// The mesh without the components whose entry is false. `keep` has one entry per component.
  virtual MeshPtr keep_components(const MeshPtr& mesh, const std::vector<bool>& keep) = 0;

  /// The mesh without the triangles whose entry is nonzero, and without vertices in none; open where they were. What is
  /// left keeps its order.
  /// @param excluded [triangle]
  /// @throws GeometryError when nothing is left
  virtual MeshPtr without(const MeshPtr& mesh, const ScalarsPtr& excluded) = 0;

  /// Moves each vertex by Newton steps along the gradient onto the analytic isosurface; a vertex that would have to
  /// move farther than `max_shift_A` stays where it is.
  virtual MeshPtr project(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue, double max_shift_A) = 0;

  /// [vertex] unit, outward: the normal of the analytic isosurface, which the mesh's triangles only approximate. Where
  /// the density is off the isovalue by more than a tenth of it, or falls against the triangles' side, the mean of the
  /// triangles' normals, as download() gives it.
  virtual std::vector<Vec3f> level_set_normals(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue) = 0;

  /// Density and gradient for deform().
  virtual FieldPtr density_field(const GridPtr& density, float isovalue) = 0;
  /// Signed distance to `surface` (positive inside) where it exceeds `threshold_A` in magnitude, the density elsewhere
  /// (thesis section 3.5.3). The distance is that to the triangles around the nearest vertex.
  virtual FieldPtr distance_field(const GridPtr& density, float isovalue, const MeshPtr& surface, double threshold_A,
                                  const Progress& progress) = 0;

  /// Gradient vector flow: the direction of the target's inward normals, spread from its surface over the lattice by
  /// diffusion, so that it leads into crevices (Xu and Prince, IEEE Trans. Image Process. 7, 359 (1998)); the scalar is
  /// that of density_field(). See cuda/vector_flow.h for the equation and the method.
  /// @param source_density  holds the source's normals too, where the target's do not (two-way); null for the target's
  /// alone
  /// @throws InputError (options), Cancelled
  virtual FieldPtr gvf_field(const GridPtr& target_density, const GridPtr& source_density, float isovalue,
                             const VectorFlowOptions& options, const Progress& progress, VectorFlowReport* report) = 0;

  /// Iterates x += sigma (mu f_ext + (1 - mu) f_int) until converged (thesis section 3.5 with its errata): f_ext along
  /// the unit gradient of the field toward its surface, halved and turned at each crossing; f_int the tangential part
  /// of (1 - rho) L - rho L^2, L the uniform umbrella Laplacian. Topology is shared with `mesh`.
  /// @param stage name for progress reports
  /// @param rest  the shape that options.rest_shape measures from, of the same topology; null takes `mesh` itself
  /// @throws InputError (options), GeometryError (rest shape of another topology), Cancelled
  virtual MeshPtr deform(const MeshPtr& mesh, const FieldPtr& field, const DeformOptions& options,
                         const std::string& stage, const Progress& progress, DeformReport* report,
                         const MeshPtr& rest = nullptr) = 0;

  /// Halves the edges of a mapped mesh that are longer than `max_edge_A` and longer than on the source, on both meshes;
  /// new vertices lie in the middles of both edges.
  /// @throws InputError (length), GeometryError when the topologies differ
  virtual SubdivisionResult subdivide(const MeshPtr& source, const MeshPtr& mapped, double max_edge_A) = 0;

  /// Carries a surface from source to target by the level sets of the density of moving atoms.
  ///
  /// rho(x, t) = sum_i w_i exp(-|x - x_i|^2 / (2 s_i^2)), t from 0 to 1, positions as MovingAtom::position_at() says
  /// (straight, but for rigid pieces), widths linear in t, weights 1 but
  /// for atoms without a counterpart. A vertex flows with the atoms under it, at
  /// u = sum_i rho_i dx_i/dt / sum_i rho_i, plus what along the gradient keeps it on the level set (the change of rho
  /// along u, predicted, then corrected by Newton's method). Edges that grow too long are halved; triangles whose
  /// shape suffers are evened out along the surface. A vertex that can no longer be kept on the level set, and a
  /// triangle whose side turns, have met a change of topology, such as a crevice that closes: they are cut out.
  ///
  /// @param mesh   the source's surface, on its isosurface
  /// @param atoms  of both molecules; at time 0 those of the source, at time 1 those of the target
  /// @param source_atoms, target_atoms  the same at the ends, onto whose isosurfaces vertices are moved at last
  /// @throws InputError (options), Cancelled
  virtual MorphResult morph(const MeshPtr& mesh, const std::vector<MovingAtom>& atoms, const AtomsPtr& source_atoms,
                            const AtomsPtr& target_atoms, const MorphOptions& options, const std::string& stage,
                            const Progress& progress) = 0;

  /// The same from where an earlier morph has brought the surface: a trajectory in small steps. What is lost stays
  /// lost, edges that are halved stay so, and path lengths go on.
  /// @param so_far  of this engine, or its four parts as they were downloaded; its report is not read
  /// @param atoms   at time 0 those that so_far.mapped is the surface of
  /// @param source_atoms  those that so_far.source is the surface of
  /// @throws GeometryError (the parts of `so_far` do not fit together), and as morph()
  virtual MorphResult continue_morph(const MorphResult& so_far, const std::vector<MovingAtom>& atoms,
                                     const AtomsPtr& source_atoms, const AtomsPtr& target_atoms,
                                     const MorphOptions& options, const std::string& stage,
                                     const Progress& progress) = 0;

  /// @param map         potential
  /// @param to_map      common frame -> the map's frame
  virtual GridPtr upload_map(const Grid& map, const RigidTransform& to_map) = 0;
  /// [vertex] trilinear samples of a map, or by splines where it was made with smooth_samples; NaN where the vertex
  /// lies outside the map. A periodic map has no outside.
  virtual ScalarsPtr sample(const GridPtr& map, const MeshPtr& mesh) = 0;
  /// The map's samples on another lattice, given in the common frame; NaN outside the map.
  /// @throws InputError (axes that do not span space, no points)
  virtual GridPtr resample(const GridPtr& map, const Lattice& lattice) = 0;

  /// The potential of smeared charges in a periodic cell, the reciprocal part of the Ewald sum, on a grid over the
  /// cell:
  ///
  ///     phi(n) = C sum_{m != 0} exp(-pi^2 m^2 / beta^2) / (pi V m^2) B(m) Q(m) e^(2 pi i k.n/K)   [kT/e]
  ///
  /// Q is the transform of the charges spread by centred B-splines, B the inverse of the splines' own transform, and C
  /// = 332.0636 / (T 0.001987191) (Essmann et al., J. Chem. Phys. 103, 8577 (1995)). Leaving out m = 0 makes the mean
  /// zero and stands for a uniform background that neutralizes a net charge. Modes at half the grid's frequency are
  /// left out too, since a real grid cannot hold their phase. Atoms outside the cell are wrapped into it.
  ///
  /// With `compatible` the order is 4, B is squared, V truncated, and modes at half the frequency are kept; the values
  /// then are the splines' coefficients rather than the potential, as PMEPot writes them.
  ///
  /// The map is periodic; its points are lattice_over(cell, size). The same bits for any order of the atoms and any
  /// number of threads. Time grows with atoms * order^3 + K^3 log K.
  ///
  /// @param positions [atom] Angstrom, the map's frame  @param charges [atom] elementary charges
  /// @param to_map    common frame -> the frame of `positions` and of the map
  /// @throws InputError (cell without volume, values that are not finite, no charges, sizes, order, Ewald factor),
  ///         MemoryError, DeviceError (the library of Fourier transforms is absent), Cancelled
  virtual GridPtr pme_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                const PmeCell& cell, const PmeOptions& options, const RigidTransform& to_map,
                                const Progress& progress) = 0;

  /// Coulomb's law summed directly, without a cutoff and without periodic images, at the points of a lattice:
  /// phi(x) = C sum_i q_i / (epsilon |x - x_i|) [kT/e], C as in pme_potential(). Distances below 0.5 A count as 0.5 A.
  /// A cross-check for small systems: time grows with atoms * points. In double precision; the same bits always.
  /// @param positions [atom] Angstrom, the lattice's frame
  /// @throws InputError (dielectric, values that are not finite, no charges, lattice), MemoryError, Cancelled
  virtual GridPtr coulomb_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                    const Lattice& lattice, const CoulombOptions& options,
                                    const Progress& progress) = 0;

  /// The potential of charges in a solute of low dielectric, in a solvent with ions, by finite differences; kT/e:
  ///
  ///     -div(eps grad phi) + kappa_bar^2 lambda phi = 4 pi C rho,   kappa_bar^2 = 8 pi C c,   C as in pme_potential()
  ///
  /// rho in e/A^3, by cubic B-splines; c the number of ions of a kind in a cubic Angstrom of solvent; lambda 1 where
  /// ions may be, else 0. With `nonlinear` sinh(phi) stands for phi in the ions' term. docs/potentials.md has the
  /// definitions. The map is not periodic; zero is the potential far away. The same bits for any order of the atoms and
  /// any number of threads. Time grows with the number of grid points.
  ///
  /// @param positions [atom] Angstrom, the map's frame  @param radii [atom] Angstrom; 0 takes no room
  /// @param charges   [atom] elementary charges
  /// @param lattice   cubic, along the axes; see poisson_boltzmann_lattice()
  /// @param to_map    common frame -> the frame of `positions` and of the map
  /// @param start     where the iteration starts: a potential of this engine in the same frame, such as that of a
  /// trajectory's frame before, on any lattice; null starts from zero
  /// @param report    receives how it was come by; may be null
  /// @throws InputError (parameters, lattice, no charges, charges without radius outside all atoms), MemoryError,
  ///         ConvergenceError (with the residual), Cancelled
  virtual GridPtr poisson_boltzmann(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                    const std::vector<float>& charges, const Lattice& lattice,
                                    const PoissonBoltzmannOptions& options, const RigidTransform& to_map,
                                    const GridPtr& start, const Progress& progress, PoissonBoltzmannReport* report) = 0;

  /// Compares potentials at counterparts.
  /// @param source, mapped  meshes of one topology: where each vertex comes from, and where it lies on the target
  /// @param source_potential, target_potential [vertex]
  /// @param excluded [triangle] not counted where nonzero; null counts all. Triangles with a NaN sample are never
  /// counted.
  /// @param path_length [vertex] for the mean of it; null when there is none
  virtual Metrics compare(const MeshPtr& source, const MeshPtr& mapped, const ScalarsPtr& source_potential,
                          const ScalarsPtr& target_potential, const ScalarsPtr& excluded,
                          const ScalarsPtr& path_length = nullptr) = 0;

  virtual FitReport fit(const MeshPtr& mapped, const AtomsPtr& target_atoms, float isovalue) = 0;
  /// Distances from the vertices of `from` to the triangles of `to`, exact.
  virtual DistanceSummary distances(const MeshPtr& from, const MeshPtr& to, double limit_A) = 0;
  /// Pairs of triangles that intersect, as CGAL's Polygon_mesh_processing::self_intersections counts them:
  /// - two triangles that share no vertex, when they have a point in common, touching included;
  /// - two that share a vertex, when they have another point in common;
  /// - two that share an edge, when they lie in one plane on the same side of it: folded flat onto each other;
  /// - a triangle without area (corners on a line, or not finite) as a pair with itself, and in no other.
  ///
  /// Exact for every position a float can hold: signs of determinants are computed without rounding where an error
  /// bound in double precision leaves them open. Every pair is examined whose boxes overlap, found by a tree: time
  /// grows as n log n with the number of triangles, and with the number of such pairs.
  virtual IntersectionReport self_intersections(const MeshPtr& mesh) = 0;
  virtual double area(const MeshPtr& mesh) = 0;
  /// The vertices of `points` taken along by the mapping that takes `surface` to `image`: each goes from the place of
  /// `surface` nearest to it to the same place of `image` (linear within a triangle); where
  /// it lies farther than `max_distance_A` from `surface`, to NaN.
  /// @param surface, image meshes of one topology
  /// @returns a mesh of the topology of `points`
  /// @throws GeometryError when the topologies differ in size
  virtual MeshPtr carry(const MeshPtr& points, const MeshPtr& surface, const MeshPtr& image, double max_distance_A) = 0;
  /// A mesh taken along by rigid motions of the atoms: each vertex goes where the motions of the atoms around would
  /// take it, weighted by their densities there.
  /// @param pieces [residue] index of its motion, -1 for none; residues as given to upload_atoms()
  /// @throws GeometryError (an index beyond the motions)
  virtual MeshPtr carry_rigidly(const MeshPtr& mesh, const AtomsPtr& atoms, const std::vector<std::int32_t>& pieces,
                                const std::vector<RigidTransform>& motions) = 0;
  /// Compares the triangles of two meshes of one topology (Smith and Schaefer, ACM Trans. Graph. 34, 70 (2015), for the
  /// energy).
  /// @param limit of the ratio of areas, mapped to source, as measured over the rings of a triangle's three corners
  /// @throws GeometryError when the topologies differ in size
  virtual DistortionReport distortion(const MeshPtr& source, const MeshPtr& mapped, double limit) = 0;

  /// [vertex] index of the residue with the largest density at the vertex; -1 where no atom reaches.
  virtual std::vector<std::int32_t> vertex_residues(const MeshPtr& mesh, const AtomsPtr& atoms) = 0;
  /// [vertex] |a - b| for two meshes of one topology, Angstrom.
  virtual ScalarsPtr displacement(const MeshPtr& a, const MeshPtr& b) = 0;

  virtual std::size_t n_vertices(const MeshPtr& mesh) const = 0;
  virtual std::size_t n_triangles(const MeshPtr& mesh) const = 0;
  /// A mesh made elsewhere. Closed and consistently oriented, else:
  /// @throws GeometryError naming the first edge that does not lie in exactly two triangles
  virtual MeshPtr upload_mesh(const Mesh& mesh) = 0;
  /// A mesh that shares the topology of `mesh`, with its vertices elsewhere.
  /// @param positions [vertex]
  /// @throws GeometryError when the numbers of vertices differ
  virtual MeshPtr with_positions(const MeshPtr& mesh, const std::vector<Vec3f>& positions) = 0;
  /// Positions, triangles, component labels and outward vertex normals (area-weighted mean of the triangles').
  virtual Mesh download(const MeshPtr& mesh) = 0;
  virtual std::vector<float> download(const ScalarsPtr& scalars) = 0;
  virtual ScalarsPtr upload_scalars(const std::vector<float>& values) = 0;
  virtual Grid download(const GridPtr& grid) = 0;
  /// The field's scalar.
  virtual Grid download(const FieldPtr& field) = 0;
  /// [point] the field's gradient, or the direction that stands for it.
  virtual std::vector<Vec3f> download_gradient(const FieldPtr& field) = 0;
  /// Analytic density at points [point] of the common frame.
  virtual std::vector<float> density_at(const AtomsPtr& atoms, const std::vector<Vec3f>& points) = 0;
};

}  // namespace espdiff
