// real_surfaces.cpp: every real structure, including badly written ones, has closed manifold surfaces of even Euler
// characteristic.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/read_atoms.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

std::vector<std::string> structure_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".pqr" || extension == ".pdb" || extension == ".cif") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void check_surface(Engine& engine, const AtomSet& atoms) {
  const auto uploaded = upload(engine, atoms);
  const auto surface = engine.isosurface(engine.density(uploaded, 1.0), 0.5F);
  const Mesh mesh = engine.download(surface);
  CHECK(manifold_fault(mesh) == "");
  CHECK(mesh.component == components_oracle(mesh));
  const auto components = engine.components(surface);
  REQUIRE(!components.empty());
  double largest = 0;
  for (const auto& component : components) {
    CHECK((static_cast<long>(component.n_vertices) - static_cast<long>(component.n_triangles / 2)) % 2 == 0);
    if (std::fabs(component.volume_A3) > std::fabs(largest)) largest = component.volume_A3;
  }
  CHECK(largest > 0);  // an outer surface, not a cavity
  CHECK(signed_volume(mesh) > 0);
  float normal_error = 0;
  for (const Vec3f& n : mesh.normals) normal_error = std::max(normal_error, std::fabs(norm(n) - 1));
  CHECK(normal_error < 1e-5F);
  const Mesh projected = engine.download(engine.project(surface, uploaded, 0.5F, 0.5));
  CHECK(projected.triangles == mesh.triangles);
  CHECK(signed_volume(projected) > 0);
}

}  // namespace

TEST_SUITE_BEGIN("surface");

TEST_CASE("surfaces of all real structures are closed manifolds") {
  const auto folder = real_input("");
  if (!folder) return;
  const auto engines = back_ends();
  std::size_t n_read = 0, n_refused = 0;
  for (const std::string& path : structure_files(*folder)) {
    CAPTURE(path);
    AtomSet atoms;
    try {
      atoms = read_atoms(path);
    } catch (const espdiff::Error& error) {
      // The reader refuses it, which has its own tests; here only the refusal matters.
      ++n_refused;
      MESSAGE("SKIPPED: ", std::string(error.what()));
      continue;
    }
    ++n_read;
    for (const auto& engine : engines) check_surface(*engine, atoms);
  }
  std::printf("real structures: %zu surfaces checked, %zu files refused by the reader\n", n_read, n_refused);
  CHECK(n_read >= 30);
}

TEST_CASE("a real surface is closed at any spacing, and its area converges") {
  const auto path = real_input("ubq/ubq.pqr");
  if (!path) return;
  const AtomSet atoms = read_atoms(*path);
  for (const auto& engine : back_ends()) {
    std::vector<double> area;
    for (const double spacing : {2.0, 1.0, 0.5}) {
      const auto surface = engine->isosurface(engine->density(upload(*engine, atoms), spacing), 0.5F);
      const Mesh mesh = engine->download(surface);
      CAPTURE(spacing);
      CHECK(manifold_fault(mesh) == "");
      area.push_back(engine->area(surface));
    }
    CHECK(std::fabs(area[2] - area[1]) < 0.5 * std::fabs(area[1] - area[0]));
  }
}

TEST_SUITE_END();
