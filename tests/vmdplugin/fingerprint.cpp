// fingerprint.cpp: equal maps have equal hashes, whatever lies between their members.
#include "vmdplugin/bridge/fingerprint.h"

#include <doctest/doctest.h>

#include <cstring>
#include <memory>
#include <new>

#include "base/types.h"

using espdiff::fingerprint;
using espdiff::Grid;

namespace {

/// A map in memory that held `filling` before.
struct Placed {
  explicit Placed(int filling) {
    std::memset(memory, filling, sizeof memory);
    map = new (memory) Grid;
    map->lattice.size = {2, 1, 1};
    map->lattice.origin = {1, 2, 3};
    map->lattice.step = {espdiff::Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    map->values = {4, 5};
  }
  ~Placed() { map->~Grid(); }
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  alignas(Grid) unsigned char memory[sizeof(Grid)];
  Grid* map;
};

}  // namespace

TEST_CASE("fingerprint: a map's hash is of its members alone") {
  const Placed zeros(0), ones(0xff);
  CHECK(fingerprint(*zeros.map) == fingerprint(*ones.map));
}

TEST_CASE("fingerprint: each part of a map counts") {
  const Placed a(0);
  const std::string all = fingerprint(*a.map);
  for (const auto& change : {+[](Grid& g) { g.values[1] = 6; }, +[](Grid& g) { g.lattice.origin.y = 0; },
                             +[](Grid& g) { g.lattice.step[2].x = 1; },
                             +[](Grid& g) {
                               g.lattice.size = {1, 2, 1};
                             }}) {
    Grid changed = *a.map;
    change(changed);
    CHECK(fingerprint(changed) != all);
  }
}
