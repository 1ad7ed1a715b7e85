// mapped_cgal.cpp: the morph's matched part does not intersect itself, by CGAL, on real pairs.
#include <doctest/doctest.h>

#include "certificate/result.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "mapping/input.h"
#include "options/options.h"
#include "support/test_data.h"

#if defined(ESPDIFF_HAVE_CGAL)

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <cstdio>

#include "cuda/certificate/cgal_mesh.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"

using namespace espdiff_test;

TEST_SUITE_BEGIN("morph");

TEST_CASE("CGAL finds no intersection in the matched part") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  for (const auto& [from, to] : {std::pair("series19_ubq_2k39/m00.pqr", "series19_ubq_2k39/m07.pqr"),
                                 {"series19_ubq_2k39/m11.pqr", "series19_ubq_2k39/m05.pqr"},
                                 {"series19_ubq_2k39/m18.pqr", "series19_ubq_2k39/m00.pqr"},
                                 {"pair_tim_maps/dTIM_chainA.pqr", "pair_tim_maps/scTIM_chainA.pqr"}}) {
    const auto source_file = real_input(from), target_file = real_input(to);
    if (!source_file || !target_file) return;
    const espdiff::Molecule source = espdiff::read_structure(*source_file),
                            target = espdiff::read_structure(*target_file);
    espdiff::CompareInput source_input, target_input;
    source_input.molecule = &source;
    target_input.molecule = &target;
    const espdiff::CompareResult result =
        compare(*engine, source_input, target_input, espdiff::CompareOptions{}, espdiff::Progress{});
    const espdiff::MappedSurface& surface = result.surface;
    espdiff::Mesh mesh;
    mesh.triangles = surface.triangles;
    // In the target's frame instead of the common one: rounding is far finer than the distance of two sheets.
    for (const espdiff::Vec3d& p : surface.positions) mesh.positions.push_back(static_cast<espdiff::Vec3f>(p));
    const CgalMesh theirs = cgal_mesh(mesh);
    std::vector<CgalMesh::Face_index> counted, all;
    for (const CgalMesh::Face_index face : theirs.faces()) {
      all.push_back(face);
      if (surface.unmatched[face.idx()] == 0) counted.push_back(face);
    }
    std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> pairs, unmatched_too;
    CGAL::Polygon_mesh_processing::self_intersections(counted, theirs, std::back_inserter(pairs));
    CGAL::Polygon_mesh_processing::self_intersections(all, theirs, std::back_inserter(unmatched_too));
    std::printf("%s onto %s: %zu of %zu triangles have a counterpart, CGAL finds %zu pairs in them, %zu in all\n", from,
                to, counted.size(), all.size(), pairs.size(), unmatched_too.size());
    CHECK(pairs.empty());
    CHECK(result.certificate.self_intersecting_pairs == 0);
    CHECK(counted.size() > all.size() * 9 / 10);
  }
}

TEST_SUITE_END();

#else

TEST_CASE("CGAL finds no intersection in the matched part") {
  MESSAGE("SKIPPED: CGAL was not found when this was built (Debian: libcgal-dev)");
}

#endif
