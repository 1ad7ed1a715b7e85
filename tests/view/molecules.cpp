// molecules.cpp: bonds, folds and ribbons of molecules in pictures.
#include <doctest/doctest.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "base/molecule/secondary_structure.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"
#include "view/drawings/cartoon.h"
#include "view/drawings/molecule_actors.h"
#include "view/drawings/residue_labels.h"

using namespace espdiff;  // NOLINT: a test of these headers

namespace {

Molecule atoms(const std::vector<std::pair<std::string, Vec3d>>& elements) {
  Molecule molecule;
  molecule.residues.push_back({"LIG", "", 1, ' '});
  for (const auto& [element, place] : elements) {
    molecule.atoms.push_back({element, element, 0, true});
    molecule.positions.push_back(place);
  }
  return molecule;
}

/// Fraction of the residues of a chain, in ranges from a PDB file's records, that have a fold.
double share(const Molecule& molecule, const std::vector<Fold>& folds, const std::string& path,
             const std::string& record, Fold fold) {
  std::ifstream in(path);
  std::set<int> numbers;
  for (std::string line; std::getline(in, line);) {
    if (line.compare(0, 6, record) != 0) continue;
    const bool helix = record == "HELIX ";
    if (line[helix ? 19 : 21] != 'A') continue;
    const int first = std::stoi(line.substr(helix ? 21 : 22, 4)), last = std::stoi(line.substr(33, 4));
    for (int number = first; number <= last; ++number) numbers.insert(number);
  }
  int n = 0, n_same = 0;
  for (std::size_t r = 0; r < folds.size(); ++r) {
    if (molecule.residues[r].chain != "A" || numbers.count(molecule.residues[r].number) == 0) continue;
    ++n;
    n_same += folds[r] == fold ? 1 : 0;
  }
  REQUIRE(n > 30);
  return static_cast<double>(n_same) / n;
}

}  // namespace

TEST_CASE("bonds are found by distance, and each hydrogen has one") {
  const Molecule water = atoms({{"O", {0, 0, 0}}, {"H", {0.96, 0, 0}}, {"H", {-0.24, 0.93, 0}}});
  CHECK(find_bonds(water).size() == 2);
  // Ethane's carbons, and a third one out of reach.
  CHECK(find_bonds(atoms({{"C", {0, 0, 0}}, {"C", {1.54, 0, 0}}, {"C", {4.4, 0, 0}}})).size() == 1);
  // Between two oxygens, the nearer one gets the hydrogen.
  const auto shared = find_bonds(atoms({{"O", {0, 0, 0}}, {"H", {1.2, 0, 0}}, {"O", {2.3, 0, 0}}}));
  REQUIRE(shared.size() == 1);
  CHECK(shared[0][0] == 2);
}

TEST_CASE("helices and strands of triosephosphate isomerase agree with its file") {
  const auto path = espdiff_test::real_input("tim/7tim.pdb");
  if (!path) return;
  const Molecule molecule = read_structure(*path);
  const std::vector<Fold> folds = assign_folds(molecule, backbone_of(molecule));
  // The file's authors include the first and last turns.
  CHECK(share(molecule, folds, *path, "HELIX ", Fold::kHelix) > 0.75);
  CHECK(share(molecule, folds, *path, "SHEET ", Fold::kStrand) > 0.8);
  CHECK(share(molecule, folds, *path, "SHEET ", Fold::kHelix) < 0.02);
  CHECK(share(molecule, folds, *path, "HELIX ", Fold::kStrand) < 0.02);
}

TEST_CASE("ribbons are closed and have unit normals") {
  const auto path = espdiff_test::real_input("tim/7tim.pdb");
  if (!path) return;
  const auto ribbons = make_cartoon(read_structure(*path));
  REQUIRE(ribbons->GetNumberOfPolys() > 10000);
  std::map<std::pair<vtkIdType, vtkIdType>, int> edges;
  vtkIdType n = 0;
  const vtkIdType* corners = nullptr;
  for (ribbons->GetPolys()->InitTraversal(); ribbons->GetPolys()->GetNextCell(n, corners) != 0;) {
    for (int i = 0; i < 3; ++i) ++edges[{corners[i], corners[(i + 1) % 3]}];
  }
  // Each edge is used once in each direction.
  int n_open = 0;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    n_open += count != 1 || back == edges.end() ? 1 : 0;
  }
  CHECK(n_open == 0);
  auto* normals = ribbons->GetPointData()->GetNormals();
  for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); i += 11) {
    const double* v = normals->GetTuple3(i);
    CHECK(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] == doctest::Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("ligands, ions and water are distinguished from the protein") {
  const auto path = espdiff_test::real_input("tim/7tim.pdb");
  if (!path) return;
  StructureOptions with_water;
  with_water.include_water = true;
  const Molecule molecule = read_structure(*path, with_water);
  const std::vector<bool> polymer = polymer_residues(molecule), near = residues_around(molecule, 4);
  const std::vector<bool> nearer = residues_around(molecule, 2.8);
  int n_polymer = 0, n_near = 0, n_nearer = 0;
  bool has_ligand = false;
  for (std::size_t r = 0; r < polymer.size(); ++r) {
    n_polymer += polymer[r];
    n_near += near[r];
    n_nearer += nearer[r];
    CHECK_FALSE((polymer[r] && near[r]));
    CHECK((near[r] || !nearer[r]));
    // Phosphoglycolohydroxamate, bound in both active sites.
    has_ligand = has_ligand || (near[r] && molecule.residues[r].name == "PGH");
  }
  CHECK(n_polymer == 494);
  CHECK(n_near > n_nearer);
  CHECK(n_nearer > 10);
  CHECK(has_ligand);
  CHECK(make_cartoon(atoms({{"O", {0, 0, 0}}}))->GetNumberOfPolys() == 0);
  CHECK(make_molecule_actor(Molecule{}, MoleculeStyle::kSticks, 1) == nullptr);
}

TEST_CASE("the residues that differ most come first, at a distance from each other") {
  SurfaceFile surface;
  for (int residue = 0; residue < 4; ++residue) {
    for (int i = 0; i < 25; ++i) {
      surface.positions.push_back({12.0 * residue, 0.01 * i, 0});
      surface.normals.push_back({0, 0, 1});
      surface.residue_index.push_back(static_cast<float>(residue));
      surface.potential_difference.push_back(static_cast<float>(residue == 2 ? -5 : residue));
    }
  }
  // Too few vertices for a mean, and one too near a better one.
  surface.positions.push_back({50, 0, 0});
  surface.normals.push_back({0, 0, 1});
  surface.residue_index.push_back(9);
  surface.potential_difference.push_back(100);
  for (int i = 0; i < 25; ++i) {
    surface.positions.push_back({25, 0.01 * i, 0});
    surface.normals.push_back({0, 0, 1});
    surface.residue_index.push_back(5);
    surface.potential_difference.push_back(4);
  }
  const auto marks = most_different_residues(surface, 3);
  REQUIRE(marks.size() == 3);
  CHECK(marks[0].residue == 2);
  CHECK(marks[0].mean_difference == doctest::Approx(5));
  CHECK(marks[1].residue == 3);
  CHECK(marks[2].residue == 1);
  Molecule one, two;
  one.residues = {{"LYS", "A", 12, ' '}, {"ASP", "A", 13, 'B'}};
  two.residues = {{"LYS", "A", 12, ' '}, {"ASP", "B", 13, ' '}};
  CHECK(residue_name(one, 0) == "LYS 12");
  CHECK(residue_name(one, 1) == "ASP 13B");
  CHECK(residue_name(two, 1) == "ASP B13");
}
