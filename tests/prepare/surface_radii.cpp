// Radii of surfaces: kept of one force field, replaced for two.
#include "prepare/surface_radii.h"

#include <doctest/doctest.h>

#include "align/made_molecule.h"
#include "base/error.h"
#include "prepare/region.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::MadeMolecule;
using espdiff_test::message_of;

namespace {

Molecule made(float radius, ValueOrigin origin) {
  MadeMolecule made("made.pqr");
  made.peptide("A", 1, "ARND");
  for (Atom& atom : made.molecule.atoms) atom.element = atom.name.substr(0, 1);
  made.molecule.radii.assign(made.molecule.size(), radius);
  made.molecule.radii_origin = origin;
  return made.molecule;
}

}  // namespace

TEST_CASE("set_surface_radii: one force field's radii are kept, also where one atom differs") {
  Molecule a = made(2, ValueOrigin::kFile), b = a;
  b.radii[3] = 1;
  CHECK(set_surface_radii({&a, &b}, RadiiChoice::kAuto).empty());
  CHECK(a.radii[0] == 2);
  CHECK(a.radii_origin == ValueOrigin::kFile);
}

TEST_CASE("set_surface_radii: two force fields, or radii on one side, give Bondi's on both") {
  Molecule a = made(2, ValueOrigin::kFile), b = made(1.9F, ValueOrigin::kFile), c = made(1.7F, ValueOrigin::kElement);
  Molecule a2 = a;
  CHECK(set_surface_radii({&a, &b}, RadiiChoice::kAuto) ==
        "the radii of the structures are of different force fields; all surfaces take Bondi's radii by element");
  CHECK(a.radii == b.radii);
  CHECK(a.radii[0] == doctest::Approx(1.55));  // nitrogen
  CHECK(set_surface_radii({&a2, &c}, RadiiChoice::kAuto).find("only some of the structures") == 0);
  CHECK(a2.radii_origin == ValueOrigin::kElement);
}

TEST_CASE("set_surface_radii: what is asked for is taken or refused") {
  Molecule a = made(2, ValueOrigin::kFile), b = made(1.9F, ValueOrigin::kFile), c = made(1.7F, ValueOrigin::kElement);
  CHECK(set_surface_radii({&a, &b}, RadiiChoice::kFile).empty());
  CHECK(a.radii[0] == 2);
  CHECK(b.radii[0] == 1.9F);
  CHECK(message_of([&] {
          set_surface_radii({&a, &c}, RadiiChoice::kFile);
        }) == "made.pqr: radii file was asked for, and the file has no radii; take radii element");
  set_surface_radii({&a}, RadiiChoice::kElement);
  CHECK(a.radii[1] == doctest::Approx(1.7));
}

TEST_CASE("set_frame_radii: a frame of other radii than the source's is refused, with the remedy") {
  const Molecule source = made(2, ValueOrigin::kFile), none;
  Molecule same = made(2, ValueOrigin::kFile), other = made(1.9F, ValueOrigin::kFile),
           bare = made(1.7F, ValueOrigin::kElement);
  espdiff::set_frame_radii(source, same, RadiiChoice::kAuto);
  CHECK(same.radii[0] == 2);
  CHECK(message_of([&] { espdiff::set_frame_radii(source, other, RadiiChoice::kAuto); }) ==
        "made.pqr: its radii are not of the kind that made.pqr has (another force field), so that their surfaces "
        "differ everywhere; radii element gives both Bondi's");
  CHECK(message_of([&] { espdiff::set_frame_radii(source, bare, RadiiChoice::kAuto); }) ==
        "made.pqr: its radii are not of the kind that made.pqr has (only one of them has radii of its own), so that "
        "their surfaces differ everywhere; radii element gives both Bondi's");
  espdiff::set_frame_radii(none, other, RadiiChoice::kAuto);  // the first molecule is compared with nothing
  espdiff::set_frame_radii(source, other, RadiiChoice::kElement);
  CHECK(other.radii_origin == ValueOrigin::kElement);
}

TEST_CASE("region_residues: by selection, by distance, and by the target's ligand") {
#ifndef ESPDIFF_HAVE_GEMMI
  MESSAGE("SKIPPED: this build lacks gemmi");
  return;
#endif
  MadeMolecule chain("source.pdb"), with_ligand("target.pdb");
  chain.peptide("A", 1, "ARNDCQEGHI");
  with_ligand.peptide("A", 1, "ARNDCQEGHI");
  with_ligand.residue("A", 99, "ATP", {"PA"});
  const Molecule& a = chain.molecule;
  Molecule whole = with_ligand.molecule;
  whole.positions.back() = whole.positions[1];  // on the first residue
  InputOptions options;
  CHECK(region_residues(a, a, a, whole, options).empty());
  options.region = "//A/2-3";
  CHECK(region_residues(a, a, a, whole, options) == std::vector<std::uint8_t>{0, 1, 1, 0, 0, 0, 0, 0, 0, 0});
  options.region = "//B";
  CHECK(message_of([&] { region_residues(a, a, a, whole, options); }) ==
        "source.pdb: region '//B' selects no atom; the file has chain A (1-10)");
  options.region.clear();
  options.region_within_A = 0.5;
  options.region_of = "(ATP)";
  CHECK(region_residues(a, a, a, whole, options) == std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  options.region_of = "(HEM)";
  CHECK(message_of([&] { region_residues(a, a, a, whole, options); }).find("of (HEM) selects no atom; ") == 0);
}
