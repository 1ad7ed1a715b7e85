// engine.h: the interface of a back end: the numerical stages, on data that stays on its device.
//
// One source in cuda/ implements this interface twice, for OpenMP threads and for CUDA. Callers run the stages in order
// and pass opaque handles. Only download functions and returned structs copy data to the host.
//
// Frame: every position is in the *common frame* that the caller chooses (source and target superposed, origin near the
// molecules), so that single precision suffices. Maps keep their own frame; upload_map() takes the transform into it.
//
// Same input, same bits, at any number of threads. Density is high inside: *inside* means density > isovalue.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/types.h"

namespace espdiff {

struct AtomValues;
struct ComponentSummary;
struct BulkZero;
struct CoulombOptions;
struct DeformOptions;
struct DeformReport;
struct DistanceSummary;
struct DistortionReport;
struct FitReport;
struct IntersectionReport;
struct Metrics;
struct MorphOptions;
struct MorphResult;
struct MovingAtom;
struct PmeCell;
struct PmeOptions;
struct PotentialReading;
struct ProbeCharge;
struct PoissonBoltzmannOptions;
struct PoissonBoltzmannReport;
struct SubdivisionResult;
struct VectorFlowOptions;
struct VectorFlowReport;

/// One back end on one device.
class Engine {
 public:
  virtual ~Engine() = default;

  /// "cpu" or "cuda".
  virtual std::string back_end() const = 0;
  /// Description of the device, such as "16 OpenMP threads".
  virtual std::string description() const = 0;
  /// Threads used by the CPU back end; 0 on a device.
  virtual int n_threads() const = 0;
  /// Another engine on the same device, for another thread to use at the same time.
  /// @param n_threads of the CPU back end; a device ignores it
  virtual std::unique_ptr<Engine> beside(int n_threads) const = 0;
  /// Milliseconds that calls of this engine take: between two events on a device's stream, or by the clock on the CPU.
  /// For benchmarks.
  virtual double elapsed_ms(const std::function<void()>& calls) = 0;

  /// Sorts atoms into a cell list.
  /// @param positions [atom] Angstrom, common frame
  /// @param widths    [atom] standard deviation s = radius scale * radius of each Gaussian, Angstrom; atoms of width 0
  /// are ignored
  /// @param residues  [atom] residue index reported by vertex_residues()
  /// @throws InputError if no atom has a positive width, MemoryError
  virtual AtomsPtr upload_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                                const std::vector<std::int32_t>& residues) = 0;

  /// rho(x) = sum_i exp(-|x - x_i|^2 / (2 s_i^2)) (thesis eq. 3.1) on a cubic lattice of the given spacing, large
  /// enough that rho vanishes on its border. Terms beyond 4.5 s are dropped: the error of the sum is below 1e-3.
  /// @throws InputError (spacing), MemoryError (too many lattice points for the memory; names a spacing that fits)
  virtual GridPtr density(const AtomsPtr& atoms, double spacing_A) = 0;

  /// Marching tetrahedra on the Freudenthal division: a closed, welded, consistently oriented mesh with its one-rings.
  /// @throws GeometryError if no lattice point is inside
  virtual MeshPtr isosurface(const GridPtr& density, float isovalue) = 0;

  /// Connected components in order of their first vertex.
  virtual std::vector<ComponentSummary> components(const MeshPtr& mesh) = 0;
  /// The mesh without the components for which `keep` is false. `keep` has one entry per component.
  virtual MeshPtr keep_components(const MeshPtr& mesh, const std::vector<bool>& keep) = 0;

  /// The mesh without the triangles with nonzero `excluded` and without isolated vertices; open where triangles were
  /// removed. The rest keeps its order.
  /// @param excluded [triangle]
  /// @throws GeometryError if nothing remains
  virtual MeshPtr without(const MeshPtr& mesh, const ScalarsPtr& excluded) = 0;

