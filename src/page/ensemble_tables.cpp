// ensemble_tables.cpp: an ensemble's numbers in words: sections, tables, patches and residues of its page.
#include "page/ensemble_tables.h"

#include <cmath>

#include "base/text/citation.h"
#include "io/files/write_csv.h"
#include "page/page_surface.h"

namespace espdiff {
namespace {

using TableJson = nlohmann::ordered_json;

constexpr const char* kMissing = "-";

std::string short_number(const TableJson& json, const char* name, int n_digits = 4) {
  const auto found = json.find(name);
  return found == json.end() || !found->is_number() ? kMissing : csv_number(found->get<double>(), n_digits);
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return number == kMissing || unit.empty() ? number : number + ' ' + unit;
}

std::string percent(const TableJson& json, const char* name) {
  const auto found = json.find(name);
  return found == json.end() || !found->is_number() ? kMissing : csv_number(100 * found->get<double>(), 3) + " %";
}

void add_row(TableJson& rows, const std::string& label, const std::string& help, const std::string& value) {
  if (value != kMissing) rows.push_back({{"label", label}, {"help", help}, {"value", value}});
}

void add_rows(TableJson& sections, const std::string& title, TableJson rows) {
  if (!rows.empty()) sections.push_back({{"title", title}, {"rows", std::move(rows)}});
}

TableJson test_rows(const TableJson& record, const EnsembleNames& names) {
  TableJson rows = TableJson::array();
  if (!record.contains("test")) return rows;
  const TableJson& test = record.at("test");
  add_row(rows, "Mean absolute difference", "Of the groups' means, over the tested surface",
          with_unit(short_number(test, "mean_abs_difference"), names.unit));
  add_row(rows, "p of the mean absolute difference", "Share of exchanged labels that reach it",
          short_number(test, "mean_abs_difference_p"));
  add_row(rows, "Mean absolute difference with exchanged labels", "Median: what chance makes of these simulations",
          with_unit(short_number(test, "mean_abs_difference_exchanged"), names.unit));
  add_row(rows, "Significant area", "Patches within the family-wise error",
          short_number(test, "significant_area_A2") + " A^2, " + percent(test, "significant_area_fraction"));
  add_row(rows, "Smallest possible p", "More replicates lower it; more frames do not",
          short_number(test, "smallest_p"));
  if (const auto why = test.find("no_p_because"); why != test.end() && why->is_string())
    add_row(rows, "No p", "Why none can be given", why->get<std::string>());
  add_row(rows, "Permutations", test.value("method", ""),
          short_number(test, "n_permutations") + (test.value("exact", false) ? ", all there are" : ""));
  return rows;
}

TableJson noise_rows(const TableJson& record, const EnsembleNames& names) {
  TableJson rows = TableJson::array();
  const TableJson& noise = record.at("noise_floor");
  add_row(rows, "One replicate of each group", "Mean over pairs; compares with the two rows below",
          with_unit(short_number(noise, "replicates_across_groups"), names.unit));
  for (const std::string& group : {names.source, names.target}) {
    if (group.empty() || !noise.contains(group)) continue;
    add_row(rows, "Two replicates of " + group, "Mean over pairs",
            with_unit(short_number(noise.at(group), "replicates"), names.unit));
    add_row(rows, "First and second halves, " + group, "Mean over the replicates",
            with_unit(short_number(noise.at(group), "halves"), names.unit));
  }
  return rows;
}

std::string interval(const TableJson& json, const EnsembleNames& names) {
  const std::string difference = with_unit(short_number(json, "difference"), names.unit);
  return difference == kMissing
             ? difference
             : difference + " (" + short_number(json, "low") + " to " + short_number(json, "high") + ')';
}

TableJson fixed_patch_rows(const TableJson& record, const EnsembleNames& names) {
  TableJson rows = TableJson::array();
  const TableJson patches = record.value("fixed_patches", TableJson::object());
  for (const auto& [name, patch] : patches.items()) {
    std::string means;
    for (const auto& [group, mean] : patch.at("means").items())
      means += (means.empty() ? "" : ", ") + group + ' ' + short_number(patch.at("means"), group.c_str());
    const std::string difference = interval(patch, names);
    add_row(rows, name, short_number(patch, "area_A2") + " A^2; means: " + means,
            difference == kMissing ? means : difference + ", p " + short_number(patch, "p", 2));
  }
  return rows;
}

TableJson regression_rows(const TableJson& record) {
  TableJson rows = TableJson::array();
  if (!record.contains("regression")) return rows;
  const TableJson& regression = record.at("regression");
  add_row(rows, "Column", "A value of each replicate", regression.at("column").get<std::string>());
  add_row(rows, "Q2", "Of each replicate, predicted from the others; 1 is perfect, 0 as good as their mean",
          short_number(regression, "q2"));
  add_row(rows, "p of Q2", "Share of exchanged values that reach it", short_number(regression, "q2_p"));
  add_row(rows, "Significant patches", "Where the surface goes with the value",
          std::to_string(regression.at("patches").size()));
  return rows;
}

TableJson template_rows(const TableJson& record) {
  TableJson rows = TableJson::array();
  for (const TableJson& check : record.value("template_check", TableJson::array()))
    add_row(rows, "Through " + check.at("template").get<std::string>(),
            "Significant area, and its share that both templates mark",
            short_number(check, "significant_area_A2") + " A^2, " + percent(check, "overlap"));
  return rows;
}

/// What the charges of each residue add to a patch, and to its difference.
TableJson cause_table(const TableJson& reading, const EnsembleNames& names) {
  TableJson rows = TableJson::array();
  for (const TableJson& residue : reading.at("largest"))
    rows.push_back(TableJson::array({residue.at("residue"), short_number(residue.at("means"), names.source.c_str()),
                                     short_number(residue.at("means"), names.target.c_str()), interval(residue, names),
                                     short_number(residue, "p_false_discovery", 2)}));
  return TableJson{
      {"title", "Causes, " + reading.at("reading").get<std::string>()},
      {"help", "What the charges of each residue add to the patch's mean potential, over " +
                   short_number(reading, "n_frames") + " frames. p is adjusted for the false discovery rate."},
      {"columns", TableJson::array({"Residue", names.source + " [" + names.unit + ']',
                                    names.target + " [" + names.unit + ']', "Difference", "p"})},
      {"rows", std::move(rows)}};
}

}  // namespace

std::string EnsembleNames::filled(const std::string& label) const {
  const std::pair<std::string, const std::string&> parts[] = {{"{source}", source},
                                                              {"{target}", target},
                                                              {"{regressed}", regressed},
                                                              {"{quantity}", quantity},
                                                              {"{confidence}", confidence}};
  std::string out;
  for (std::size_t i = 0; i < label.size();) {
    bool is_part = false;
    for (const auto& [mark, text] : parts) {
      if (label.compare(i, mark.size(), mark) != 0) continue;
      out += text;
      i += mark.size();
      is_part = true;
      break;
    }
    if (!is_part) out += label[i++];
  }
  return out;
}

std::string EnsembleNames::of_quantity(const std::string& array_of_potential) const {
  const std::string ending = "potential_";
  if (field.empty() || array_of_potential.rfind(ending, 0) != 0) return array_of_potential;
  return field + array_of_potential.substr(ending.size() - 1);
}

EnsembleNames names_of(const TableJson& record, const VtpContent& surface) {
  EnsembleNames names;
  for (const auto& [name, text] : surface.texts) {
    if (name == "source_group") names.source = text;
    if (name == "target_group") names.target = text;
  }
  names.unit = record.at("potential_unit").get<std::string>();
  names.confidence = csv_number(100 * record.at("options").at("confidence").get<double>(), 4);
  if (record.contains("field")) {
    names.field = record.at("field").at("name").get<std::string>();
    names.quantity = record.at("field").at("label").get<std::string>();
  }
  if (record.contains("regression")) names.regressed = record.at("regression").at("column").get<std::string>();
  return names;
}

void add_verdict(TableJson& page, const TableJson& record) {
  const TableJson& equilibrium = record.at("equilibrium");
  const std::string conclusion = record.at("conclusion").get<std::string>();
  const bool concludes = !record.contains("test") || record.at("test").at("no_p_because").is_null();
  page["verdict"] = {{"trustworthy", concludes && equilibrium.at("holds").get<bool>()},
                     {"text", conclusion.empty() ? "One group: nothing is compared" : with_capital(conclusion)},
                     {"reasons", equilibrium.at("reasons")}};
  page["warnings"] = record.at("warnings");
}

TableJson number_sections(const TableJson& record, const EnsembleNames& names) {
  TableJson sections = TableJson::array();
  add_rows(sections, "Difference of the groups", test_rows(record, names));
  add_rows(sections, "Noise floor, as mean absolute differences", noise_rows(record, names));
  add_rows(sections, "Patches chosen beforehand", fixed_patch_rows(record, names));
  add_rows(sections, "Regression", regression_rows(record));
  add_rows(sections, "Other templates", template_rows(record));
  TableJson surface = TableJson::array();
  add_row(surface, "Area", "Of the template's surface", with_unit(short_number(record, "area_A2"), "A^2"));
  add_row(surface, "Tested area", "Where enough frames of each group trust the mapping",
          with_unit(short_number(record, "tested_area_A2"), "A^2") + ", " + percent(record, "tested_area_fraction"));
  add_rows(sections, "Surface", std::move(surface));
  return sections;
}

TableJson ensemble_tables(const TableJson& record, const EnsembleNames& names) {
  TableJson rows = TableJson::array();
  for (const TableJson& r : record.at("replicates"))
    rows.push_back({r.at("group"), r.at("name"), short_number(r, "n_frames"), short_number(r, "median_inefficiency", 3),
                    short_number(r, "median_effective_samples", 3), percent(r, "trend_share"),
                    short_number(r, "mean_potential"), short_number(r, "mean_rmsd_A", 3),
                    percent(r, "trusted_area_fraction"), short_number(r, "n_not_trustworthy"),
                    short_number(r, "n_failed")});
  TableJson tables = TableJson::array(
      {TableJson{{"title", "Replicates"},
                 {"help",
                  "g frames hold as much as one independent sample; a run that samples a state has "
                  "a trend of 11 % in the mean, one "
                  "that diffuses 60 %. RMSD from the template. Trusted area: of the "
                  "template, mean over the frames."},
                 {"columns",
                  {"Group", "Replicate", "Frames", "g", "Effective samples", "Trend", "Mean [" + names.unit + ']',
                   "RMSD [A]", "Trusted area", "Not trustworthy", "Failed"}},
                 {"rows", std::move(rows)}}});
  const TableJson causes = record.value("causes", TableJson::array());
  for (const TableJson& reading : causes) tables.push_back(cause_table(reading, names));
  return tables;
}

TableJson patch_rows(const TableJson& record, const EnsembleNames& names) {
  TableJson rows = TableJson::array();
  for (const TableJson& patch : record.value("patches", TableJson::array())) {
    TableJson residues = TableJson::array();
    for (const TableJson& one : patch.at("residues"))
      residues.push_back(one.at("residue").get<std::string>() + ' ' + percent(one, "share"));
    rows.push_back({{"area", short_number(patch, "area_A2") + " A^2"},
                    {"difference", interval(patch, names)},
                    {"p", short_number(patch, "smallest_p")},
                    {"residues", std::move(residues)}});
  }
  return rows;
}

TableJson residue_table(const CsvTable& table, const EnsembleNames& names) {
  struct Column {
    std::string name, label;
    bool has_unit, is_main;
  };
  const Column known[] = {{"difference", "Difference", true, true},
                          {"mean_" + names.source, "Mean of " + names.source, true, names.target.empty()},
                          {"mean_" + names.target, "Mean of " + names.target, true, false},
                          {"low", names.filled("Lower end of the {confidence} % interval"), true, false},
                          {"high", names.filled("Upper end of the {confidence} % interval"), true, false},
                          {"p_false_discovery", "p, adjusted for the false discovery rate", false, true},
                          {"significant_area_A2", "Significant area [A^2]", false, true},
                          {"t", "t", false, false},
                          {"p", "p", false, false},
                          {"area_A2", "Area [A^2]", false, false}};
  const std::size_t residue = table.require("residue");
  TableJson columns = TableJson::array(), labels = TableJson::array(), rows = TableJson::array();
  std::vector<std::size_t> places;
  for (const Column& column : known) {
    const int place = table.find(column.name);
    if (place < 0) continue;
    places.push_back(static_cast<std::size_t>(place));
    columns.push_back({{"label", column.label}, {"unit", column.has_unit ? names.unit : ""}, {"main", column.is_main}});
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    labels.push_back(table.rows[r][residue]);
    TableJson cells = TableJson::array();
    for (const std::size_t place : places) cells.push_back(table.number(r, place));  // NaN is null in JSON
    rows.push_back(std::move(cells));
  }
  return {{"columns", columns}, {"names", labels}, {"rows", rows}};
}

TableJson ensemble_provenance(const TableJson& record) {
  const TableJson& plan = record.at("plan");
  const std::string version = record.at("version").get<std::string>();
  TableJson rows = TableJson::array();
  rows.push_back({"Program", "espdiff " + version + ", on " + plan.at("device").get<std::string>()});
  rows.push_back({"Template", plan.at("template").at("name").get<std::string>() + ", SHA-256 " +
                                  plan.at("template").at("sha256").get<std::string>()});
  rows.push_back({plan.contains("field") ? "Field" : "Potential", plan.at("potential").get<std::string>()});
  const TableJson all_charges = plan.value("charges", TableJson::object());
  for (const auto& [group, charges] : all_charges.items())
    rows.push_back({"Charges: " + group, charges.is_string() ? charges.get<std::string>() : charges.dump()});
  for (const TableJson& replicate : plan.at("replicates")) {
    std::string files;
    for (std::size_t i = 0; i < replicate.at("files").size(); ++i)
      files += (i > 0 ? "; " : "") + replicate.at("files").at(i).get<std::string>() + ", SHA-256 " +
               replicate.at("sha256").at(i).get<std::string>();
    rows.push_back(
        {"Input: " + replicate.at("group").get<std::string>() + ' ' + replicate.at("name").get<std::string>(), files});
  }
  std::string settings;
  for (const auto& [name, value] : plan.at("settings").items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (!text.empty()) settings += (settings.empty() ? "" : ", ") + name + ' ' + text;
  }
  rows.push_back({"Settings", settings});
  rows.push_back({"Statistics", record.at("options").dump()});
  rows.push_back({"How to cite", citation_of(version)});
  return rows;
}

}  // namespace espdiff
