// page_surface.cpp: what pages with a surface share: its arrays, its limit, its scripts.
#include "page/page_surface.h"

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "page/page_texts.h"
#include "page/report_page.h"
#include "plot/automatic_range.h"
#include "plot/shared_range.h"

namespace espdiff {

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

std::vector<std::string> surface_page_scripts() {
  return {"three.min.js", "TrackballControls.js", "shared.js", "ribbon.js", "patches.js", "report.js"};
}

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

void add_page_triangles(nlohmann::ordered_json& page, PageArrays& arrays, const std::vector<Triangle>& counted,
                        const std::vector<Triangle>& rest) {
  std::vector<Triangle> all = counted;
  all.insert(all.end(), rest.begin(), rest.end());
  page["triangles"] = arrays.add_triangles(all);
  page["triangles"]["n_counted"] = counted.size();
}

}  // namespace espdiff
