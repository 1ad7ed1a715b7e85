// write_mvsj.cpp: nodes of a MolViewSpec tree (S. Bittrich and others, Nucleic Acids Research 53, W408 (2025)).
#include "export/write_mvsj.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/formatted.h"
#include "io/files/base64.h"
#include "io/molecules/write_cif.h"

namespace espdiff {
namespace {

using MvsJson = nlohmann::ordered_json;

constexpr int kSteps = 64;

std::string hex_colour(Rgb rgb) { return formatted("#%02x%02x%02x", rgb.red, rgb.green, rgb.blue); }

MvsJson node(const char* kind, const MvsJson& params, const MvsJson& children = nullptr) {
  MvsJson json = {{"kind", kind}};
  if (!params.is_null()) json["params"] = params;
  if (children.is_array() && !children.empty()) json["children"] = children;
  return json;
}

std::string value_text(const ExportScale& scale, double value) {
  return std::isnan(value)
             ? "no value"
             : scale.label + ' ' + formatted("%.3g", value) + (scale.unit.empty() ? "" : ' ' + scale.unit);
}

/// Three decimals are a thousandth of an Angstrom.
double thousandths(double x) { return std::round(x * 1000) / 1000; }

/// The step of the scale that a triangle has; kSteps where a corner has no value.
int step_of(const ExportedResult& result, const Triangle& triangle) {
  double sum = 0;
  for (const auto corner : triangle) sum += result.values[corner];
  if (std::isnan(sum)) return kSteps;
  const ExportScale& scale = result.scale;
  const double place = (sum / 3 - scale.low()) / (scale.limit - scale.low());
  return static_cast<int>(std::lround(std::clamp(place, 0.0, 1.0) * (kSteps - 1)));
}

MvsJson mesh(const ExportedResult& result) {
  MvsJson vertices = MvsJson::array(), indices = MvsJson::array(), groups = MvsJson::array();
  for (const Vec3d& p : result.files.surface.positions) {
    for (const double x : {p.x, p.y, p.z}) vertices.push_back(thousandths(x));
  }
  const auto add = [&](const Triangle& triangle, int group) {
    for (const auto corner : triangle) indices.push_back(corner);
    groups.push_back(group);
  };
  for (const Triangle& triangle : result.triangles.counted) add(triangle, step_of(result, triangle));
  for (const Triangle& triangle : result.triangles.rest) add(triangle, kSteps + 1);
  MvsJson colours = MvsJson::object(), tooltips = MvsJson::object();
  for (int step = 0; step <= kSteps; ++step) {
    const double place = static_cast<double>(step) / (kSteps - 1);
    const double value =
        step == kSteps ? std::nan("") : result.scale.low() + place * (result.scale.limit - result.scale.low());
    colours[std::to_string(step)] = hex_colour(result.scale.colour(value));
    tooltips[std::to_string(step)] = value_text(result.scale, value);
  }
  colours[std::to_string(kSteps + 1)] = hex_colour(kNoValueColour);
  tooltips[std::to_string(kSteps + 1)] = "corrupt or unmatched";
  return node("primitive", {{"kind", "mesh"},
                            {"vertices", vertices},
                            {"indices", indices},
                            {"triangle_groups", groups},
                            {"group_colors", colours},
                            {"group_tooltips", tooltips}});
}

/// What selects a residue in the scene's mmCIF text.
MvsJson selector(const Residue& residue) {
  MvsJson json = {{"auth_asym_id", residue.chain.empty() ? "A" : residue.chain}, {"auth_seq_id", residue.number}};
  if (residue.insertion_code != ' ') json["pdbx_PDB_ins_code"] = std::string(1, residue.insertion_code);
  return json;
}

MvsJson cartoon(const ExportedResult& result, const ExportedMolecule& exported) {
  const Molecule& molecule = exported.molecule;
  MvsJson colours = MvsJson::array(), children = MvsJson::array(), tooltips = MvsJson::array();
  colours.push_back(node("color", {{"color", hex_colour(kNoValueColour)}}));
  std::int32_t last = -1;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const std::int32_t r = molecule.atoms[i].residue;
    if (r == last) continue;
    last = r;
    const Residue& residue = molecule.residues[static_cast<std::size_t>(r)];
    const double value = exported.values[i];
    if (!std::isnan(value))
      colours.push_back(
          node("color", {{"color", hex_colour(result.residue_scale.colour(value))}, {"selector", selector(residue)}}));
    const std::string text =
        residue.name + ' ' + std::to_string(residue.number) + ": " + value_text(result.residue_scale, value);
    tooltips.push_back(
        node("component", {{"selector", selector(residue)}}, MvsJson::array({node("tooltip", {{"text", text}})})));
  }
  children.push_back(node("component", {{"selector", "polymer"}},
                          MvsJson::array({node("representation", {{"type", "cartoon"}}, colours)})));
  children.push_back(node("component", {{"selector", "ligand"}},
                          MvsJson::array({node("representation", {{"type", "ball_and_stick"}})})));
  children.insert(children.end(), tooltips.begin(), tooltips.end());
  return children;
}

}  // namespace

void write_mvsj(std::ostream& out, const ExportedResult& result, const ExportedMolecule& molecule) {
  std::ostringstream cif;
  write_cif(cif, "source", molecule.molecule, molecule.values, {}, {});
  const MvsJson structure = node("structure", {{"type", "model"}}, cartoon(result, molecule));
  const MvsJson parsed = node("parse", {{"format", "mmcif"}}, MvsJson::array({structure}));
  const MvsJson source =
      node("download", {{"url", "data:chemical/x-mmcif;base64," + base64_of(cif.str())}}, MvsJson::array({parsed}));
  const MvsJson surface = node("primitives", {{"opacity", 0.8}}, MvsJson::array({mesh(result)}));
  std::string description;
  for (const auto& [name, text] : result.notes) description += name + ": " + text + '\n';
  const MvsJson scene = {{"kind", "single"},
                         {"metadata",
                          {{"version", "1.8"},
                           {"timestamp", "1970-01-01T00:00:00+00:00"},
                           {"title", result.title},
                           {"description", description},
                           {"description_format", "plaintext"}}},
                         {"root", node("root", nullptr, MvsJson::array({source, surface}))}};
  out << scene.dump(-1, ' ', false, MvsJson::error_handler_t::replace) << '\n';
}

}  // namespace espdiff
