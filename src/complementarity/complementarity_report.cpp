// complementarity_report.cpp: JSON, table, surfaces and words of complementarities.
#include "complementarity/complementarity_report.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "base/not_a_number.h"
#include "io/files/atomic_file.h"
#include "io/files/write_csv.h"
#include "io/vtk/write_vtp.h"
#include "report/records/record.h"
#include "report/records/text_lines.h"
#include "report/sections/interface_report.h"
#include "report/sections/provenance.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

const char* const kSides[] = {"first", "second"};
const char* const kStates[] = {"source", "target"};

const std::string& partner(const InterfaceRequest& request, std::size_t side) {
  return side == 0 ? request.first : request.second;
}

/// The partners, both states, and what changed between them.
Json interface_of(const ComplementarityResult& result) {
  Json json{{"first", result.request.first}, {"second", result.request.second}};
  for (std::size_t s = 0; s < result.states.size(); ++s)
    json[kStates[s]] = complementarity_json(result.states[s]->numbers());
  if (result.states.size() > 1)
    json["change"] = change_of_complementarity(result.states[0]->numbers(), result.states[1]->numbers());
  return json;
}

Json result_json(const ComplementarityResult& result, const Provenance& provenance) {
  Json json{{"format", "espdiff complementarity"}, {"format_version", 1}};
  const Json interface = interface_of(result);
  json["interface"] = {{"first", interface["first"]}, {"second", interface["second"]}};
  for (const char* part : {"source", "target", "change"}) {
    if (interface.contains(part)) json[part] = interface[part];
  }
  for (std::size_t side = 0; side < result.changes.size(); ++side)
    json["mapping"][kSides[side]] = result.changes[side].verdict;
  json["inputs"] = Json::array();
  for (const InputFile& input : provenance.inputs)
    json["inputs"].push_back({{"role", input.role}, {"path", input.path}, {"sha256", input.sha256}});
  json["device"] = provenance.device;
  json["command_line"] = provenance.command_line;
  json["version"] = provenance.version;
  return json;
}

/// A side's surface with its arrays, which live here.
struct WrittenSurface {
  std::vector<float> change;
  VtpSurface file;

  void add(const InterfaceSurface& s, const std::string& state) {
    file.point_arrays.emplace_back("potential_own" + state, s.own);
    file.point_arrays.emplace_back("potential_other" + state, s.other);
    file.point_arrays.emplace_back("interface" + state, s.inside);
    file.point_arrays.emplace_back("complementarity" + state, s.local);
  }
};

void write_side(std::ostream& out, const ComplementarityResult& result, std::size_t side) {
  WrittenSurface written;
  const bool is_pair = result.states.size() > 1;
  const InterfaceSurface& shown = is_pair ? result.changes[side].target : result.states[0]->sides[side].surface;
  written.file.points = VtpArray("points", shown.positions);
  written.file.triangles = &shown.triangles;
  written.file.point_arrays = {{"normal", shown.normals}};
  written.file.active_normals = "normal";
  if (is_pair) {
    const InterfaceChange& change = result.changes[side];
    for (std::size_t v = 0; v < shown.positions.size(); ++v)
      written.change.push_back(change.target.local[v] - change.source.local[v]);
    written.add(change.source, "_source");
    written.add(change.target, "_target");
    written.file.point_arrays.emplace_back("source_position", change.source.positions);
    written.file.point_arrays.emplace_back("complementarity_difference", written.change);
    written.file.cell_arrays = {{"why", change.why}};
    written.file.active_scalars = "complementarity_difference";
  } else {
    written.add(shown, "");
    written.file.active_scalars = "complementarity";
  }
  written.file.texts = {{"potential_unit", "kT/e"}, {"length_unit", "Angstrom"}};
  write_vtp(out, written.file);
}

/// "ARG 12 of chain A +0.12, ..." of the three rows at one end of the order.
std::string extremes(std::vector<std::pair<double, std::string>> rows, bool largest) {
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const auto& a, const auto& b) { return largest ? a.first > b.first : a.first < b.first; });
  std::string text;
  for (std::size_t i = 0; i < rows.size() && i < 3; ++i) {
    if (largest ? rows[i].first <= 0 : rows[i].first >= 0) break;
    text += (text.empty() ? "" : ", ") + rows[i].second + " " + formatted("%+.3f", rows[i].first);
  }
  return text;
}

}  // namespace

std::vector<InterfaceRow> interface_rows(const ComplementarityResult& result) {
  std::vector<InterfaceRow> rows;
  for (std::size_t side = 0; side < 2; ++side) {
    const InterfaceSide& first = result.states[0]->sides[side];
    const InterfaceSide* const second = result.states.size() > 1 ? &result.states[1]->sides[side] : nullptr;
    std::vector<bool> has_partner(second == nullptr ? 0 : second->residues.size(), false);
    for (std::size_t r = 0; r < first.residues.size(); ++r) {
      InterfaceRow row{side, first.molecule.residues[r], {first.residues[r], std::nullopt}};
      const std::int32_t partner = second == nullptr ? -1 : result.changes[side].partner_of[r];
      if (partner >= 0) {
        row.states[1] = second->residues[static_cast<std::size_t>(partner)];
        has_partner[static_cast<std::size_t>(partner)] = true;
      }
      if (first.residues[r].area_A2 > 0 || (row.states[1] && row.states[1]->area_A2 > 0)) rows.push_back(row);
    }
    for (std::size_t r = 0; r < has_partner.size(); ++r) {
      if (!has_partner[r] && second->residues[r].area_A2 > 0)
        rows.push_back({side, second->molecule.residues[r], {std::nullopt, second->residues[r]}});
    }
  }
  return rows;
}

std::vector<std::string> complementarity_endings() { return {".json", ".interface.csv", ".first.vtp", ".second.vtp"}; }

void write_complementarity(const std::string& prefix, const ComplementarityResult& result,
                           const Provenance& provenance) {
  std::deque<AtomicFile> files;
  std::vector<AtomicFile*> all;
  for (const std::string& ending : complementarity_endings()) all.push_back(&files.emplace_back(prefix + ending));
  files[0].stream() << result_json(result, provenance).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  write_interface_rows(files[1].stream(), result.request.first, result.request.second, result.states.size(),
                       interface_rows(result));
  for (std::size_t side = 0; side < 2; ++side) write_side(files[2 + side].stream(), result, side);
  commit_all(all);
}

void print_complementarity(std::ostream& out, const ComplementarityResult& result) {
  out << "Electrostatic complementarity of " << result.request.first << " and " << result.request.second
      << ": 1 complementary, 0 unrelated, -1 alike\n\n";
  const Json json = interface_of(result);
  const Record record(json);
  for (std::size_t s = 0; s < result.states.size(); ++s) print_complementarity(out, record, kStates[s]);
  const bool is_pair = result.states.size() > 1;
  std::vector<std::pair<double, std::string>> rows;
  for (const InterfaceRow& row : interface_rows(result))
    rows.emplace_back(is_pair ? row.change() : row.states[0]->contribution, residue_label(row.residue));
  if (is_pair) {
    out << '\n';
    print_change_of_complementarity(out, record);
    for (std::size_t side = 0; side < 2; ++side)
      out << "  mapping of " << partner(result.request, side) << ": " << result.changes[side].verdict << '\n';
  } else {
    out << '\n';
  }
  print_wrapped(out, extremes(rows, true), is_pair ? "raised by" : "for it", 12);
  print_wrapped(out, extremes(rows, false), is_pair ? "lowered by" : "against it", 12);
}

}  // namespace espdiff
