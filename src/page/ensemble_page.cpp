// ensemble_page.cpp: the record and the arrays of an ensemble's page.
#include "page/ensemble_page.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "base/text/formats.h"
#include "io/files/read_csv.h"
#include "io/files/write_csv.h"
#include "io/vtk/read_vtp.h"
#include "page/assembled_page.h"
#include "page/ensemble_tables.h"
#include "page/page_arrays.h"
#include "page/page_molecule.h"
#include "page/page_surface.h"
#include "page/study_page.h"
#include "plot/automatic_range.h"

namespace espdiff {
namespace {

using EnsembleJson = nlohmann::ordered_json;

struct EnsembleQuantity {
  const char *array, *label;  ///< as EnsembleNames fills them
  bool is_potential, is_signed;
};

constexpr EnsembleQuantity kEnsembleQuantities[] = {
    {"potential_difference", "Difference, {target} - {source}", true, true},
    {"potential_source", "Mean {quantity} of {source}", true, true},
    {"potential_target", "Mean {quantity} of {target}", true, true},
    {"p_family_wise", "Family-wise p", false, false},
    {"difference_low", "Difference, lower end of the {confidence} % interval", true, true},
    {"difference_high", "Difference, upper end of the {confidence} % interval", true, true},
    {"standard_error", "Standard error of the difference", true, false},
    {"t", "t of the difference", false, true},
    {"deviation_source", "Standard deviation of {source}'s frames", true, false},
    {"deviation_target", "Standard deviation of {target}'s frames", true, false},
    {"effective_samples_source", "Effective samples of {source}", false, false},
    {"effective_samples_target", "Effective samples of {target}", false, false},
    {"trusted_source", "Share of {source}'s frames that trust the mapping", false, false},
    {"trusted_target", "Share of {target}'s frames that trust the mapping", false, false},
    {"regression_correlation", "Correlation with {regressed}", false, true},
    {"regression_slope", "Slope against {regressed}", false, true},
    {"regression_t", "t of the correlation with {regressed}", false, true},
    {"regression_p_max_t", "Family-wise p of {regressed} (max-t)", false, false},
    {"regression_p_tfce", "Family-wise p of {regressed} (TFCE)", false, false},
};

struct EnsembleFiles {
  std::string prefix;
  EnsembleJson record;
  VtpContent surface;
  CsvTable residues;
  EnsembleNames names;

