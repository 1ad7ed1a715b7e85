// residues.cpp: the residue of a surface point, against a full search.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "cuda/surface/read_atoms.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

/// Densities at a point by residue: the largest two.
struct Ranking {
  std::int32_t residue = -1;
  double first = 0, second = 0;
};

Ranking rank_residues(const AtomSet& atoms, Vec3d p) {
  std::map<std::int32_t, double> density;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const double s = static_cast<double>(atoms.widths[i]);
    if (s > 0)
      density[atoms.residues[i]] += std::exp(-dot(p - atoms.positions[i], p - atoms.positions[i]) / (2 * s * s));
  }
  Ranking ranking;
  for (const auto& [residue, value] : density) {
    if (value > ranking.first) {
      ranking.second = ranking.first;
      ranking.first = value;
      ranking.residue = residue;
    } else {
      ranking.second = std::max(ranking.second, value);
    }
  }
  return ranking;
}

struct SearchAgreement {
  std::size_t n = 0, n_different = 0;
  double widest_gap = 0;  ///< relative gap between first and second where the engine chose another
};

SearchAgreement compare_to_search(Engine& engine, const AtomSet& atoms) {
  const auto uploaded = upload(engine, atoms);
  const auto surface = engine.project(engine.isosurface(engine.density(uploaded, 1.0), 0.5F), uploaded, 0.5F, 0.5);
  const std::vector<std::int32_t> residues = engine.vertex_residues(surface, uploaded);
  const Mesh mesh = engine.download(surface);
  REQUIRE(residues.size() == mesh.positions.size());
  SearchAgreement agreement;
  for (std::size_t v = 0; v < residues.size(); v += 3) {
    const Ranking exact = rank_residues(atoms, static_cast<Vec3d>(mesh.positions[v]));
    ++agreement.n;
    if (residues[v] == exact.residue) continue;
    ++agreement.n_different;
    agreement.widest_gap = std::max(agreement.widest_gap, 1 - exact.second / exact.first);
  }
  return agreement;
}

}  // namespace

TEST_SUITE_BEGIN("residues");

TEST_CASE("vertices of a random cloud belong to the residue of highest density") {
  for (const auto& engine : back_ends()) {
    const SearchAgreement a = compare_to_search(*engine, random_cloud(300, 110));
    CHECK(static_cast<double>(a.n_different) < 4e-3 * static_cast<double>(a.n));  // neighbours without bonds: near ties
    CHECK(a.widest_gap < 0.03);
  }
}

TEST_CASE("vertices of real proteins belong to the residue of highest density except at ties") {
  for (const std::string name : {"ubq/ubq.pqr", "pair_t4l_maps/3lzm.pqr"}) {
    const auto path = real_input(name);
    if (!path) return;
    for (const auto& engine : back_ends()) {
      const SearchAgreement a = compare_to_search(*engine, read_atoms(*path));
      std::printf("residues, %s, %s: %zu of %zu vertices differ from the full sum, by at most %.2f %% of the density\n",
                  engine->back_end().c_str(), name.c_str(), a.n_different, a.n, 100 * a.widest_gap);
      CAPTURE(name);
      CHECK(static_cast<double>(a.n_different) < 1e-3 * static_cast<double>(a.n));
      // Terms below e^-6 are omitted: ten of them make 2.5 %.
      CHECK(a.widest_gap < 0.03);
    }
  }
}

TEST_CASE("ties go to the residue of smaller index; no residue in reach is -1") {
  for (const auto& engine : back_ends()) {
    AtomSet atoms;
    atoms.add({0, 0, 0}, 1.5, 7);
    atoms.add({0, 0, 0}, 1.5, 3);
    const auto uploaded = upload(*engine, atoms);
    CHECK(engine->vertex_residues(engine->upload_mesh(icosphere(1, 1.5)), uploaded) ==
          std::vector<std::int32_t>(42, 3));
    CHECK(engine->vertex_residues(engine->upload_mesh(icosphere(1, 30)), uploaded) ==
          std::vector<std::int32_t>(42, -1));
  }
}

TEST_CASE("a surface at a low isovalue has residues wherever an atom reaches") {
  // At 0.001 a lone atom's surface lies at 3.7 widths, within the reach of 4.5.
  for (const auto& engine : back_ends()) {
    const auto atoms = upload(*engine, one_gaussian({0, 0, 0}, 1.5));
    const auto surface = engine->isosurface(engine->density(atoms, 1.0), 0.001F);
    std::size_t n_without = 0;
    for (const std::int32_t residue : engine->vertex_residues(surface, atoms)) n_without += residue == 0 ? 0 : 1;
    CHECK(n_without == 0);
  }
}

TEST_SUITE_END();
