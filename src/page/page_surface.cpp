// page_surface.cpp: what pages with a surface share: its arrays, its limit, its scripts.
#include "page/page_surface.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "page/page_texts.h"
#include "page/report_page.h"
#include "plot/automatic_range.h"
#include "plot/shared_range.h"
#include "scene/colour_scale.h"
#include "scene/reasons.h"

namespace espdiff {
namespace {

constexpr int kShareSteps = 255;

/// Of the source where the result has them.
std::vector<Vec3d> source_positions(const VtpContent& surface) {
  const VtpNumbers* const array = find_array(surface.point_arrays, "source_position");
  if (array == nullptr || array->n_components != 3) return surface.positions;
  std::vector<Vec3d> positions;
  for (std::size_t i = 0; i + 2 < array->values.size(); i += 3)
    positions.push_back({array->values[i], array->values[i + 1], array->values[i + 2]});
  return positions;
}

}  // namespace

std::string with_capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

void require_three() {
  if (page_texts().count("three.min.js") == 0)
    throw DeviceError(
        "this build cannot write pages: three.js was not found when it was configured (Debian: libjs-three)");
}

void require_page_size(std::size_t n_triangles, const std::string& prefix) {
  if (n_triangles > kMaxPageTriangles)
    throw InputError(prefix + ".vtp: " + std::to_string(n_triangles) + " triangles; a page takes at most " +
                     std::to_string(kMaxPageTriangles) + ": compare with a larger " + option("grid-spacing"));
}

std::vector<std::string> surface_page_scripts() { return {"shared.js", "ribbon.js", "patches.js", "report.js"}; }

std::vector<std::string> surface_page_library() { return {"three.min.js", "TrackballControls.js"}; }

nlohmann::ordered_json add_page_positions(PageArrays& arrays, const std::vector<Vec3d>& positions) {
  std::vector<double> all;
  for (const Vec3d& p : positions) all.insert(all.end(), {p.x, p.y, p.z});
  return arrays.add_numbers(all, PageArrays::kFineSteps, 3);
}

std::vector<std::int32_t> page_integers(const VtpContent& surface, const std::string& name, const std::string& prefix) {
  const VtpNumbers* const array = find_array(surface.point_arrays, name);
  if (array == nullptr || array->n_components != 1)
    throw FormatError(prefix + ".vtp", 0, "no array '" + name + "' of one number a vertex; compute the result again");
  std::vector<std::int32_t> out;
  for (const double value : array->values)
    out.push_back(value >= 0 && value < 1e9 ? static_cast<std::int32_t>(value) : -1);
  return out;
}

nlohmann::ordered_json quantity_texts(const VtpNumbers& values, const std::string& label, const std::string& unit,
                                      bool is_signed) {
  return {{"name", values.name},
          {"label", label},
          {"unit", unit},
          {"signed", is_signed},
          {"range", automatic_limit({values.values.begin(), values.values.end()})}};
}

nlohmann::ordered_json page_quantity(PageArrays& arrays, const VtpNumbers& values, const std::string& label,
                                     const std::string& unit, bool is_signed) {
  nlohmann::ordered_json json = arrays.add_numbers(values.values, PageArrays::kColourSteps);
  json.update(quantity_texts(values, label, unit, is_signed));
  return json;
}

void share_page_ranges(nlohmann::ordered_json& page, const std::string& prefix, std::vector<std::string> others) {
  if (others.empty()) return;
  others.insert(others.begin(), prefix + ".vtp");
  const std::map<std::string, double> limits = shared_limits(others);
  for (nlohmann::ordered_json& quantity : page.at("quantities")) {
    const auto found = limits.find(quantity.at("name").get<std::string>());
    if (found != limits.end()) quantity["range"] = found->second;
  }
}

std::vector<std::uint8_t> page_flags(const VtpContent& surface, const char* name) {
  std::vector<std::uint8_t> flags;
  const VtpNumbers* const array = find_array(surface.cell_arrays, name);
  if (array == nullptr || array->n_components != 1) return flags;
  for (const double value : array->values) flags.push_back(value != 0 ? 1 : 0);
  return flags;
}

void add_page_reasons(nlohmann::ordered_json& page, PageArrays& arrays, const VtpContent& surface) {
  const VtpNumbers* const why = find_array(surface.cell_arrays, "why");
  if (why == nullptr || why->n_components != 1) return;
  std::vector<std::uint8_t> codes, turned;
  for (const double code : why->values)
    codes.push_back(static_cast<std::uint8_t>(code >= 0 && code < kNumberOfReasonCodes ? code : 0));
  if (const VtpNumbers* const array = find_array(surface.point_arrays, "turned"); array != nullptr)
    for (const double turn : array->values) turned.push_back(turn > 0 ? 1 : 0);
  const ReasonCodes reasons{surface.triangles, codes, turned};
  const auto areas = areas_of_reasons(reasons, source_positions(surface));
  const auto shares = shares_of_reasons(reasons, surface.positions.size());
  VtpNumbers main{"why", 1, std::vector<double>(surface.positions.size(), std::numeric_limits<double>::quiet_NaN())};
  page["reasons"] = nlohmann::ordered_json::array();
  for (std::size_t r = 0; r < kDrawnReasons.size(); ++r) {
    const auto& [key, words, colour] = kDrawnReasons[r];
    nlohmann::ordered_json entry;
    if (areas[r] > 0) {
      entry = arrays.add_numbers({shares[r].begin(), shares[r].end()}, kShareSteps);
      entry["text"] = reason_in_words(words, areas[r]);
    }
    entry["key"] = key;
    entry["colour"] = {colour.red, colour.green, colour.blue};
    page["reasons"].push_back(std::move(entry));
  }
  for (std::size_t v = 0; v < main.values.size(); ++v) {
    float most = 0;
    for (std::size_t r = 0; r < shares.size(); ++r) {
      if (!(shares[r][v] > most)) continue;
      most = shares[r][v];
      main.values[v] = static_cast<double>(r);
    }
  }
  const double unmatched = 1 - std::accumulate(areas.begin(), areas.end(), 0.0);
  page["unmatched_text"] = reason_in_words(PageMarks{}.unmatched_text, unmatched);
  const std::string label = with_capital(legend_title(RenderArray::kWhy, ""));
  page["quantities"].push_back(page_quantity(arrays, main, label, "", false));
}

void add_page_mesh(nlohmann::ordered_json& page, PageArrays& arrays, const VtpContent& surface,
                   const std::vector<Vec3d>& start, const PageMarks& marks) {
  SurfaceFile drawn;
  drawn.positions = surface.positions;
  drawn.triangles = surface.triangles;
  drawn.normals.resize(surface.positions.size());  // the browser computes its own
  drawn.unmatched = marks.unmatched;
  drawn.untrusted = marks.untrusted;
  std::vector<Vec3f> places;
  places.reserve(start.size());
  for (const Vec3d& place : start) places.push_back(static_cast<Vec3f>(place));
  const SurfaceCover cover = cover_of(drawn, places);
  page["positions"]["target"] = add_page_positions(arrays, cover.positions);
  page["triangles"] = arrays.add_triangles(surface.triangles);
  const auto has = [](const std::vector<std::uint8_t>& flags) {
    return std::find(flags.begin(), flags.end(), 1) != flags.end();
  };
  page["cover"] = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, const std::vector<float>& shares, const char* text) {
    page["cover"][name] = arrays.add_numbers({shares.begin(), shares.end()}, kShareSteps);
    page["cover"][name]["text"] = text;
  };
  if (has(marks.unmatched)) add("matched", cover.matched, marks.unmatched_text);
  if (has(marks.untrusted)) add("trusted", cover.trusted, "not trusted");
}

}  // namespace espdiff