  bool compares() const { return record.contains("test"); }
};

EnsembleFiles read_files(const std::string& prefix) {
  EnsembleFiles files{
      prefix, read_study_json(prefix + ".json"), read_vtp(prefix + ".vtp"), read_csv(prefix + ".residues.csv"), {}};
  if (files.record.value("format", "") != kEnsembleFormat || files.record.value("format_version", 0) != kFormatVersion)
    throw FormatError(prefix + ".json", 0,
                      "not an ensemble of this version of espdiff; compute its statistics again (ensemble, " +
                          option("from", prefix + ".h5") + ")");
  const std::size_t n = files.surface.positions.size();
  if (files.record.at("n_vertices").get<std::size_t>() != n)
    throw FormatError(
        prefix + ".vtp", 0,
        std::to_string(n) + " vertices, and not those of " + prefix + ".json; compute the statistics again");
  files.names = names_of(files.record, files.surface);
  return files;
}

void add_quantities(EnsembleJson& page, PageArrays& arrays, const EnsembleFiles& files) {
  page["quantities"] = EnsembleJson::array();
  for (const EnsembleQuantity& usual : kEnsembleQuantities) {
    const VtpNumbers* const array =
        find_array(files.surface.point_arrays, files.names.of_quantity(usual.array).c_str());
    if (array == nullptr || array->n_components != 1) continue;
    page["quantities"].push_back(page_quantity(arrays, *array, files.names.filled(usual.label),
                                               usual.is_potential ? files.names.unit : "", usual.is_signed));
  }
  for (const VtpNumbers& array : files.surface.point_arrays) {  // As many as there are.
    if (array.name.rfind("component_", 0) == 0)
      page["quantities"].push_back(
          page_quantity(arrays, array, "Principal component " + array.name.substr(10), "", true));
  }
  if (page["quantities"].empty())
    throw FormatError(files.prefix + ".vtp", 0, "no potential of an ensemble; compute the statistics again");
}

void add_surface(EnsembleJson& page, PageArrays& arrays, const EnsembleFiles& files) {
  const VtpContent& surface = files.surface;
  require_page_size(surface.triangles.size(), files.prefix);
  page["n_vertices"] = surface.positions.size();
  add_page_mesh(page, arrays, surface, surface.positions, {page_flags(surface, "untested"), {}, "not tested"});
  add_quantities(page, arrays, files);
  page["residue"] = arrays.add_integers(page_integers(surface, "residue_index", files.prefix));
  if (!files.compares()) return;
  page["patch"] = arrays.add_integers(page_integers(surface, "patch", files.prefix));
  const double alpha = files.record.at("options").at("alpha").get<double>();
  page["fade"] = {{"name", "p_family_wise"},
                  {"from", alpha},
                  {"to", alpha},  // a limit: its border is drawn smooth
                  {"text", "fainter where not significant, p > " + csv_number(alpha, 3)}};
  page["linked"] = EnsembleJson::array();
  const std::pair<const char*, std::string> linked[] = {
      {"potential_source", files.names.source},
      {"potential_target", files.names.target},
      {"potential_difference", files.names.target + " - " + files.names.source}};
  for (const auto& [name, label] : linked)
    page["linked"].push_back(EnsembleJson::array({files.names.of_quantity(name), label}));
}

/// The mean of each patch in each frame, and which frames are whose.
void add_series(EnsembleJson& page, PageArrays& arrays, const EnsembleFiles& files) {
  const std::size_t n_patches = page.at("patches").size();
  if (n_patches == 0) return;
  const CsvTable table = read_csv(files.prefix + ".patch_series.csv");
  if (table.rows.size() > kMaxStudyRows) {
    page["warnings"].push_back(std::to_string(table.rows.size()) +
                               " frames: the page leaves the means of patches in each "
                               "frame out (at most " +
                               std::to_string(kMaxStudyRows) + ")");
    return;
  }
  const std::size_t group = table.require("group"), replicate = table.require("replicate"),
                    frame = table.require("frame");
  EnsembleJson runs = EnsembleJson::array(), frames = EnsembleJson::array();
  for (const std::vector<std::string>& row : table.rows) {
    if (runs.empty() || runs.back().at("name") != row[replicate] || runs.back().at("group") != row[group])
      runs.push_back({{"group", row[group]}, {"name", row[replicate]}, {"begin", frames.size()}});
    frames.push_back(row[frame]);
  }
  page["series"] = {{"runs", std::move(runs)}, {"frames", std::move(frames)}, {"patches", EnsembleJson::array()}};
  for (std::size_t k = 0; k < n_patches; ++k) {
    const std::size_t column = table.require("patch_" + std::to_string(k + 1));
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows.size(); ++row) values.push_back(table.number(row, column));
    page["series"]["patches"].push_back(arrays.add_singles(values));
  }
}

EnsembleJson page_of(const EnsembleFiles& files, const std::string& title, PageArrays& arrays) {
  const EnsembleNames& names = files.names;
  const std::string states = files.compares() ? names.target + " against " + names.source : names.source;
  EnsembleJson page = {
      {"kind", "ensemble"},
      {"title", title.empty() ? files.names.title(states) : title},
      {"states", files.compares() ? "Groups of simulations: " + names.source + " and " + names.target +
                                        ". Differences are " + names.target + " - " + names.source + '.'
                                  : "One group of simulations: " + names.source + '.'}};
  add_verdict(page, files.record);
  page["numbers"] = number_sections(files.record, names);
  page["tables"] = ensemble_tables(files.record, names);
  page["patches"] = patch_rows(files.record, names);
  page["residues"] = residue_table(files.residues, names);
  page["provenance"] = ensemble_provenance(files.record);
  add_surface(page, arrays, files);
  add_template_backbone(page, arrays, files.record);
  add_series(page, arrays, files);
  return page;
}

}  // namespace

std::string ensemble_page(const std::string& prefix, const std::string& title,
                          const std::vector<std::string>& range_of) {
  require_three();
  PageArrays arrays;
  try {
    EnsembleJson page = page_of(read_files(prefix), title, arrays);
    share_page_ranges(page, prefix, range_of);
    return assembled_page(page, arrays, "report.html", surface_page_scripts(), surface_page_library());
  } catch (const EnsembleJson::exception&) {
    throw FormatError(prefix + ".json", 0,
                      "lacks what an ensemble's record has; compute its statistics again (ensemble, " +
                          option("from", prefix + ".h5") + ")");
  }
}

}  // namespace espdiff
