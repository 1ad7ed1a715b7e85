// read_earlier_patch.cpp: OUT.json has the residues and the patches' areas, OUT.vtp the vertices.
#include "prepare/read_earlier_patch.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/molecule/earlier_patch.h"
#include "base/molecule/residue_label.h"
#include "io/files/read_input.h"
#include "io/text/json_values.h"
#include "io/text/text_cursor.h"
#include "io/vtk/read_vtp.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kEnding = ".json";

/// What is needed of OUT.json.
struct Record {
  std::vector<Residue> residues;
  std::vector<double> areas;  ///< [patch]
  std::vector<std::string> runs;
};

Residue residue_of(const std::string& label, const std::string& path) {
  Residue residue = parse_residue_label(label);
  if (residue_label(residue) != label)
    throw FormatError(path, 0, "a residue is " + in_quotes(label) + ", which an ensemble does not write; run it again");
  return residue;
}

Record record_of(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    Record record;
    for (const Json& label : json.at("plan").at("residues"))
      record.residues.push_back(residue_of(label.get<std::string>(), path));
    for (const Json& replicate : json.at("plan").at("replicates")) {
      for (const Json& sha256 : replicate.at("sha256")) record.runs.push_back(sha256.get<std::string>());
    }
    for (const Json& patch : json.at("patches")) record.areas.push_back(patch.at("area_A2").get<double>());
    return record;
  } catch (const nlohmann::json::exception&) {
    throw FormatError(path, 0,
                      "this is not the OUT.json of an ensemble of two groups, whose significant patches are numbered; "
                      "give one, or NAME=SELECTION");
  }
}

const VtpNumbers& array_of(const VtpContent& vtp, const std::string& name, const std::string& path) {
  const VtpNumbers* const array = find_array(vtp.point_arrays, name);
  if (array == nullptr || array->n_components != 1)
    throw FormatError(path, 0, "it has no array '" + name + "', so it is not of an ensemble's result; run it again");
  return *array;
}

/// The sum of a third of each triangle's area at each corner in the patch.
double area_inside(const EarlierPatch& patch) {
  double area = 0;
  for (const Triangle& t : patch.triangles) {
    const Vec3d &a = patch.positions[t[0]], &b = patch.positions[t[1]], &c = patch.positions[t[2]];
    for (const std::uint32_t v : t) area += patch.inside[v] != 0 ? norm(cross(b - a, c - a)) / 6 : 0;
  }
  return area;
}

}  // namespace

std::optional<EarlierPatchName> earlier_patch_name(const std::string& selection) {
  const std::size_t colon = selection.rfind(':');
  const std::string ending = kEnding;
  if (colon == std::string::npos || colon + 1 == selection.size() || colon <= ending.size()) return std::nullopt;
  const std::string number = selection.substr(colon + 1);
  if (selection.compare(colon - ending.size(), ending.size(), ending) != 0 ||
      number.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  return EarlierPatchName{selection.substr(0, colon), number};
}

std::string surface_beside(const EarlierPatchName& name) {
  return name.path.substr(0, name.path.size() - std::string(kEnding).size()) + ".vtp";
}

std::shared_ptr<const EarlierPatch> read_earlier_patch(const EarlierPatchName& name) {
  const std::string vtp_path = surface_beside(name);
  const FileContent file = read_input(name.path);
  require_memory_for_json(file.content, name.path);
  const Record record = record_of(file.content, name.path);
  long long number = 0;
  if (!parse_integer(name.number, number) || number < 1 || static_cast<std::size_t>(number) > record.areas.size())
    throw InputError(name.path + ": there is no patch " + name.number + "; it has " +
                     std::to_string(record.areas.size()) + (record.areas.size() == 1 ? " patch" : " patches") +
                     ", numbered from 1");
  VtpContent vtp = read_vtp(vtp_path);
  EarlierPatch patch;
  patch.path = name.path;
  patch.sha256 = file.sha256;
  patch.number = static_cast<std::size_t>(number);
  patch.residues = record.residues;
  patch.runs_sha256 = record.runs;
  for (const double value : array_of(vtp, "patch", vtp_path).values)
    patch.inside.push_back(value == static_cast<double>(number) ? 1 : 0);
  const auto n_residues = static_cast<double>(patch.residues.size());
  for (const double value : array_of(vtp, "residue_index", vtp_path).values) {
    if (!(value >= -1 && value < n_residues && value == std::floor(value)))
      throw FormatError(vtp_path, 0, "a vertex belongs to no residue of " + name.path + "; give files of one run");
    patch.residue.push_back(static_cast<std::int32_t>(value));
  }
  patch.positions = std::move(vtp.positions);
  patch.triangles = std::move(vtp.triangles);
  patch.area_A2 = record.areas[patch.number - 1];
  if (!(patch.area_A2 > 0 && std::fabs(area_inside(patch) - patch.area_A2) <= 0.001 * patch.area_A2))
    throw FormatError(
        vtp_path, 0, "its patch " + name.number + " has another area than in " + name.path + "; give files of one run");
  return std::make_shared<const EarlierPatch>(std::move(patch));
}

}  // namespace espdiff
