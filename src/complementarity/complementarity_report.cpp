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
#include "report/records/text_lines.h"
#include "report/sections/json_number.h"
#include "report/sections/provenance.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

const char* const kSides[] = {"first", "second"};
const char* const kStates[] = {"source", "target"};

const std::string& partner(const InterfaceRequest& request, std::size_t side) {
  return side == 0 ? request.first : request.second;
}

/// The columns of a residue in one state.
struct InterfaceColumn {
  const char* name;
  double InterfaceResidue::*value;
};
const InterfaceColumn kColumns[] = {{"area_A2", &InterfaceResidue::area_A2},
                                    {"contribution", &InterfaceResidue::contribution},
                                    {"mean_own_potential", &InterfaceResidue::mean_own},
                                    {"mean_other_potential", &InterfaceResidue::mean_other}};

double value_of(const InterfaceRow& row, std::size_t state, const InterfaceColumn& column) {
  return row.states[state] == nullptr ? kNaN : row.states[state]->*column.value;
}

Json state_json(const Complementarity& state) {
  Json json{{"structure", state.sides[0].molecule.name},
            {"potential", state.potential},
            {"n_atoms_left_out", state.n_left_out},
            {"pearson", json_number(state.pearson)},
            {"spearman", json_number(state.spearman)}};
  for (std::size_t side = 0; side < 2; ++side) {
    const InterfaceSide& of = state.sides[side];
    json[kSides[side]] = {{"pearson", json_number(of.pearson)},
                          {"spearman", json_number(of.spearman)},
                          {"area_A2", json_number(of.area_A2)},
                          {"buried_area_A2", json_number(of.buried_area_A2)}};
  }
  return json;
}

Json result_json(const ComplementarityResult& result, const Provenance& provenance) {
  Json json{{"format", "espdiff complementarity"}, {"format_version", 1}};
  json["interface"] = {{"first", result.request.first}, {"second", result.request.second}};
  for (std::size_t s = 0; s < result.states.size(); ++s) json[kStates[s]] = state_json(*result.states[s]);
  if (result.states.size() > 1) {
    json["change"] = {{"pearson", json_number(result.states[1]->pearson - result.states[0]->pearson)},
                      {"spearman", json_number(result.states[1]->spearman - result.states[0]->spearman)}};
    for (std::size_t side = 0; side < 2; ++side) json["mapping"][kSides[side]] = result.changes[side].verdict;
  }
  json["inputs"] = Json::array();
  for (const InputFile& input : provenance.inputs)
    json["inputs"].push_back({{"role", input.role}, {"path", input.path}, {"sha256", input.sha256}});
  json["device"] = provenance.device;
  json["command_line"] = provenance.command_line;
  json["version"] = provenance.version;
  return json;
}

void write_rows(std::ostream& out, const ComplementarityResult& result) {
  const std::size_t n_states = result.states.size();
  std::vector<std::string> names = {"partner", "chain", "residue_number", "insertion_code", "residue_name"};
  for (std::size_t s = 0; s < n_states; ++s) {
    for (const InterfaceColumn& column : kColumns)
      names.push_back((n_states > 1 ? std::string(kStates[s]) + "_" : "") + column.name);
  }
  if (n_states > 1) names.emplace_back("change_of_contribution");
  write_csv_row(out, names);
  for (const InterfaceRow& row : interface_rows(result)) {
    const Residue& residue = *row.residue;
    std::vector<std::string> cells = {partner(result.request, row.side), residue.chain, std::to_string(residue.number),
                                      residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code),
                                      residue.name};
    for (std::size_t s = 0; s < n_states; ++s) {
      for (const InterfaceColumn& column : kColumns) cells.push_back(csv_number(value_of(row, s, column)));
    }
    if (n_states > 1) cells.push_back(csv_number(row.change()));
    write_csv_row(out, cells);
  }
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

void print_state(std::ostream& out, const Complementarity& state, const InterfaceRequest& request) {
  constexpr std::size_t kWidth = 12;
  out << state.sides[0].molecule.name << '\n'
      << formatted("  complementarity %.3f (Pearson), %.3f (Spearman)\n", state.pearson, state.spearman);
  for (std::size_t side = 0; side < 2; ++side) {
    const InterfaceSide& of = state.sides[side];
    out << "  on " << padded(partner(request, side), kWidth)
        << formatted("%.3f, %.3f over %.0f A^2 (%.0f A^2 buried, less the border)\n", of.pearson, of.spearman,
                     of.area_A2, of.buried_area_A2);
  }
  out << "  potential: " << state.potential;
  if (state.n_left_out > 0) out << "; " << counted(state.n_left_out, "atom") << " of neither partner left out";
  out << '\n';
}

}  // namespace

double InterfaceRow::change() const {
  const auto of = [](const InterfaceResidue* state) { return state == nullptr ? 0 : state->contribution; };
  return of(states[1]) - of(states[0]);
}

std::vector<InterfaceRow> interface_rows(const ComplementarityResult& result) {
  std::vector<InterfaceRow> rows;
  for (std::size_t side = 0; side < 2; ++side) {
    const InterfaceSide& first = result.states[0]->sides[side];
    const InterfaceSide* const second = result.states.size() > 1 ? &result.states[1]->sides[side] : nullptr;
    std::vector<bool> has_partner(second == nullptr ? 0 : second->residues.size(), false);
    for (std::size_t r = 0; r < first.residues.size(); ++r) {
      InterfaceRow row{side, &first.molecule.residues[r], {&first.residues[r], nullptr}};
      const std::int32_t partner = second == nullptr ? -1 : result.changes[side].partner_of[r];
      if (partner >= 0) {
        row.states[1] = &second->residues[static_cast<std::size_t>(partner)];
        has_partner[static_cast<std::size_t>(partner)] = true;
      }
      if (first.residues[r].area_A2 > 0 || (row.states[1] != nullptr && row.states[1]->area_A2 > 0))
        rows.push_back(row);
    }
    for (std::size_t r = 0; r < has_partner.size(); ++r) {
      if (!has_partner[r] && second->residues[r].area_A2 > 0)
        rows.push_back({side, &second->molecule.residues[r], {nullptr, &second->residues[r]}});
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
  write_rows(files[1].stream(), result);
  for (std::size_t side = 0; side < 2; ++side) write_side(files[2 + side].stream(), result, side);
  commit_all(all);
}

void print_complementarity(std::ostream& out, const ComplementarityResult& result) {
  out << "Electrostatic complementarity of " << result.request.first << " and " << result.request.second
      << ": 1 complementary, 0 unrelated, -1 alike\n\n";
  for (const Complementarity* state : result.states) print_state(out, *state, result.request);
  const bool is_pair = result.states.size() > 1;
  std::vector<std::pair<double, std::string>> rows;
  for (const InterfaceRow& row : interface_rows(result))
    rows.emplace_back(is_pair ? row.change() : row.states[0]->contribution, residue_label(*row.residue));
  if (is_pair) {
    out << formatted("\nchange %+.3f (Pearson), %+.3f (Spearman)\n",
                     result.states[1]->pearson - result.states[0]->pearson,
                     result.states[1]->spearman - result.states[0]->spearman);
    for (std::size_t side = 0; side < 2; ++side)
      out << "  mapping of " << partner(result.request, side) << ": " << result.changes[side].verdict << '\n';
  } else {
    out << '\n';
  }
  print_wrapped(out, extremes(rows, true), is_pair ? "raised by" : "for it", 12);
  print_wrapped(out, extremes(rows, false), is_pair ? "lowered by" : "against it", 12);
}

}  // namespace espdiff
