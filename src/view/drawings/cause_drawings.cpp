// cause_drawings.cpp: colours residues by contribution, labels the largest, and draws the border of a patch.
#include "view/drawings/cause_drawings.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkMolecule.h>
#include <vtkMoleculeMapper.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/formatted.h"
#include "view/drawings/cartoon.h"
#include "view/drawings/molecule_actors.h"
#include "view/drawings/residue_labels.h"

namespace espdiff {
namespace {

constexpr std::size_t kMostLabels = 5;

bool is_same(const Residue& a, const Residue& b) {
  return a.number == b.number && a.insertion_code == b.insertion_code && a.chain == b.chain;
}

/// [cause] the residue of the molecule, -1 for none.
std::vector<int> places_of(const CauseDrawing& d) {
  std::vector<int> places;
  for (const Residue& residue : d.causes.residues) {
    const auto found = std::find_if(d.molecule.residues.begin(), d.molecule.residues.end(),
                                    [&](const Residue& other) { return is_same(residue, other); });
    places.push_back(found == d.molecule.residues.end() ? -1 : static_cast<int>(found - d.molecule.residues.begin()));
  }
  return places;
}

/// Indices of the largest causes that the molecule has.
std::vector<std::size_t> labelled(const std::vector<int>& places) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < places.size() && found.size() < kMostLabels; ++i) {
    if (places[i] >= 0) found.push_back(i);
  }
  return found;
}

/// [residue] by contribution; those without one are grey.
std::vector<Rgb> residue_colours(const CauseDrawing& d, const std::vector<int>& places) {
  std::vector<Rgb> colours(d.molecule.residues.size(), kNoValueColour);
  const double limit = largest_contribution(d.causes);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] < 0 || limit == 0) continue;
    colours[static_cast<std::size_t>(places[i])] =
        diverging_colour(0.5 + 0.5 * d.causes.differences[i] / limit, d.colours);
  }
  return colours;
}

vtkSmartPointer<vtkActor> lit_actor() {
  auto actor = vtkSmartPointer<vtkActor>::New();
  vtkProperty* material = actor->GetProperty();
  material->SetInterpolationToPhong();
  material->SetAmbient(0.25);
  material->SetDiffuse(0.85);
  return actor;
}

/// One residue as balls and sticks of one colour.
vtkSmartPointer<vtkProp> make_residue_sticks(const Molecule& molecule, int residue, Rgb colour) {
  std::vector<bool> is_kept(molecule.residues.size(), false);
  is_kept[static_cast<std::size_t>(residue)] = true;
  const Molecule part = with_residues(molecule, is_kept);
  vtkNew<vtkMolecule> drawn;
  constexpr unsigned short kCarbon = 6, kHydrogen = 1;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const bool is_hydrogen = part.atoms[i].element == "H" || part.atoms[i].name.front() == 'H';
    drawn->AppendAtom(is_hydrogen ? kHydrogen : kCarbon, part.positions[i].x, part.positions[i].y, part.positions[i].z);
  }
  for (const auto& [a, b] : find_bonds(part)) drawn->AppendBond(a, b, 1);
  vtkNew<vtkMoleculeMapper> mapper;
  mapper->SetInputData(drawn);
  mapper->UseBallAndStickSettings();
  mapper->SetAtomicRadiusScaleFactor(0.2F);
  mapper->SetBondRadius(0.16F);
  mapper->SetAtomColorMode(vtkMoleculeMapper::SingleColor);
  mapper->SetAtomColor(colour.red, colour.green, colour.blue);
  mapper->SetBondColorMode(vtkMoleculeMapper::SingleColor);
  mapper->SetBondColor(colour.red, colour.green, colour.blue);
  const auto actor = lit_actor();
  actor->SetMapper(mapper);
  return actor;
}

Vec3d centre_of(const Molecule& molecule) {
  Vec3d sum{};
  for (const Vec3d& p : molecule.positions) sum += p;
  return (1.0 / static_cast<double>(std::max<std::size_t>(1, molecule.size()))) * sum;
}

/// Where a residue's label hangs: its atom farthest from the molecule's centre.
ResidueMark mark_of(const Molecule& molecule, int residue) {
  const Vec3d centre = centre_of(molecule);
  ResidueMark mark{residue, 0, centre, {0, 0, 1}};
  double farthest = -1;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const double distance = norm(molecule.positions[i] - centre);
    if (molecule.atoms[i].residue != residue || distance <= farthest) continue;
    farthest = distance;
    mark.place = molecule.positions[i];
  }
  if (farthest > 0) mark.outward = (1 / farthest) * (mark.place - centre);
  return mark;
}

}  // namespace

