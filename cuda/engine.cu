// engine.cu: implements engine.h for one back end: unwraps the handles and calls the stages.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <thread>

#include "base/error.h"
#include "base/handles.h"
#include "cuda/certificate/certificate.h"
#include "cuda/certificate/distortion.h"
#include "cuda/certificate/intersections.h"
#include "cuda/certificate/metrics.h"
#include "cuda/certificate/slip.h"
#include "cuda/deform/deform.h"
#include "cuda/deform/fields.h"
#include "cuda/deform/vector_flow.h"
#include "cuda/device/spatial_order.h"
#include "cuda/device/unwrap.h"
#include "cuda/morph/morph.h"
#include "cuda/potential/bulk_zero.h"
#include "cuda/potential/coulomb.h"
#include "cuda/potential/map_origin.h"
#include "cuda/potential/pb/contributions.h"
#include "cuda/potential/pb/poisson_boltzmann.h"
#include "cuda/potential/pme.h"
#include "cuda/surface/carry.h"
#include "cuda/surface/carry_rigidly.h"
#include "cuda/surface/density/atom_field.h"
#include "cuda/surface/density/density.h"
#include "cuda/surface/density/density_at_points.h"
#include "cuda/surface/density/vertex_residues.h"
#include "cuda/surface/isosurface.h"
#include "cuda/surface/level_set_curvature.h"
#include "cuda/surface/level_set_normals.h"
#include "cuda/surface/mesh/adjacency.h"
#include "cuda/surface/mesh/components.h"
#include "cuda/surface/mesh/subdivide.h"
#include "cuda/surface/mesh/submesh.h"
#include "cuda/surface/project.h"
#include "cuda/surface/sample.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/field_stage.h"
#include "engine/make_engine.h"
#include "engine/morph_stage.h"
#include "engine/potential_stage.h"
#include "engine/surface_stage.h"

#if defined(ESPDIFF_BACKEND_CUDA)
#include <cuda_runtime_api.h>
#include <thrust/system_error.h>

#include "cuda/device/cuda_context.h"
#endif

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Calls a stage and translates the back end's exceptions into espdiff errors.
template <typename Stage>
auto guarded(Stage stage) -> decltype(stage()) {
  try {
    return stage();
  } catch (const Error&) {
    throw;
#if defined(ESPDIFF_BACKEND_CUDA)
  } catch (const thrust::system_error& error) {
    cudaGetLastError();
    throw_cuda_error(static_cast<cudaError_t>(error.code().value()), "sorting or summing", facts_of_current_device());
#endif
  } catch (const std::bad_alloc&) {
    throw MemoryError("not enough memory for this surface; use a larger grid spacing or fewer atoms");
  }
}

/// Without the fourth components.
std::vector<Vec3f> host_vectors(const Buffer<Vec4f>& padded) {
  std::vector<Vec3f> result;
  result.reserve(padded.size());
  for (const Vec4f& v : to_host(padded)) result.push_back(v.xyz());
  return result;
}

/// Positions and triangles.
Mesh host_shape(const SurfaceMesh& surface) {
  Mesh result;
  result.positions = host_vectors(surface.positions);
  result.triangles.reserve(surface.n_triangles());
  for (const Corners& t : to_host(surface.topology->triangles)) result.triangles.push_back({t.v[0], t.v[1], t.v[2]});
  return result;
}

/// Every directed edge must have exactly one opposite; otherwise the one-rings are not rings.
void check_closed(const Mesh& mesh) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (t[c] >= mesh.positions.size())
        throw GeometryError("a triangle names vertex " + std::to_string(t[c]) + ", which does not exist");
      if (t[c] == t[(c + 1) % 3]) throw GeometryError("a triangle names vertex " + std::to_string(t[c]) + " twice");
      edges.push_back(static_cast<std::uint64_t>(t[c]) << 32 | t[(c + 1) % 3]);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::uint64_t opposite = edges[e] << 32 | edges[e] >> 32;
    const bool repeated = e > 0 && edges[e] == edges[e - 1];
    if (repeated || !std::binary_search(edges.begin(), edges.end(), opposite)) {
      throw GeometryError("the mesh is not closed or not consistently oriented: edge " +
                          std::to_string(edges[e] >> 32) + " - " + std::to_string(edges[e] & 0xFFFFFFFFU) +
                          " does not lie in exactly two triangles");
    }
  }
}

