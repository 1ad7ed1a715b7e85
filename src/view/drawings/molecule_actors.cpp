// molecule_actors.cpp: bonds, and molecules in the form VTK's mappers need.
#include "view/drawings/molecule_actors.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkMolecule.h>
#include <vtkMoleculeMapper.h>
#include <vtkNew.h>
#include <vtkPeriodicTable.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/molecule/secondary_structure.h"
#include "view/drawings/cartoon.h"

namespace espdiff {
namespace {

constexpr double kBondSlack_A = 0.4;
constexpr double kCell_A = 3;

/// Atomic numbers of elements; an unknown element is drawn as carbon.
class Elements {
 public:
  explicit Elements(const Molecule& molecule) {
    for (const Atom& atom : molecule.atoms) {
      auto found = by_name_.find(atom.element);
      if (found == by_name_.end()) {
        const unsigned short number = atom.element.empty() ? 6 : table_->GetAtomicNumber(atom.element.c_str());
        found = by_name_.emplace(atom.element, number == 0 ? 6 : number).first;
      }
      numbers_.push_back(found->second);
    }
  }

  unsigned short number(std::size_t atom) const { return numbers_[atom]; }
  double covalent_radius(std::size_t atom) const { return table_->GetCovalentRadius(numbers_[atom]); }
  std::array<unsigned char, 3> colour(std::size_t atom) const {
    float rgb[3];
    table_->GetDefaultRGBTuple(numbers_[atom], rgb);
    const auto byte = [](float v) { return static_cast<unsigned char>(std::lround(255 * v)); };
    return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
  }

 private:
  vtkNew<vtkPeriodicTable> table_;
  std::map<std::string, unsigned short> by_name_;
  std::vector<unsigned short> numbers_;
};

/// Atoms in cubic cells.
class AtomCells {
 public:
  AtomCells(const std::vector<Vec3d>& positions, double size) : positions_(positions), size_(size) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      cells_[key(positions[i], 0, 0, 0)].push_back(static_cast<int>(i));
  }

  /// Calls `visit(index)` for all atoms in the cells around a position.
  template <typename Visit>
  void around(Vec3d place, const Visit& visit) const {
    for (int corner = 0; corner < 27; ++corner) {
      const auto found = cells_.find(key(place, corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1));
      if (found == cells_.end()) continue;
      for (const int atom : found->second) visit(atom);
    }
  }

 private:
  std::array<long, 3> key(Vec3d p, int dx, int dy, int dz) const {
    const auto cube = [&](double v) { return static_cast<long>(std::floor(v / size_)); };
    return {cube(p.x) + dx, cube(p.y) + dy, cube(p.z) + dz};
  }

  const std::vector<Vec3d>& positions_;
  double size_;
  std::map<std::array<long, 3>, std::vector<int>> cells_;
};

vtkSmartPointer<vtkProp> make_lines(const Molecule& molecule, double width) {
  const Elements elements(molecule);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  const auto add_half = [&](std::size_t atom, Vec3d middle) {
    const Vec3d p = molecule.positions[atom];
    const auto colour = elements.colour(atom);
    const vtkIdType first = points->InsertNextPoint(p.x, p.y, p.z);
    points->InsertNextPoint(middle.x, middle.y, middle.z);
    lines->InsertNextCell({first, first + 1});
    for (int i = 0; i < 2; ++i) colours->InsertNextTuple3(colour[0], colour[1], colour[2]);
  };
  for (const auto& [a, b] : find_bonds(molecule)) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const Vec3d middle = 0.5 * (molecule.positions[i] + molecule.positions[j]);
    add_half(i, middle);
    add_half(j, middle);
  }
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->SetLines(lines);
  shape->GetPointData()->SetScalars(colours);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(shape);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  actor->GetProperty()->LightingOff();
  return actor;
}

void set_material(vtkActor* actor) {
  vtkProperty* material = actor->GetProperty();
  material->SetInterpolationToPhong();
  material->SetAmbient(0.25);
  material->SetDiffuse(0.85);
  material->SetSpecular(0.15);
  material->SetSpecularPower(30);
}

vtkSmartPointer<vtkProp> make_sticks(const Molecule& molecule) {
  const Elements elements(molecule);
  vtkNew<vtkMolecule> drawn;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Vec3d p = molecule.positions[i];
    drawn->AppendAtom(elements.number(i), p.x, p.y, p.z);
  }
  for (const auto& [a, b] : find_bonds(molecule)) drawn->AppendBond(a, b, 1);
  vtkNew<vtkMoleculeMapper> mapper;
  mapper->SetInputData(drawn);
  mapper->UseBallAndStickSettings();
  mapper->SetAtomicRadiusScaleFactor(0.2F);
  mapper->SetBondRadius(0.12F);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  set_material(actor);
  return actor;
}

