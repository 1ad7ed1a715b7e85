// backbone_trace.cpp: stretches of residues, and the trace as text.
#include "base/molecule/backbone_trace.h"

#include <doctest/doctest.h>

#include <string>

#include "base/error.h"

using namespace espdiff;

namespace {

/// Residues along x, 3.8 A apart, with a gap of 8 A behind the third.
Molecule broken_chain() {
  Molecule molecule;
  const char* const names[] = {"CA", "C", "O"};
  for (int r = 0; r < 5; ++r) {
    const double x = 3.8 * r + (r > 2 ? 8 : 0);
    const Vec3d places[] = {{x, 0, 0}, {x + 1.5, 0, 0}, {x + 1.5, 1.2, 0}};
    Residue residue;
    residue.name = "GLY";
    residue.chain = "A";
    residue.number = r + 1;
    molecule.residues.push_back(residue);
    for (int k = 0; k < 3; ++k) {
      Atom atom;
      atom.name = names[k];
      atom.element = k == 2 ? "O" : "C";
      atom.residue = r;
      molecule.atoms.push_back(atom);
      molecule.positions.push_back(places[k]);
    }
  }
  return molecule;
}

}  // namespace

TEST_CASE("a trace has a stretch on each side of a gap, and its sides point from C to O") {
  const BackboneTrace trace = backbone_trace(broken_chain());
  CHECK(trace.chains == std::vector<std::size_t>{3, 2});
  REQUIRE(trace.points.size() == 5);
  CHECK(trace.points[1].x == doctest::Approx(3.8));
  for (const Vec3d& side : trace.sides) CHECK(side.y == doctest::Approx(1));
}

TEST_CASE("a trace as text is read again to two decimals") {
  const BackboneTrace trace = backbone_trace(broken_chain());
  const BackboneTrace read = parse_backbone_trace(to_text(trace));
  CHECK(read.chains == trace.chains);
  REQUIRE(read.points.size() == trace.points.size());
  for (std::size_t i = 0; i < read.points.size(); ++i) {
    CHECK(norm(read.points[i] - trace.points[i]) < 0.01);
    CHECK(norm(read.sides[i] - trace.sides[i]) < 0.01);
  }
  CHECK(to_text(read) == to_text(trace));
  CHECK(parse_backbone_trace("").points.empty());
}

TEST_CASE("a damaged trace is refused") {
  for (const char* text : {"2", "2 1 2 3 0 0 1", "2: 1 2 3 0 0 1", "1: 1 2 3 0 0", "1: 1 2 x 0 0 1", "1: 1 2 nan 0 0 1",
                           "-1:", "99999999999999999999: 1 2 3 0 0 1"})
    CHECK_THROWS_WITH_AS(parse_backbone_trace(text), "the trace of a backbone is damaged", InputError);
}