class BackEndEngine : public Engine {
 public:
#if defined(ESPDIFF_BACKEND_CUDA)
  explicit BackEndEngine(int device) : context_(std::make_shared<CudaContext>(device)) {}
  ~BackEndEngine() override {
    try {
      const CudaContext::Use use(context_);
      pme_ = {};  // its plans belong to the device
    } catch (const Error&) {
      // A lost device has nothing to release.
    }
  }

  std::string back_end() const override { return "cuda"; }
  std::string description() const override { return describe_device(context_->device()); }
  int n_threads() const override { return 0; }
  std::unique_ptr<Engine> beside(int) const override { return std::make_unique<BackEndEngine>(context_->device()); }
#else
  explicit BackEndEngine(int n_threads) : n_threads_(n_threads) {}

  std::string back_end() const override { return "cpu"; }
  std::string description() const override {
    return std::to_string(n_threads_) + (n_threads_ == 1 ? " thread" : " OpenMP threads");
  }
  int n_threads() const override { return n_threads_; }
  std::unique_ptr<Engine> beside(int n_threads) const override { return std::make_unique<BackEndEngine>(n_threads); }
#endif

  double elapsed_ms(const std::function<void()>& calls) override {
#if defined(ESPDIFF_BACKEND_CUDA)
    const CudaContext::Use use(context_);
    return context_->elapsed_ms(calls);
#else
    const auto start = std::chrono::steady_clock::now();
    calls();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
#endif
  }

