// vertex_quantity.cpp: the per-vertex quantities that can be drawn and mapped, by name.
#include "vertex_quantity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "certificate/result.h"
#include "ensemble_views.h"
#include "report/sections/potential_json.h"

namespace espdiff::vmdplugin {
namespace {

void require_potentials(const std::string& handle, const std::string& name, bool there) {
  if (there) return;
  throw InputError(handle + " has no potentials, so that there is no " + name +
                   "; give both sides a map (`map K` of the VMD molecule, or `map FILE`), or take displacement");
}

/// +1 where a negative value became positive, -1 the other way round, otherwise 0; or target less source.
std::vector<float> between(const std::vector<float>& source, const std::vector<float>& target, bool sign) {
  std::vector<float> values;
  for (std::size_t v = 0; v < source.size(); ++v) {
    const float a = source[v], b = target[v];
    const float change = a < 0 && b > 0 ? 1.0F : a > 0 && b < 0 ? -1.0F : 0.0F;
    values.push_back(sign && std::isfinite(b - a) ? change : b - a);
  }
  return values;
}

VertexQuantity of_field(const std::string& handle, const CompareResult& result, const DrawnName& name) {
  std::vector<std::string> names;
  for (const FieldResult& field : result.fields) names.push_back(field.quantity.name);
  const FieldResult& field = result.fields[place_of_field(handle, name.field, names)];
  const Quantity& quantity = field.quantity;
  const bool sign = name.quantity == "sign";
  if (sign && !quantity.is_signed)
    throw InputError("the sign of the field '" + name.field + "' means nothing; take difference, source or target");
  if (name.quantity == "source") return {field.source, quantity.unit, quantity.label, quantity.is_signed};
  if (name.quantity == "target") return {field.target, quantity.unit, quantity.label, quantity.is_signed};
  if (name.quantity != "difference" && !sign)
    throw InputError("'" + name.quantity + "' is no quantity of a field; take difference, source, target or sign");
  return {between(field.source, field.target, sign), sign ? "" : quantity.unit, quantity.label};
}

VertexQuantity of_comparison(const std::string& handle, const CompareResult& result, const std::string& name) {
  const MappedSurface& s = result.surface;
  if (name == "displacement") return {s.displacement, "A"};
  if (name == "path_length") return {s.path_length, "A"};
  if (name == "slip") {
    if (s.slip.empty()) throw InputError(handle + " has no slip, since no atoms pair; take displacement");
    return {s.slip, "A"};
  }
  if (name != "difference" && name != "source" && name != "target" && name != "sign")
    throw InputError("'" + name + "' is not difference, source, target, sign, slip, displacement or path_length");
  require_potentials(handle, name, result.potential.compared);
  const std::string unit = potential_unit_text(result);
  if (name == "source") return {s.potential_source, unit};
  if (name == "target") return {s.potential_target, unit};
  const bool sign = name == "sign";
  return {between(s.potential_source, s.potential_target, sign), sign ? "" : unit};
}

}  // namespace

DrawnName::DrawnName(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) field = text.substr(0, colon);
  quantity = colon == std::string::npos ? text : text.substr(colon + 1);
}

std::size_t place_of_field(const std::string& handle, const std::string& field, const std::vector<std::string>& names) {
  std::string there;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == field) return i;
    there += (i == 0 ? "" : ", ") + names[i];
  }
  throw InputError(
      handle + " has no field '" + field + "'; it has " +
      (there.empty() ? "none besides the potential: compute with " + option("field", field) : Message(there)));
}

VertexQuantity vertex_quantity(const std::string& handle, const Object& object, const std::string& name) {
  require_done(handle, object);
  if (const auto* comparison = dynamic_cast<const ComparisonObject*>(&object))
    return DrawnName(name).field.empty() ? of_comparison(handle, comparison->result, name)
                                         : of_field(handle, comparison->result, DrawnName(name));
  if (auto ensemble = ensemble_quantity(handle, object, name)) return std::move(*ensemble);
  const auto* surface = dynamic_cast<const SurfaceObject*>(&object);
  if (surface == nullptr) throw InputError(handle + " is " + kind_in_words(object) + ", which has no surface");
  if (name != "potential") throw InputError("'" + name + "' is not potential, which is all a surface has");
  require_potentials(handle, name, !surface->result.potential.empty());
  return {surface->result.potential, to_string(surface->result.unit)};
}

const std::vector<float>& vertex_uncertainty(const MappedSurface& surface) {
  return surface.slip.empty() ? surface.displacement : surface.slip;
}

QuantityRange range_of(const std::vector<float>& values) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::vector<float> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](float v) { return std::isfinite(v); });
  std::sort(sorted.begin(), sorted.end());
  QuantityRange range;
  range.n = values.size();
  range.n_nan = values.size() - sorted.size();
  const auto at = [&](double share) {
    if (sorted.empty()) return kNan;
    return static_cast<double>(sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]);
  };
  range.min = at(0);
  range.max = at(1);
  range.p02 = at(0.02);
  range.p98 = at(0.98);
  return range;
}

}  // namespace espdiff::vmdplugin