vtkSmartPointer<vtkProp> make_ribbons(const Molecule& molecule) {
  const vtkSmartPointer<vtkPolyData> ribbons = make_cartoon(molecule);
  if (ribbons->GetNumberOfPolys() == 0) return nullptr;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(ribbons);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  set_material(actor);
  return actor;
}

}  // namespace

std::vector<std::array<int, 2>> find_bonds(const Molecule& molecule) {
  const Elements elements(molecule);
  const AtomCells cells(molecule.positions, kCell_A);
  std::vector<std::array<int, 2>> bonds;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const bool is_hydrogen = elements.number(i) == 1;
    double nearest = 1e9;
    int partner = -1;
    cells.around(molecule.positions[i], [&](int other) {
      const auto j = static_cast<std::size_t>(other);
      if (j == i || elements.number(j) == 1) return;
      const double distance = norm(molecule.positions[i] - molecule.positions[j]);
      if (distance > elements.covalent_radius(i) + elements.covalent_radius(j) + kBondSlack_A) return;
      if (!is_hydrogen) {
        if (j < i) bonds.push_back({other, static_cast<int>(i)});
      } else if (distance < nearest) {
        nearest = distance;
        partner = other;
      }
    });
    if (partner >= 0) bonds.push_back({partner, static_cast<int>(i)});
  }
  return bonds;
}

Molecule with_residues(const Molecule& molecule, const std::vector<bool>& is_kept) {
  Molecule part;
  part.name = molecule.name;
  std::vector<std::int32_t> index(molecule.residues.size(), -1);
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    if (!is_kept[r]) continue;
    index[r] = static_cast<std::int32_t>(part.residues.size());
    part.residues.push_back(molecule.residues[r]);
  }
  for (std::size_t i = 0; i < molecule.atoms.size(); ++i) {
    const auto residue = static_cast<std::size_t>(molecule.atoms[i].residue);
    if (!is_kept[residue]) continue;
    part.atoms.push_back(molecule.atoms[i]);
    part.atoms.back().residue = index[residue];
    part.positions.push_back(molecule.positions[i]);
  }
  return part;
}

std::vector<bool> polymer_residues(const Molecule& molecule) {
  const std::vector<Backbone> backbone = backbone_of(molecule);
  std::vector<bool> is_polymer(molecule.residues.size());
  for (std::size_t r = 0; r < is_polymer.size(); ++r) {
    const int ca = backbone[r].ca;
    is_polymer[r] = ca >= 0 && (backbone[r].n >= 0 || !molecule.atoms[static_cast<std::size_t>(ca)].hetero);
  }
  for (const Atom& atom : molecule.atoms) {
    if (atom.name == "P" && !atom.hetero) is_polymer[static_cast<std::size_t>(atom.residue)] = true;
  }
  return is_polymer;
}

std::vector<bool> residues_around(const Molecule& molecule, double distance_A) {
  const std::vector<bool> is_polymer = polymer_residues(molecule);
  std::vector<bool> is_near(is_polymer.size(), false);
  const AtomCells cells(molecule.positions, std::max(distance_A, 1.0));
  for (std::size_t i = 0; i < molecule.atoms.size(); ++i) {
    const auto residue = static_cast<std::size_t>(molecule.atoms[i].residue);
    if (is_polymer[residue] || is_near[residue]) continue;
    cells.around(molecule.positions[i], [&](int other) {
      const auto j = static_cast<std::size_t>(other);
      const bool counts = is_polymer[static_cast<std::size_t>(molecule.atoms[j].residue)];
      if (counts && norm(molecule.positions[i] - molecule.positions[j]) <= distance_A) is_near[residue] = true;
    });
  }
  return is_near;
}

vtkSmartPointer<vtkProp> make_molecule_actor(const Molecule& molecule, MoleculeStyle style, double width) {
  if (molecule.atoms.empty()) return nullptr;
  switch (style) {
    case MoleculeStyle::kCartoon: return make_ribbons(molecule);
    case MoleculeStyle::kSticks: return make_sticks(molecule);
    case MoleculeStyle::kLines: return make_lines(molecule, width);
    case MoleculeStyle::kNone: break;
  }
  return nullptr;
}

}  // namespace espdiff