  AtomsPtr upload_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& widths,
                        const std::vector<std::int32_t>& residues) override {
    if (widths.size() != positions.size() || residues.size() != positions.size()) {
      throw InputError("upload_atoms: positions, widths and residues differ in number");
    }
    return run([&] { return make_atom_cells(positions, widths, residues); });
  }

  GridPtr density(const AtomsPtr& atoms, double spacing_A) override {
    return run([&] {
      const auto& cells = unwrap<AtomCells>(atoms);
      const CubicLattice lattice = density_lattice(cells, spacing_A);
#if defined(ESPDIFF_BACKEND_CUDA)
      return density_by_points(cells, lattice);
#else
      return density_by_slabs(cells, lattice);
#endif
    });
  }

  MeshPtr isosurface(const GridPtr& density, float isovalue) override {
    return run([&] { return ESPDIFF_BACKEND::isosurface(unwrap<DensityGrid>(density), isovalue); });
  }

  std::vector<ComponentSummary> components(const MeshPtr& mesh) override {
    return run([&] {
      const auto& surface = unwrap<SurfaceMesh>(mesh);
      return summarize_components(surface, label_components(surface));
    });
  }

  MeshPtr keep_components(const MeshPtr& mesh, const std::vector<bool>& keep) override {
    return run([&] {
      const auto& surface = unwrap<SurfaceMesh>(mesh);
      return ESPDIFF_BACKEND::keep_components(surface, label_components(surface), keep);
    });
  }

  MeshPtr without(const MeshPtr& mesh, const ScalarsPtr& excluded) override {
    return run([&] {
      const auto& flags = unwrap<Scalars>(excluded).values;
      Buffer<std::uint8_t> kept(flags.size());
      const float* const flag = raw(flags);
      std::uint8_t* const keep = raw(kept);
      for_each_index(flags.size(), [=] ESPDIFF_HD(std::size_t t) { keep[t] = flag[t] == 0.0F ? 1 : 0; });
      return keep_triangles(unwrap<SurfaceMesh>(mesh), kept);
    });
  }

  MeshPtr project(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue, double max_shift_A) override {
    return run([&] {
      return ESPDIFF_BACKEND::project(unwrap<SurfaceMesh>(mesh), unwrap<AtomCells>(atoms), isovalue,
                                      static_cast<float>(max_shift_A));
    });
  }

  std::vector<Vec3f> level_set_normals(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue) override {
    return run([&] {
      return host_vectors(
          ESPDIFF_BACKEND::level_set_normals(unwrap<SurfaceMesh>(mesh), unwrap<AtomCells>(atoms), isovalue));
    });
  }

  std::vector<float> level_set_curvature(const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue) override {
    return run([&] {
      return to_host(
          ESPDIFF_BACKEND::level_set_curvature(unwrap<SurfaceMesh>(mesh), unwrap<AtomCells>(atoms), isovalue));
    });
  }

  FieldPtr density_field(const GridPtr& density, float isovalue) override {
    return run([&] { return ESPDIFF_BACKEND::density_field(unwrap<DensityGrid>(density), isovalue); });
  }

  FieldPtr distance_field(const GridPtr& density, float isovalue, const MeshPtr& surface, double threshold_A,
                          const Progress& progress) override {
    return run([&] {
      return ESPDIFF_BACKEND::distance_field(unwrap<DensityGrid>(density), isovalue, unwrap<SurfaceMesh>(surface),
                                             static_cast<float>(threshold_A), progress);
    });
  }

  FieldPtr gvf_field(const GridPtr& target_density, const GridPtr& source_density, float isovalue,
                     const VectorFlowOptions& options, const Progress& progress, VectorFlowReport* report) override {
    return run([&] {
      const DensityGrid* const source = source_density ? &unwrap<DensityGrid>(source_density) : nullptr;
      return vector_flow(unwrap<DensityGrid>(target_density), source, isovalue, options, progress, report);
    });
  }

  MeshPtr deform(const MeshPtr& mesh, const FieldPtr& field, const DeformOptions& options, const std::string& stage,
                 const Progress& progress, DeformReport* report, const MeshPtr& rest) override {
    return run([&] {
      return ESPDIFF_BACKEND::deform(unwrap<SurfaceMesh>(mesh), unwrap<SurfaceMesh>(rest ? rest : mesh),
                                     unwrap<SurfaceField>(field), options, stage, progress, report);
    });
  }

  SubdivisionResult subdivide(const MeshPtr& source, const MeshPtr& mapped, double max_edge_A) override {
    return run([&] {
      return ESPDIFF_BACKEND::subdivide(unwrap<SurfaceMesh>(source), unwrap<SurfaceMesh>(mapped),
                                        static_cast<float>(max_edge_A));
    });
  }

  MorphResult morph(const MeshPtr& mesh, const std::vector<MovingAtom>& atoms, const AtomsPtr& source_atoms,
                    const AtomsPtr& target_atoms, const MorphOptions& options, const std::string& stage,
                    const Progress& progress) override {
    return run([&] {
      return ESPDIFF_BACKEND::morph(unwrap<SurfaceMesh>(mesh), atoms, unwrap<AtomCells>(source_atoms),
                                    unwrap<AtomCells>(target_atoms), options, stage, progress);
    });
  }

  MorphResult continue_morph(const MorphResult& so_far, const std::vector<MovingAtom>& atoms,
                             const AtomsPtr& source_atoms, const AtomsPtr& target_atoms, const MorphOptions& options,
                             const std::string& stage, const Progress& progress) override {
    return run([&] {
      return ESPDIFF_BACKEND::continue_morph(so_far, atoms, unwrap<AtomCells>(source_atoms),
                                             unwrap<AtomCells>(target_atoms), options, stage, progress);
    });
  }

  GridPtr upload_map(const Grid& map, const RigidTransform& to_map) override {
    return run([&] { return make_map(map, to_map); });
  }

  ScalarsPtr sample(const GridPtr& map, const MeshPtr& mesh) override {
    return run([&] { return ESPDIFF_BACKEND::sample(unwrap<MapGrid>(map), unwrap<SurfaceMesh>(mesh)); });
  }

  std::vector<Vec3f> sample_gradient(const GridPtr& map, const MeshPtr& mesh) override {
    return run([&] {
      return host_vectors(ESPDIFF_BACKEND::sample_gradient(unwrap<MapGrid>(map), unwrap<SurfaceMesh>(mesh)));
    });
  }

  GridPtr resample(const GridPtr& map, const Lattice& lattice) override {
    return run([&] { return ESPDIFF_BACKEND::resample(unwrap<MapGrid>(map), lattice); });
  }

  GridPtr pme_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges, const PmeCell& cell,
                        const PmeOptions& options, const RigidTransform& to_map, const Progress& progress) override {
    return run([&] {
      try {
        return pme_.potential(positions, charges, cell, options, to_map, progress);
      } catch (const std::bad_alloc&) {
        throw MemoryError("not enough memory for this potential's grid; use a coarser grid or single precision");
      }
    });
  }

  GridPtr zero_in_bulk(const GridPtr& map, const std::vector<Vec3d>& solute, double distance_A,
                       BulkZero* report) override {
    return run([&] { return ESPDIFF_BACKEND::zero_in_bulk(unwrap<MapGrid>(map), solute, distance_A, report); });
  }

  GridPtr isolated_charges(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                           const CoulombOptions& options, const RigidTransform& to_map) override {
    return run([&] { return ESPDIFF_BACKEND::isolated_charges(positions, charges, options, to_map); });
  }

  GridPtr coulomb_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                            const Lattice& lattice, const CoulombOptions& options, const Progress& progress) override {
    return run([&] { return ESPDIFF_BACKEND::coulomb_potential(positions, charges, lattice, options, progress); });
  }

  GridPtr poisson_boltzmann(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                            const std::vector<float>& charges, const Lattice& lattice,
                            const PoissonBoltzmannOptions& options, const RigidTransform& to_map, const GridPtr& start,
                            const Progress& progress, PoissonBoltzmannReport* report) override {
    return run([&] {
      return ESPDIFF_BACKEND::poisson_boltzmann(positions, radii, charges, lattice, options, to_map,
                                                start ? &unwrap<MapGrid>(start) : nullptr, progress, report);
    });
  }

  std::vector<std::vector<double>> contributions(const GridPtr& map, const std::vector<PotentialReading>& readings,
                                                 const std::vector<ProbeCharge>& probes,
                                                 const Progress& progress) override {
    return run([&] { return ESPDIFF_BACKEND::contributions(unwrap<MapGrid>(map), readings, probes, pme_, progress); });
  }

  GridPtr without_values(const GridPtr& map) override {
    return run([&] { return ESPDIFF_BACKEND::without_values(unwrap<MapGrid>(map)); });
  }

  Metrics compare(const MeshPtr& source, const MeshPtr& mapped, const ScalarsPtr& source_potential,
                  const ScalarsPtr& target_potential, const ScalarsPtr& excluded,
                  const ScalarsPtr& path_length) override {
    return run([&] {
      return compare_potentials(unwrap<SurfaceMesh>(source), unwrap<SurfaceMesh>(mapped),
                                unwrap<Scalars>(source_potential), unwrap<Scalars>(target_potential),
                                excluded ? &unwrap<Scalars>(excluded) : nullptr,
                                path_length ? &unwrap<Scalars>(path_length) : nullptr);
    });
  }

  FitReport fit(const MeshPtr& mapped, const AtomsPtr& target_atoms, float isovalue) override {
    return run([&] { return fit_to_density(unwrap<SurfaceMesh>(mapped), unwrap<AtomCells>(target_atoms), isovalue); });
  }

  DistanceSummary distances(const MeshPtr& from, const MeshPtr& to, double limit_A) override {
    return run([&] {
      return distance_summary(unwrap<SurfaceMesh>(from), unwrap<SurfaceMesh>(to), static_cast<float>(limit_A));
    });
  }

  FitReport fit_without(const MeshPtr& part, const FitReport& whole, const ScalarsPtr& removed) override {
    return run([&] {
      return ESPDIFF_BACKEND::fit_without(unwrap<SurfaceMesh>(part), whole, unwrap<Scalars>(removed).values);
    });
  }

  DistanceSummary distances_without(const MeshPtr& part, const MeshPtr& mesh, const DistanceSummary& whole,
                                    const ScalarsPtr& removed, double limit_A) override {
    return run([&] {
      return ESPDIFF_BACKEND::distances_without(unwrap<SurfaceMesh>(part), unwrap<SurfaceMesh>(mesh), whole,
                                                unwrap<Scalars>(removed).values, static_cast<float>(limit_A));
    });
  }

  IntersectionReport self_intersections(const MeshPtr& mesh) override {
    return run([&] { return ESPDIFF_BACKEND::self_intersections(unwrap<SurfaceMesh>(mesh)); });
  }

  MeshPtr carry(const MeshPtr& points, const MeshPtr& surface, const MeshPtr& image, double max_distance_A) override {
    return run([&] {
      return ESPDIFF_BACKEND::carry(unwrap<SurfaceMesh>(points), unwrap<SurfaceMesh>(surface),
                                    unwrap<SurfaceMesh>(image), static_cast<float>(max_distance_A));
    });
  }

  MeshPtr carry_rigidly(const MeshPtr& mesh, const AtomsPtr& atoms, const std::vector<std::int32_t>& domains,
                        const std::vector<RigidTransform>& motions) override {
    return run([&]() -> MeshPtr {
      return ESPDIFF_BACKEND::carry_rigidly(unwrap<SurfaceMesh>(mesh), unwrap<AtomCells>(atoms), domains, motions);
    });
  }

  DistortionReport distortion(const MeshPtr& source, const MeshPtr& mapped, double limit) override {
    return run(
        [&] { return ESPDIFF_BACKEND::distortion(unwrap<SurfaceMesh>(source), unwrap<SurfaceMesh>(mapped), limit); });
  }

  std::vector<float> slip(const MeshPtr& source, const MeshPtr& mapped, const MeshPtr& target,
                          const std::vector<MovingAtom>& atoms) override {
    return run([&] {
      return ESPDIFF_BACKEND::slip(unwrap<SurfaceMesh>(source), unwrap<SurfaceMesh>(mapped),
                                   unwrap<SurfaceMesh>(target), atoms);
    });
  }

  double area(const MeshPtr& mesh) override {
    return run([&] { return surface_area(unwrap<SurfaceMesh>(mesh)); });
  }

  std::vector<std::int32_t> vertex_residues(const MeshPtr& mesh, const AtomsPtr& atoms) override {
    return run(
        [&] { return to_host(ESPDIFF_BACKEND::vertex_residues(unwrap<SurfaceMesh>(mesh), unwrap<AtomCells>(atoms))); });
  }

  std::vector<float> atom_field(const MeshPtr& mesh, const AtomValues& atoms) override {
    return run([&] { return to_host(ESPDIFF_BACKEND::atom_field(unwrap<SurfaceMesh>(mesh), atoms)); });
  }

  ScalarsPtr displacement(const MeshPtr& a, const MeshPtr& b) override {
    return run([&] { return ESPDIFF_BACKEND::displacement(unwrap<SurfaceMesh>(a), unwrap<SurfaceMesh>(b)); });
  }

  std::size_t n_vertices(const MeshPtr& mesh) const override { return unwrap<SurfaceMesh>(mesh).n_vertices(); }
  std::size_t n_triangles(const MeshPtr& mesh) const override { return unwrap<SurfaceMesh>(mesh).n_triangles(); }

  MeshPtr upload_mesh(const Mesh& mesh) override {
    return run([&] {
      check_closed(mesh);
      auto result = std::make_shared<SurfaceMesh>();
      result->positions = upload_positions(mesh.positions);
      std::vector<Corners> triangles(mesh.triangles.size());
      std::transform(mesh.triangles.begin(), mesh.triangles.end(), triangles.begin(), [](const Triangle& t) {
        return Corners{{t[0], t[1], t[2]}};
      });
      result->topology = make_topology(mesh.positions.size(), to_device(triangles));
      return result;
    });
  }

  MeshPtr with_positions(const MeshPtr& mesh, const std::vector<Vec3f>& positions) override {
    return run([&] {
      const auto& surface = unwrap<SurfaceMesh>(mesh);
      if (positions.size() != surface.n_vertices())
        throw GeometryError(std::to_string(positions.size()) + " positions for a mesh of " +
                            std::to_string(surface.n_vertices()) + " vertices");
      auto result = std::make_shared<SurfaceMesh>();
      result->topology = surface.topology;
      result->positions = upload_positions(positions);
      return result;
    });
  }

  std::vector<Vec3f> download_positions(const MeshPtr& mesh) override {
    return run([&] { return host_vectors(unwrap<SurfaceMesh>(mesh).positions); });
  }

  Mesh download_shape(const MeshPtr& mesh) override {
    return run([&] { return host_shape(unwrap<SurfaceMesh>(mesh)); });
  }

  Mesh download(const MeshPtr& mesh) override {
    return run([&] {
      const auto& surface = unwrap<SurfaceMesh>(mesh);
      Mesh result = host_shape(surface);
      result.normals = host_vectors(vertex_normals(surface));
      result.component = to_host(label_components(surface).label);
      return result;
    });
  }

  std::vector<float> download(const ScalarsPtr& scalars) override {
    return run([&] { return to_host(unwrap<Scalars>(scalars).values); });
  }

  ScalarsPtr upload_scalars(const std::vector<float>& values) override {
    return run([&] {
      auto scalars = std::make_shared<Scalars>();
      scalars->values = to_device(values);
      return scalars;
    });
  }

  Grid download(const GridPtr& grid) override {
    return run([&] {
      Grid result;
      if (const auto* map = dynamic_cast<const MapGrid*>(grid.get())) {
        if (map->lattice.n_points() == 0)
          throw InputError("isolated charges have no lattice of their own; resample them on one");
        result.lattice = map->lattice;
        result.values = point_values(*map);
        result.unit = map->unit;
        result.periodic = map->periodic;
      } else {
        const auto& density = unwrap<DensityGrid>(grid);
        result.lattice = host_lattice(density.lattice);
        result.values = to_host(density.values);
      }
      return result;
    });
  }

  Grid download(const FieldPtr& field) override {
    return run([&] {
      const auto& surface_field = unwrap<SurfaceField>(field);
      Grid result;
      result.lattice = host_lattice(surface_field.lattice);
      for (const Vec4f& value : to_host(surface_field.values)) result.values.push_back(value.w);
      return result;
    });
  }

  std::vector<Vec3f> download_gradient(const FieldPtr& field) override {
    return run([&] { return host_vectors(unwrap<SurfaceField>(field).values); });
  }

  std::vector<float> density_at(const AtomsPtr& atoms, const std::vector<Vec3f>& points) override {
    return run([&] {
      const Buffer<Vec4f> where = upload_positions(points);
      Buffer<DensitySample> samples(points.size());
      density_at_points(unwrap<AtomCells>(atoms), where, spatial_order(where), points.size(), samples);
      std::vector<float> values;
      for (const DensitySample& sample : to_host(samples)) values.push_back(sample.value);
      return values;
    });
  }

 private:
  static Buffer<Vec4f> upload_positions(const std::vector<Vec3f>& positions) {
    std::vector<Vec4f> padded(positions.size());
    std::transform(positions.begin(), positions.end(), padded.begin(), [](Vec3f p) { return make_vec4(p, 0.0F); });
    return to_device(padded);
  }