  /// Moves each vertex by Newton steps along the gradient onto the analytic isosurface. A vertex that would move
  /// farther than `max_shift_A` stays in place.
  virtual MeshPtr project(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue, double max_shift_A) = 0;

  /// [vertex] unit, outward: the normal of the analytic isosurface, which the triangles only approximate. If the
  /// density differs from the isovalue by more than a tenth of it, or its normal opposes the triangles', the mean of
  /// the triangles' normals instead, as in download().
  virtual std::vector<Vec3f> level_set_normals(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue) = 0;

  /// [vertex] mean curvature of the analytic isosurface, 1/Angstrom: half the divergence of the outward normal, 1/r on
  /// a sphere, positive where the surface is convex. From the density's gradient and Hessian at the vertex (Goldman,
  /// Comput. Aided Geom. Des. 22, 632 (2005), the formula for an implicit surface, with the sign of the outward
  /// normal). NaN where the density differs from the isovalue by more than a tenth of it, or has no gradient.
  virtual std::vector<float> level_set_curvature(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue) = 0;

  /// Density and gradient for deform().
  virtual FieldPtr density_field(const GridPtr& density, float isovalue) = 0;
  /// Signed distance to `surface` (positive inside) where its magnitude exceeds `threshold_A`, the density elsewhere
  /// (thesis section 3.5.3). The distance is to the triangles around the nearest vertex.
  virtual FieldPtr distance_field(const GridPtr& density, float isovalue, const MeshPtr& surface, double threshold_A,
                                  const Progress& progress) = 0;

  /// Gradient vector flow: the target's inward normals, spread from its surface over the lattice by diffusion, which
  /// leads into crevices (Xu and Prince, IEEE Trans. Image Process. 7, 359 (1998)). The scalar is that of
  /// density_field(). See cuda/deform/vector_flow.h for the equation and the method.
  /// @param source_density  imposes the source's normals too, where the target's are not (two-way); null for one-way
  /// @throws InputError (options), Cancelled
  virtual FieldPtr gvf_field(const GridPtr& target_density, const GridPtr& source_density, float isovalue,
                             const VectorFlowOptions& options, const Progress& progress, VectorFlowReport* report) = 0;

  /// Iterates x += sigma (mu f_ext + (1 - mu) f_int) until converged (thesis section 3.5 with its errata). f_ext acts
  /// along the unit gradient of the field toward its surface; each crossing halves and reverses it. f_int is the
  /// tangential part of (1 - rho) L - rho L^2 with L the uniform umbrella Laplacian. The result shares the topology of
  /// `mesh`.
  /// @param stage name for progress reports
  /// @param rest  the shape that options.rest_shape measures from, of the same topology; null for `mesh` itself
  /// @throws InputError (options), GeometryError (rest shape of another topology), Cancelled
  virtual MeshPtr deform(const MeshPtr& mesh, const FieldPtr& field, const DeformOptions& options,
                         const std::string& stage, const Progress& progress, DeformReport* report,
                         const MeshPtr& rest = nullptr) = 0;

  /// Splits the edges of a mapped mesh that are longer than `max_edge_A` and longer than on the source, on both meshes;
  /// new vertices are the midpoints of both edges.
  /// @throws InputError (length), GeometryError if the topologies differ
  virtual SubdivisionResult subdivide(const MeshPtr& source, const MeshPtr& mapped, double max_edge_A) = 0;

