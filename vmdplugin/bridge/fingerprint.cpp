// fingerprint.cpp: hashes member by member.
#include "fingerprint.h"

#include "base/types.h"
#include "io/files/sha256.h"

namespace espdiff {
namespace {

template <typename T>
void add(Sha256& hash, const std::vector<T>& values) {
  hash.update(values.data(), values.size() * sizeof(T));
}

void add(Sha256& hash, const Vec3d& v) {
  const double members[] = {v.x, v.y, v.z};
  hash.update(members, sizeof members);
}

}  // namespace

std::string fingerprint(const Molecule& molecule) {
  Sha256 hash;
  add(hash, molecule.positions);
  add(hash, molecule.radii);
  add(hash, molecule.charges);
  return hash.finish();
}

std::string fingerprint(const Grid& map) {
  Sha256 hash;
  for (const int n : map.lattice.size) hash.update(&n, sizeof n);
  add(hash, map.lattice.origin);
  for (const Vec3d& step : map.lattice.step) add(hash, step);
  add(hash, map.values);
  return hash.finish();
}

}  // namespace espdiff