#if defined(ESPDIFF_BACKEND_CUDA)
  /// Runs a stage on this engine's device and waits for it, so that its errors are reported by this call.
  template <typename Stage>
  auto run(Stage stage) const -> decltype(stage()) {
    const CudaContext::Use use(context_);
    return guarded([&] {
      auto result = stage();
      context_->synchronize();
      return result;
    });
  }

  std::shared_ptr<CudaContext> context_;
#else
  /// Sets the number of threads for this call, since another engine may have changed it, and translates exceptions.
  template <typename Stage>
  auto run(Stage stage) const -> decltype(stage()) {
    omp_set_num_threads(n_threads_);
    return guarded(stage);
  }

  int n_threads_;
#endif
  PmeSolver pme_;
};

}  // namespace

Lattice host_lattice(const CubicLattice& lattice) {
  const double h = static_cast<double>(lattice.spacing);
  return {{lattice.size[0], lattice.size[1], lattice.size[2]},
          static_cast<Vec3d>(lattice.origin),
          {{{h, 0, 0}, {0, h, 0}, {0, 0, h}}}};
}

#if defined(ESPDIFF_BACKEND_CUDA)

std::unique_ptr<Engine> make_engine(int device) { return std::make_unique<BackEndEngine>(device); }

std::vector<CudaDeviceStatus> probe_devices(Message* why_none) {
  int n = 0;
  const cudaError_t status = cudaGetDeviceCount(&n);
  cudaGetLastError();
  const CudaFacts facts = facts_of_current_device();
  try {
    if (status != cudaSuccess) throw_cuda_error(status, "looking for GPUs", facts);
    if (n == 0) throw_cuda_error(cudaErrorNoDevice, "looking for GPUs", facts);
  } catch (const Error& error) {
    *why_none = error.message();
    return {};
  }
  std::vector<CudaDeviceStatus> devices;
  for (int device = 0; device < n; ++device) {
    int major = 0, minor = 0;
    cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device);
    cudaDeviceGetAttribute(&minor, cudaDevAttrComputeCapabilityMinor, device);
    CudaDeviceStatus found{true, describe_device(device)};
    if (!has_code_for(facts.architectures, 10 * major + minor)) {
      CudaFacts of_it = facts;
      of_it.device = found.description.plain();
      of_it.capability = 10 * major + minor;
      try {
        throw_cuda_error(cudaErrorNoKernelImageForDevice, "looking for GPUs", of_it);
      } catch (const Error& error) {
        found = {false, error.message()};
      }
    }
    devices.push_back(found);
  }
  return devices;
}

#else

std::unique_ptr<Engine> make_engine(int n_threads) { return std::make_unique<BackEndEngine>(n_threads); }

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