  /// Carries a surface from source to target by the level sets of the density of moving atoms.
  ///
  /// rho(x, t) = sum_i w_i exp(-|x - x_i|^2 / (2 s_i^2)), t from 0 to 1. Positions follow MovingAtom::position_at()
  /// (straight, except in rigid domains), widths are linear in t, weights are 1 except for unpaired atoms. A vertex
  /// flows with the atoms around it, at u = sum_i rho_i dx_i/dt / sum_i rho_i, plus a component along the gradient that
  /// keeps it on the level set (the change of rho along u, predicted, then corrected by Newton's method). Edges that
  /// grow too long are split; badly shaped triangles are smoothed tangentially. A vertex that cannot stay on the level
  /// set, and a triangle that flips, indicate a change of topology, such as a closing crevice; they are removed.
  ///
  /// @param mesh   the source's surface, on its isosurface
  /// @param atoms  of both molecules; at time 0 those of the source, at time 1 those of the target
  /// @param source_atoms, target_atoms  the same at the ends; vertices are finally projected onto their isosurfaces
  /// @throws InputError (options), Cancelled
  virtual MorphResult morph(const MeshPtr& mesh, const std::vector<MovingAtom>& atoms, const AtomsPtr& source_atoms,
                            const AtomsPtr& target_atoms, const MorphOptions& options, const std::string& stage,
                            const Progress& progress) = 0;

  /// Continues an earlier morph: a trajectory in small steps. Lost surface stays lost, split edges stay split, and path
  /// lengths add up.
  /// @param so_far  of this engine, or its four parts as downloaded; its report is not read
  /// @param atoms   at time 0 the atoms of so_far.mapped
  /// @param source_atoms  the atoms of so_far.source
  /// @throws GeometryError (the parts of `so_far` do not fit together), and as morph()
  virtual MorphResult continue_morph(const MorphResult& so_far, const std::vector<MovingAtom>& atoms,
                                     const AtomsPtr& source_atoms, const AtomsPtr& target_atoms,
                                     const MorphOptions& options, const std::string& stage,
                                     const Progress& progress) = 0;

  /// @param map         potential
  /// @param to_map      common frame -> the map's frame
  virtual GridPtr upload_map(const Grid& map, const RigidTransform& to_map) = 0;
  /// [vertex] samples of a map, trilinear, or by splines if it was made with smooth_samples; NaN if the vertex lies
  /// outside the map. A periodic map has no outside.
  virtual ScalarsPtr sample(const GridPtr& map, const MeshPtr& mesh) = 0;
  /// [vertex] gradient of a map in the common frame, per Angstrom. Of a map with points: central differences over two
  /// lattice steps along each axis, interpolated as the map is. Of one that is smooth between its points, or has none:
  /// differences of fourth order over 0.1 A. NaN outside the map and within a step of its border.
  virtual std::vector<Vec3f> sample_gradient(const GridPtr& map, const MeshPtr& mesh) = 0;
  /// The map's samples on another lattice, given in the common frame; NaN outside the map.
  /// @throws InputError (axes that do not span space, no points)
  virtual GridPtr resample(const GridPtr& map, const Lattice& lattice) = 0;