double largest_contribution(const ReadingCauses& causes) {
  double largest = 0;
  for (const double difference : causes.differences) largest = std::max(largest, std::fabs(difference));
  return largest;
}

std::string causes_in_words(const ReadingCauses& causes) {
  const double end = largest_contribution(causes);
  return "molecule of the source: contributions to the difference of " + causes.reading + ", " +
         formatted("%.2g", -end) + " to " + formatted("%.2g", end) + " " + causes.unit;
}

std::vector<vtkSmartPointer<vtkProp>> make_causes(const CauseDrawing& drawing, MoleculeStyle style) {
  const std::vector<int> places = places_of(drawing);
  const std::vector<Rgb> colours = residue_colours(drawing, places);
  std::vector<vtkSmartPointer<vtkProp>> props;
  const auto add_sticks = [&](int residue) {
    props.push_back(make_residue_sticks(drawing.molecule, residue, colours[static_cast<std::size_t>(residue)]));
  };
  const bool has_cartoon = style != MoleculeStyle::kSticks && style != MoleculeStyle::kLines;
  if (has_cartoon) {
    const vtkSmartPointer<vtkPolyData> ribbons = make_cartoon(drawing.molecule, colours);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(ribbons);
    const auto actor = lit_actor();
    actor->SetMapper(mapper);
    props.push_back(actor);
  } else {
    for (std::size_t r = 0; r < colours.size(); ++r) add_sticks(static_cast<int>(r));
  }
  for (const std::size_t i : labelled(places)) {
    if (has_cartoon) add_sticks(places[i]);
  }
  return props;
}

std::vector<CauseLabel> make_cause_labels(const CauseDrawing& drawing) {
  const std::vector<int> places = places_of(drawing);
  std::vector<CauseLabel> labels;
  for (const std::size_t i : labelled(places)) {
    const std::string text =
        residue_name(drawing.molecule, places[i]) + " " + formatted("%+.2g", drawing.causes.differences[i]);
    const ResidueMark mark = mark_of(drawing.molecule, places[i]);
    labels.push_back({mark, make_label(mark, text, drawing.text_pixels)});
  }
  return labels;
}

std::vector<int> residues_of_reading(const RunRecord& record, const CauseDrawing& drawing) {
  const auto part = record.parts.find(drawing.causes.reading);
  if (part != record.parts.end()) return part->second;
  const std::string word = "residue ", reading = drawing.causes.reading;
  if (reading.rfind(word, 0) != 0) return {};
  const std::string name = reading.substr(word.size());
  std::vector<int> found;
  for (std::size_t r = 0; r < drawing.molecule.residues.size(); ++r) {
    const Residue& residue = drawing.molecule.residues[r];
    std::string number = std::to_string(residue.number);
    if (residue.insertion_code != ' ') number += residue.insertion_code;
    if (name == number || name == residue.chain + ":" + number) found.push_back(static_cast<int>(r));
  }
  return found;
}

vtkSmartPointer<vtkProp> make_outline(const SurfaceFile& surface, const std::vector<int>& residues, double width) {
  if (residues.empty() || surface.residue_index.empty()) return nullptr;
  std::vector<std::uint8_t> is_in(surface.positions.size(), 0);
  for (std::size_t v = 0; v < is_in.size(); ++v) {
    const auto residue = static_cast<int>(surface.residue_index[v]);
    is_in[v] = std::find(residues.begin(), residues.end(), residue) != residues.end() ? 1 : 0;
  }
  // Edges between a triangle inside and one that is not, with the number of triangles inside at each.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& v = surface.triangles[t];
    if (!surface.is_matched(t) || is_in[v[0]] + is_in[v[1]] + is_in[v[2]] < 2) continue;
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(v[k], v[(k + 1) % 3])];
  }
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  constexpr double kAbove_A = 0.15;
  for (const auto& [edge, n] : edges) {
    if (n != 1) continue;
    lines->InsertNextCell(2);
    for (const std::uint32_t v : {edge.first, edge.second}) {
      const Vec3d at = surface.positions[v] + kAbove_A * static_cast<Vec3d>(surface.normals[v]);
      lines->InsertCellPoint(points->InsertNextPoint(at.x, at.y, at.z));
    }
  }
  if (points->GetNumberOfPoints() == 0) return nullptr;
  vtkNew<vtkPolyData> border;
  border->SetPoints(points);
  border->SetLines(lines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(border);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.1, 0.1, 0.1);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  actor->GetProperty()->LightingOff();
  return actor;
}

}  // namespace espdiff
