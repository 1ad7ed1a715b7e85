// backbone_trace.cpp: the course of a molecule's chains, for ribbons.
#include "base/molecule/backbone_trace.h"

#include <array>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

// Neighbours in a chain: C-alphas are 3.8 A apart, phosphorus atoms up to 7.5 A.
constexpr double kLongestStep_A = 4.5, kLongestNucleicStep_A = 9;

/// The atoms of a residue that matter here; -1 where there is none.
struct TraceAtoms {
  int trace = -1, carbon = -1, oxygen = -1;
  bool is_nucleic = false;
};

std::vector<TraceAtoms> trace_atoms(const Molecule& molecule) {
  std::vector<TraceAtoms> all(molecule.residues.size());
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Atom& atom = molecule.atoms[i];
    TraceAtoms& residue = all[static_cast<std::size_t>(atom.residue)];
    const auto index = static_cast<int>(i);
    if (atom.name == "CA" && atom.element != "Ca") residue.trace = index;
    if (atom.name == "P" && residue.trace < 0) {
      residue.trace = index;
      residue.is_nucleic = true;
    }
    if (atom.name == "C") residue.carbon = index;
    if (atom.name == "O") residue.oxygen = index;
  }
  return all;
}

}  // namespace

BackboneTrace backbone_trace(const Molecule& molecule) {
  BackboneTrace trace;
  const std::vector<TraceAtoms> residues = trace_atoms(molecule);
  const auto at = [&](int atom) { return molecule.positions[static_cast<std::size_t>(atom)]; };
  std::size_t before = residues.size();
  for (std::size_t r = 0; r < residues.size(); ++r) {
    const TraceAtoms& atoms = residues[r];
    if (atoms.trace < 0) continue;
    const Vec3d point = at(atoms.trace);
    const double longest = atoms.is_nucleic ? kLongestNucleicStep_A : kLongestStep_A;
    const bool continues = before < residues.size() && molecule.residues[before].chain == molecule.residues[r].chain &&
                           norm(point - trace.points.back()) < longest;
    if (continues)
      ++trace.chains.back();
    else
      trace.chains.push_back(1);
    Vec3d side{};
    if (atoms.carbon >= 0 && atoms.oxygen >= 0) {
      const Vec3d bond = at(atoms.oxygen) - at(atoms.carbon);
      side = (1 / norm(bond)) * bond;
    }
    trace.points.push_back(point);
    trace.sides.push_back(side);
    before = r;
  }
  return trace;
}

std::string to_text(const BackboneTrace& trace) {
  std::string text;
  std::size_t point = 0;
  for (const std::size_t n : trace.chains) {
    text += (text.empty() ? "" : "; ") + std::to_string(n) + ':';
    for (const std::size_t end = point + n; point < end; ++point) {
      for (const Vec3d& v : {trace.points[point], trace.sides[point]})
        text += formatted(" %.2f", v.x) + formatted(" %.2f", v.y) + formatted(" %.2f", v.z);
    }
  }
  return text;
}

BackboneTrace parse_backbone_trace(const std::string& text) {
  const InputError damaged("the trace of a backbone is damaged");
  BackboneTrace trace;
  std::istringstream in(text);
  for (std::string stretch; std::getline(in, stretch, ';');) {
    std::istringstream words(stretch);
    std::size_t n = 0;
    char colon = 0;
    if (!(words >> n >> colon) || colon != ':') throw damaged;
    std::array<double, 6> v{};
    std::size_t n_read = 0;
    while (words >> v[0] >> v[1] >> v[2] >> v[3] >> v[4] >> v[5]) {
      for (const double value : v) {
        if (!std::isfinite(value)) throw damaged;
      }
      trace.points.push_back({v[0], v[1], v[2]});
      trace.sides.push_back({v[3], v[4], v[5]});
      ++n_read;
    }
    if (n_read != n || !words.eof()) throw damaged;
    trace.chains.push_back(n);
  }
  return trace;
}

}  // namespace espdiff