  /// The potential of smeared charges in a periodic cell, the reciprocal part of the Ewald sum, on a grid over the
  /// cell:
  ///
  ///     phi(n) = C sum_{m != 0} exp(-pi^2 m^2 / beta^2) / (pi V m^2) B(m) Q(m) e^(2 pi i k.n/K)   [kT/e]
  ///
  /// Q is the transform of the charges spread by centred B-splines, B the inverse of the splines' own transform, and C
  /// = 332.0636 / (T 0.001987191) (Essmann et al., J. Chem. Phys. 103, 8577 (1995)). Omitting m = 0 makes the mean zero
  /// and stands for a uniform background that neutralizes a net charge. Modes at half the grid's frequency are omitted
  /// too, since a real grid cannot hold their phase. Atoms outside the cell are wrapped into it.
  ///
  /// With `compatible` the order is 4, B is squared, V truncated, and modes at half the frequency are kept; the values
  /// then are the splines' coefficients rather than the potential, as PMEPot writes them.
  ///
  /// The map is periodic; its points are lattice_over(cell, size). The same bits for any order of the atoms and any
  /// number of threads. Time grows with atoms * order^3 + K^3 log K.
  ///
  /// With PmePart::kFull samples have the direct part too, C sum q erfc(beta r) / r over all images within 3.5 / beta
  /// (the rest is below 1e-6 of a charge's own potential), less its mean C pi Q / (beta^2 V): the potential of point
  /// charges in a uniform background, whose mean over the cell is zero and which does not depend on beta. Distances
  /// below 0.5 A count as 0.5 A.
  ///
  /// @param positions [atom] Angstrom, the map's frame  @param charges [atom] elementary charges
  /// @param to_map    common frame -> the frame of `positions` and of the map
  /// @throws InputError (cell without volume, values that are not finite, no charges, sizes, order, Ewald factor),
  ///         MemoryError, DeviceError (the library of Fourier transforms is absent), Cancelled
  virtual GridPtr pme_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                const PmeCell& cell, const PmeOptions& options, const RigidTransform& to_map,
                                const Progress& progress) = 0;

  /// The same map with its zero in the bulk: the mean over its points that lie farther than a distance from all images
  /// of the solute's atoms. Where there are none, the zero stays. The mean is that of the smooth part, from which the
  /// full potential's differs by what the direct part leaves at the border of that region.
  /// @param map    periodic  @param solute [atom] Angstrom, the map's own frame
  /// @param report may be null
  /// @throws InputError (a map that is not periodic, values that are not finite)
  virtual GridPtr zero_in_bulk(const GridPtr& map, const std::vector<Vec3d>& solute, double distance_A,
                               BulkZero* report) = 0;

  /// Isolated charges as a map: Coulomb's law as in coulomb_potential(), summed where it is sampled, in double
  /// precision. It has no points of its own. Time of a sample grows with the number of atoms.
  /// @param positions [atom] Angstrom  @param to_map common frame -> the frame of `positions`
  /// @throws InputError (dielectric, values that are not finite, no charges)
  virtual GridPtr isolated_charges(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                   const CoulombOptions& options, const RigidTransform& to_map) = 0;

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
  /// ions may be, otherwise 0. With `nonlinear` sinh(phi) stands for phi in the ions' term. docs/potentials.md has the
  /// definitions. The map is not periodic; zero is the potential far away. The same bits for any order of the atoms and
  /// any number of threads. Time grows with the number of grid points.
  ///
  /// @param positions [atom] Angstrom, the map's frame  @param radii [atom] Angstrom; 0 takes no room
  /// @param charges   [atom] elementary charges
  /// @param lattice   cubic, along the axes; see poisson_boltzmann_lattice()
  /// @param to_map    common frame -> the frame of `positions` and of the map
  /// @param start     where the iteration starts: a potential of this engine in the same frame, such as that of a
  /// trajectory's frame before, on any lattice; null for the wider grid's, or zero
  /// @param report    receives the solver's report; may be null
  /// @throws InputError (parameters, lattice, no charges, charges without radius outside all atoms), MemoryError,
  ///         ConvergenceError (with the residual), Cancelled
  virtual GridPtr poisson_boltzmann(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                    const std::vector<float>& charges, const Lattice& lattice,
                                    const PoissonBoltzmannOptions& options, const RigidTransform& to_map,
                                    const GridPtr& start, const Progress& progress, PoissonBoltzmannReport* report) = 0;

  /// [reading][atom] what each charge adds to readings of the potential that it is part of, kT/e. A computed potential
  /// is linear in its charges, so that the contributions add up to the reading: each is the transpose of all that made
  /// the map and samples it. pb solves its equation once for each reading (its operator is symmetric), all with the
  /// same coefficients; coulomb and pme take the weights as charges and read their potential at the atoms. Time: at
  /// most that of the map for each reading. A probe is a charge that the map is not made of: what it would add, with
  /// the map's coefficients kept.
  /// @param map    of poisson_boltzmann(), pme_potential(), zero_in_bulk(), isolated_charges() or without_values(); the
  /// contributions are in the order of its charges, then the probes
  /// @param probes in the common frame
  /// @throws InputError (a map that was not computed, the nonlinear equation, a point or a probe outside the map),
  ///         MemoryError, ConvergenceError, Cancelled
  virtual std::vector<std::vector<double>> contributions(const GridPtr& map,
                                                         const std::vector<PotentialReading>& readings,
                                                         const std::vector<ProbeCharge>& probes,
                                                         const Progress& progress) = 0;
  /// The charges and the equation of a computed map: enough for contributions(), where the potential itself is not
  /// needed any more. Of a map that was not computed nothing is left, which contributions() refuses.
  virtual GridPtr without_values(const GridPtr& map) = 0;

  /// Compares potentials at corresponding vertices.
  /// @param source, mapped  meshes of one topology: each vertex on the source and on the target
  /// @param source_potential, target_potential [vertex]
  /// @param excluded [triangle] nonzero to exclude; null includes all. Triangles with a NaN sample are always excluded.
  /// @param path_length [vertex] for its mean; null for none
  virtual Metrics compare(const MeshPtr& source, const MeshPtr& mapped, const ScalarsPtr& source_potential,
                          const ScalarsPtr& target_potential, const ScalarsPtr& excluded,
                          const ScalarsPtr& path_length = nullptr) = 0;

  virtual FitReport fit(const MeshPtr& mapped, const AtomsPtr& target_atoms, float isovalue) = 0;
  /// Exact distances from the corners and centroids of `from` to the triangles of `to`.
  virtual DistanceSummary distances(const MeshPtr& from, const MeshPtr& to, double limit_A) = 0;
  /// The fit of a mesh without some of its triangles, from that of the whole mesh; the same bits as fit() gives.
  /// @param part    without(mesh, removed)  @param whole from fit()
  /// @param removed [triangle of the whole]
  virtual FitReport fit_without(const MeshPtr& part, const FitReport& whole, const ScalarsPtr& removed) = 0;
  /// The distances of a mesh without some of its triangles, from those of the whole mesh; the same bits as distances()
  /// gives.
  /// @param part without(mesh, removed)  @param whole from distances()
  virtual DistanceSummary distances_without(const MeshPtr& part, const MeshPtr& mesh, const DistanceSummary& whole,
                                            const ScalarsPtr& removed, double limit_A) = 0;
  /// Pairs of intersecting triangles, as CGAL's Polygon_mesh_processing::self_intersections counts them:
  /// - two triangles without a shared vertex that have a point in common, touching included;
  /// - two that share a vertex and have another point in common;
  /// - two that share an edge and are folded flat onto each other (in one plane, on the same side of the edge);
  /// - a triangle without area (corners collinear or not finite) as a pair with itself, and in no other.
  ///
  /// Exact for all float positions: where an error bound in double precision leaves a sign open, the determinant is
  /// computed exactly. A tree finds every pair whose boxes overlap: time grows as n log n with the number of triangles,
  /// and with the number of such pairs.
  virtual IntersectionReport self_intersections(const MeshPtr& mesh) = 0;
  virtual double area(const MeshPtr& mesh) = 0;
  /// Maps the vertices of `points` by the mapping from `surface` to `image`: each goes from its nearest point on
  /// `surface` to the corresponding point of `image` (linear within a triangle), or to NaN if it is farther than
  /// `max_distance_A` from `surface`.
  /// @param surface, image meshes of one topology
  /// @returns a mesh of the topology of `points`
  /// @throws GeometryError if the topologies differ in size
  virtual MeshPtr carry(const MeshPtr& points, const MeshPtr& surface, const MeshPtr& image, double max_distance_A) = 0;
  /// Moves a mesh with rigid motions of the atoms: each vertex by the density-weighted mean of the surrounding atoms'
  /// motions.
  /// @param domains [residue] index of its motion, -1 for none; residues as given to upload_atoms()
  /// @throws GeometryError (an index beyond the motions)
  virtual MeshPtr carry_rigidly(const MeshPtr& mesh, const AtomsPtr& atoms, const std::vector<std::int32_t>& domains,
                                const std::vector<RigidTransform>& motions) = 0;
  /// Compares the triangles of two meshes of one topology (Smith and Schaefer, ACM Trans. Graph. 34, 70 (2015), for the
  /// energy).
  /// @param limit of the ratio of areas, mapped to source, measured over the one-rings of a triangle's corners
  /// @throws GeometryError if the topologies differ in size
  virtual DistortionReport distortion(const MeshPtr& source, const MeshPtr& mapped, double limit) = 0;

  /// [vertex] slip of a mapping, Angstrom: the distance of a mapped point from the place to which its own atoms carried
  /// it. The source's atoms near the vertex, weighted by their density there, carry it along their paths, with the
  /// rotations of their surroundings. The place is the nearest one on the target's surface that belongs to the pairs of
  /// these atoms (those with at least 5 % of the density); a point of the target's surface belongs to the pair with the
  /// largest density there. If the pairs have no surface on the target, it is the carried position itself.
  /// NaN where most of the density is of atoms that belong to no pair.
  /// @param source, mapped meshes of one topology  @param target the target's surface
  /// @param atoms the paths of all atoms, see MovingAtom::pair
  /// @throws GeometryError if the topologies differ in size
  virtual std::vector<float> slip(const MeshPtr& source, const MeshPtr& mapped, const MeshPtr& target,
                                  const std::vector<MovingAtom>& atoms) = 0;

  /// [vertex] index of the residue with the largest density at the vertex; -1 where no atom reaches.
  virtual std::vector<std::int32_t> vertex_residues(const MeshPtr& mesh, const AtomsPtr& atoms) = 0;
  /// [vertex] values of atoms, carried to a surface as AtomValues::weight says. NaN where no atom with a value reaches,
  /// and of a mean where most of the density is of atoms without a value. Equal values give exactly that value.
  /// @throws InputError (numbers of widths and values, no atom with a value, values that no atom of positive width has)
  virtual std::vector<float> atom_field(const MeshPtr& mesh, const AtomValues& atoms) = 0;
  /// [vertex] |a - b| for two meshes of one topology, Angstrom.
  virtual ScalarsPtr displacement(const MeshPtr& a, const MeshPtr& b) = 0;

  virtual std::size_t n_vertices(const MeshPtr& mesh) const = 0;
  virtual std::size_t n_triangles(const MeshPtr& mesh) const = 0;
  /// Uploads a mesh, which must be closed and consistently oriented.
  /// @throws GeometryError naming the first edge that does not lie in exactly two triangles
  virtual MeshPtr upload_mesh(const Mesh& mesh) = 0;
  /// A mesh with the topology of `mesh` and other positions.
  /// @param positions [vertex]
  /// @throws GeometryError if the numbers of vertices differ
  virtual MeshPtr with_positions(const MeshPtr& mesh, const std::vector<Vec3f>& positions) = 0;
  /// [vertex]
  virtual std::vector<Vec3f> download_positions(const MeshPtr& mesh) = 0;
  /// Positions and triangles.
  virtual Mesh download_shape(const MeshPtr& mesh) = 0;
  /// Positions, triangles, component labels and outward vertex normals (area-weighted mean of the triangles'). Labels
  /// and normals are computed by each call.
  virtual Mesh download(const MeshPtr& mesh) = 0;
  virtual std::vector<float> download(const ScalarsPtr& scalars) = 0;
  virtual ScalarsPtr upload_scalars(const std::vector<float>& values) = 0;
  virtual Grid download(const GridPtr& grid) = 0;
  /// The field's scalar.
  virtual Grid download(const FieldPtr& field) = 0;
  /// [point] the field's gradient, or the direction used in its place.
  virtual std::vector<Vec3f> download_gradient(const FieldPtr& field) = 0;
  /// Analytic density [point] in the common frame.
  virtual std::vector<float> density_at(const AtomsPtr& atoms, const std::vector<Vec3f>& points) = 0;
};

}  // namespace espdiff
