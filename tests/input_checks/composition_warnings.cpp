// What one state has and the other has not, and what was left out, is said with its charge and place.
#include <doctest/doctest.h>

#include <cmath>

#include "align/pair_atoms.h"
#include "base/not_a_number.h"
#include "compare/made_peptide.h"
#include "input_checks/composition_warnings.h"

using namespace espdiff;
using espdiff_test::add_ion;
using espdiff_test::made_peptide;

namespace {

std::vector<std::string> composition_of(const Molecule& a, const Molecule& b,
                                        const std::vector<std::uint8_t>& region = {}) {
  Alignment alignment;
  alignment.pairing = pair_atoms(a, b);
  std::vector<std::string> texts;
  for (const Warning& warning : composition_warnings(a, b, region, alignment, {}, {})) {
    texts.push_back(warning.text.plain());
    CHECK_FALSE(warning.refuses);
  }
  return texts;
}

}  // namespace

TEST_CASE("composition_warnings: equal molecules have nothing") {
  CHECK(composition_of(made_peptide(12), made_peptide(12)).empty());
}

TEST_CASE("composition_warnings: an ion that is missing, replaced or charged otherwise") {
  const Molecule bare = made_peptide(12);
  Molecule zinc = bare, sodium = bare, negative = bare;
  add_ion(zinc, "ZN", 2);
  add_ion(sodium, "NA", 1);
  add_ion(negative, "ZN", -2);
  CHECK(composition_of(zinc, bare) ==
        std::vector<std::string>{"the source has 1 group that the target has not: ZN 900 of chain A (1 atom, +2 e)"});
  CHECK(composition_of(bare, zinc) ==
        std::vector<std::string>{"the target has 1 group that the source has not: ZN 900 of chain A (1 atom, +2 e)"});
  CHECK(
      composition_of(zinc, sodium) ==
      std::vector<std::string>{"ZN 900 of chain A of the source (1 atom, +2 e) is replaced by NA 900 of chain A in the "
                               "target (1 atom, +1 e)"});
  CHECK(composition_of(zinc, negative) ==
        std::vector<std::string>{"ZN 900 of chain A is charged otherwise in the target: 1 atom, +2 e; there -2 e"});
}

TEST_CASE("composition_warnings: a group near the surface has its area, one far from it none") {
  const Molecule bare = made_peptide(12);
  Molecule zinc = bare;
  add_ion(zinc, "ZN", 2);
  Alignment alignment;
  alignment.pairing = pair_atoms(zinc, bare);
  MappedSurface surface;
  // A triangle of 2 A^2 beside the ion, and one far away.
  surface.source_positions = {{5, -6, 3}, {7, -6, 3}, {5, -4, 3}, {50, 0, 0}, {52, 0, 0}, {50, 2, 0}};
  surface.positions = surface.source_positions;
  surface.triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto warnings = composition_warnings(zinc, bare, {}, alignment, surface, {});
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].text.plain() ==
        "the source has 1 group that the target has not: ZN 900 of chain A (1 atom, +2 e, 2 "
        "A^2 of the surface within 5 A)");
}

TEST_CASE("composition_warnings: residues and atoms of chains without counterpart") {
  const Molecule longer = made_peptide(15), shorter = made_peptide(12);
  CHECK(composition_of(longer, shorter) ==
        std::vector<std::string>{"parts of the source's chains have no counterpart in the target: SER 13 of chain A to "
                                 "ASP 15 of chain A (26 atoms, +0 e)"});
  Molecule cut = shorter;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    if (cut.atoms[i].residue != 1 || cut.atoms[i].name != "NZ") continue;
    cut.atoms.erase(cut.atoms.begin() + static_cast<std::ptrdiff_t>(i));
    cut.positions.erase(cut.positions.begin() + static_cast<std::ptrdiff_t>(i));
    cut.radii.erase(cut.radii.begin() + static_cast<std::ptrdiff_t>(i));
    cut.charges.erase(cut.charges.begin() + static_cast<std::ptrdiff_t>(i));
    break;
  }
  CHECK(composition_of(shorter, cut) ==
        std::vector<std::string>{"1 residue of the source has atoms that the partner lacks: NZ of LYS 2 of chain A (1 "
                                 "atom, +1 e)"});
}

TEST_CASE("composition_warnings: what was left out, with its charge and its distances") {
  Molecule source = made_peptide(12);
  const Molecule target = source;
  source.left_out = {{{"HEM", "A", 154, ' '}, {{"FE", "Fe", 0, true}}, {{5, -6, 0}}, -2},
                     {{"UNK", "A", 155, ' '}, {{"C1", "C", 0, true}}, {{5, -60, 0}}, kNaN}};
  std::vector<std::uint8_t> region(source.residues.size(), 0);
  region.back() = 1;
  const std::vector<std::string> texts = composition_of(source, target, region);
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].find("2 residues of the source's file were left out, and the potential lacks them: HEM 154 of chain A "
                      "(1 atom, -2 e, ") == 0);
  CHECK(texts[0].find(" A from the region); UNK 155 of chain A (1 atom, charge unknown, ") != std::string::npos);
}
