// field_patches_report.cpp: the columns of patches, and what reads them.
#include "report/field_patches_report.h"

#include <nlohmann/json.hpp>

#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "certificate/result.h"
#include "io/files/write_csv.h"
#include "report/records/record.h"
#include "report/sections/json_number.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// A patch with what its columns are made of.
struct PatchRow {
  const FieldPatches& of;
  const FieldPatch& patch;
  bool of_source;
  std::size_t number;
  const Molecule& molecule;  ///< of its state

  const std::vector<FieldPatch>& other_state() const { return of_source ? of.target : of.source; }
};

struct PatchColumn {
  const char* name;
  Json (*value)(const PatchRow& row);
};

double area_of_others(const PatchRow& row) {
  double area = 0;
  for (const std::size_t number : row.patch.others) area += row.other_state()[number - 1].area_A2;
  return area;
}

/// Residues with at least a square Angstrom of it.
Json residues_of(const PatchRow& row) {
  constexpr double kLeast_A2 = 1;
  Json labels = Json::array();
  for (const auto& [residue, area] : row.patch.residues) {
    if (area >= kLeast_A2) labels.push_back(residue_label(row.molecule.residues.at(static_cast<std::size_t>(residue))));
  }
  return labels;
}

const PatchColumn kColumns[] = {
    {"field", [](const PatchRow& r) { return Json(r.of.quantity.name); }},
    {"state", [](const PatchRow& r) { return Json(r.of_source ? "source" : "target"); }},
    {"patch", [](const PatchRow& r) { return Json(r.number); }},
    {"side", [](const PatchRow& r) { return Json(r.patch.is_above ? "above" : "below"); }},
    {"threshold", [](const PatchRow& r) { return Json(r.patch.is_above ? *r.of.request.above : *r.of.request.below); }},
    {"area_A2", [](const PatchRow& r) { return json_number(r.patch.area_A2); }},
    {"trusted_area_A2", [](const PatchRow& r) { return json_number(r.patch.trusted_area_A2); }},
    {"mean", [](const PatchRow& r) { return json_number(r.patch.mean); }},
    {"extreme", [](const PatchRow& r) { return json_number(r.patch.extreme); }},
    {"became", [](const PatchRow& r) { return Json(to_string(r.patch.fate)); }},
    {"others", [](const PatchRow& r) { return Json(r.patch.others); }},
    {"area_of_others_A2", [](const PatchRow& r) { return json_number(area_of_others(r)); }},
    {"residues", residues_of}};

/// Calls visit(row) for the patches of the source, then for those of the target.
template <typename Visit>
void visit_rows(const FieldPatches& of, const Molecule& source, const Molecule& target, const Visit& visit) {
  for (std::size_t i = 0; i < of.source.size(); ++i) visit(PatchRow{of, of.source[i], true, i + 1, source});
  for (std::size_t i = 0; i < of.target.size(); ++i) visit(PatchRow{of, of.target[i], false, i + 1, target});
}

/// Numbers of a list are separated by blanks, residues by semicolons.
std::string csv_cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "";
  if (!value.is_array()) return csv_number(value.get<double>());
  std::string text;
  for (const Json& item : value)
    text += (text.empty()       ? ""
             : item.is_string() ? "; "
                                : " ") +
            (item.is_string() ? item.get<std::string>() : std::to_string(item.get<std::size_t>()));
  return text;
}

/// "source 12 (3 grew, 2 vanished)"
std::string state_in_words(const Record& entry, const std::string& state) {
  std::size_t n = 0;
  std::string fates;
  for (const PatchFate fate : kPatchFates) {
    std::size_t n_of_fate = 0;
    for (const Json& json : entry.at("/patches")) {
      const Record row(json);
      n_of_fate += row.text("/state") == state && row.text("/became") == to_string(fate) ? 1 : 0;
    }
    n += n_of_fate;
    if (n_of_fate > 0) fates += (fates.empty() ? "" : ", ") + std::to_string(n_of_fate) + " " + to_string(fate);
  }
  return state + " " + std::to_string(n) + (fates.empty() ? "" : " (" + fates + ")");
}

}  // namespace

Json field_patches_json(const Molecule& source, const Molecule& target, const std::vector<FieldPatches>& all) {
  Json json = Json::array();
  for (const FieldPatches& of : all) {
    Json entry{{"field", of.quantity.name},
               {"unit", of.quantity.unit},
               {"above", of.request.above ? Json(*of.request.above) : Json(nullptr)},
               {"below", of.request.below ? Json(*of.request.below) : Json(nullptr)},
               {"least_area_A2", kLeastFieldPatch_A2},
               {"n_smaller", {{"source", of.n_small_source}, {"target", of.n_small_target}}},
               {"patches", Json::array()}};
    visit_rows(of, source, target, [&](const PatchRow& row) {
      Json& patch = entry["patches"].emplace_back();
      for (const PatchColumn& column : kColumns) patch[column.name] = column.value(row);
    });
    json.push_back(std::move(entry));
  }
  return json;
}

void write_field_patches(std::ostream& out, const Molecule& source, const Molecule& target,
                         const std::vector<FieldPatches>& all) {
  std::vector<std::string> names;
  for (const PatchColumn& column : kColumns) names.emplace_back(column.name);
  write_csv_row(out, names);
  for (const FieldPatches& of : all) {
    visit_rows(of, source, target, [&](const PatchRow& row) {
      std::vector<std::string> cells;
      for (const PatchColumn& column : kColumns) cells.push_back(csv_cell(column.value(row)));
      write_csv_row(out, cells);
    });
  }
}

std::string field_patches_in_words(const Record& entry) {
  std::string text = state_in_words(entry, "source") + "; " + state_in_words(entry, "target");
  if (!entry.has("/patches/0")) return text;
  text += "; the largest of the " + entry.text("/patches/0/state") + " " +
          formatted("%.0f", entry.number("/patches/0/area_A2")) + " A^2";
  if (entry.has("/patches/0/residues/0")) text += " around " + entry.text("/patches/0/residues/0");
  return text;
}

}  // namespace espdiff
