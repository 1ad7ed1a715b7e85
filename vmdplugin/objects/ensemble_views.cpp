// ensemble_views.cpp: an ensemble as values and as a surface.
#include "ensemble_views.h"

#include <nlohmann/json.hpp>
#ifdef ESPDIFF_HAVE_HDF5
#include <sstream>

#include "base/error.h"
#include "ensemble/ensemble_run.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_json.h"
#include "ensemble/result/ensemble_table.h"
#include "ensemble/template_matrix.h"
#include "ensemble_object.h"
#endif

namespace espdiff::vmdplugin {
#ifdef ESPDIFF_HAVE_HDF5
namespace {

/// A finished one; null for other kinds.
const EnsembleObject* finished(const std::string& handle, const Object& object) {
  const auto* ensemble = dynamic_cast<const EnsembleObject*>(&object);
  if (ensemble != nullptr) require_done(handle, object);
  return ensemble;
}

/// With an answer, which a part lacks.
const EnsembleObject* answered(const std::string& handle, const Object& object) {
  const EnsembleObject* const ensemble = finished(handle, object);
  if (ensemble != nullptr && ensemble->answer.result == nullptr)
    throw InputError(handle + " is a part of an ensemble; `espdiff merge` puts the parts together");
  return ensemble;
}

/// What is known of one of an ensemble's fields.
struct FieldOfEnsemble {
  const EnsembleFile& file;
  const EnsembleResult& result;
  std::string label;
  bool is_signed = true;
};

FieldOfEnsemble field_of(const std::string& handle, const EnsembleAnswer& answer, const std::string& field) {
  if (field.empty()) return {*answer.file, *answer.result, ""};
  std::vector<std::string> names;
  for (const FieldAnswer& of : answer.fields) names.push_back(of.name);
  const FieldAnswer& of = answer.fields[place_of_field(handle, field, names)];
  const std::optional<FieldDescription>& described = of.file->plan().field;
  return {*of.file, *of.result, described->quantity.label, described->quantity.is_signed};
}

std::vector<float> faded(const EnsembleResult& result, int patch) {
  std::vector<float> values(result.tested.size(), kFaded);
  for (std::size_t k = 0; k < result.patches.size(); ++k) {
    if (patch > 0 && k + 1 != static_cast<std::size_t>(patch)) continue;
    for (const std::uint32_t v : result.patches[k].patch.vertices) values[v] = 0;
  }
  return values;
}

}  // namespace

std::optional<nlohmann::ordered_json> ensemble_result(const std::string& handle, const Object& object) {
  const EnsembleObject* const ensemble = finished(handle, object);
  if (ensemble == nullptr) return std::nullopt;
  const EnsembleAnswer& answer = ensemble->answer;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (answer.result != nullptr) json = ensemble_json(*answer.file, *answer.result);
  std::size_t n_frames = 0, n_resumed = 0, n_skipped = 0;
  double seconds = 0;
  json["files"] = answer.written;
  for (const EnsembleReport& report : answer.reports) {
    n_frames += report.n_frames;
    n_resumed += report.n_resumed;
    n_skipped += report.n_skipped;
    seconds += report.seconds;
    json["files"].push_back(report.path);
  }
  json["fields"] = nlohmann::ordered_json::array();
  for (const FieldAnswer& field : answer.fields) json["fields"].push_back(field.name);
  json["frames"] = n_frames;
  json["resumed"] = n_resumed;
  json["skipped"] = n_skipped;
  json["seconds"] = seconds;
  return json;
}

std::optional<std::string> ensemble_table(const std::string& handle, const Object& object) {
  const EnsembleObject* const ensemble = answered(handle, object);
  if (ensemble == nullptr) return std::nullopt;
  std::ostringstream text;
  print_ensemble(text, *ensemble->answer.file, *ensemble->answer.result);
  return text.str();
}

std::optional<DrawnSurface> ensemble_surface(const std::string& handle, const Object& object, const std::string& field,
                                             int patch) {
  const EnsembleObject* const ensemble = answered(handle, object);
  if (ensemble == nullptr) return std::nullopt;
  const EnsembleResult& result = field_of(handle, ensemble->answer, field).result;
  const TemplateSurface& surface = ensemble->answer.file->surface();
  if (patch < 0 || static_cast<std::size_t>(patch) > result.patches.size())
    throw InputError(option("patch", std::to_string(patch)) + ": " + handle + " has " +
                     std::to_string(result.patches.size()) + " patches, numbered from 1; 0 draws all");
  DrawnSurface drawn;
  for (const Vec3d& p : surface.positions) drawn.positions.push_back(static_cast<Vec3f>(p));
  drawn.normals = surface.normals;
  drawn.triangles = &surface.triangles;
  std::vector<std::uint8_t>& untested = ensemble->untested[field];
  if (untested.empty()) {
    for (const Triangle& t : surface.triangles)
      untested.push_back(result.tested[t[0]] == 0 || result.tested[t[1]] == 0 || result.tested[t[2]] == 0);
  }
  drawn.unmatched = &untested;
  drawn.has_unmatched_positions = true;
  if (!result.compares) return drawn;
  std::vector<float>& fading = ensemble->faded[{field, patch}];
  if (fading.empty()) fading = faded(result, patch);
  drawn.uncertainty = &fading;
  return drawn;
}

std::optional<VertexQuantity> ensemble_quantity(const std::string& handle, const Object& object,
                                                const std::string& name) {
  const EnsembleObject* const ensemble = answered(handle, object);
  if (ensemble == nullptr) return std::nullopt;
  const DrawnName drawn(name);
  const FieldOfEnsemble field = field_of(handle, ensemble->answer, drawn.field);
  const EnsembleResult& result = field.result;
  const std::string& unit = field.file.plan().potential_unit;
  const auto quantity = [&](const std::vector<double>& values, const std::string& in, bool is_signed) {
    return VertexQuantity{where_tested(values, result.tested), in, field.label, is_signed};
  };
  if (drawn.quantity == "source") return quantity(result.groups[0].mean, unit, field.is_signed);
  if (drawn.quantity != "target" && drawn.quantity != "difference" && drawn.quantity != "t")
    throw InputError("'" + drawn.quantity + "' is not difference, source, target or t");
  if (!result.compares) throw InputError(handle + " has one group, and so no " + drawn.quantity + "; take source");
  if (drawn.quantity == "target") return quantity(result.groups[1].mean, unit, field.is_signed);
  const PlaceTests& vertices = result.test.vertices;
  if (drawn.quantity == "t") return quantity(vertices.t, "", true);
  return quantity(vertices.difference, unit, true);
}

std::optional<std::string> merged_ensemble(const std::vector<std::string>& paths, const std::string& output,
                                           bool overwrite) {
  if (paths.empty() || !is_hdf5_file(paths.front()) || are_parts_of_template_matrix(paths)) return std::nullopt;
  EnsembleRun run;
  run.output = output;
  run.overwrite = overwrite;
  return merge_ensemble(paths, run).path;
}

#else

std::optional<std::string> merged_ensemble(const std::vector<std::string>&, const std::string&, bool) {
  return std::nullopt;
}
std::optional<nlohmann::ordered_json> ensemble_result(const std::string&, const Object&) { return std::nullopt; }
std::optional<std::string> ensemble_table(const std::string&, const Object&) { return std::nullopt; }
std::optional<DrawnSurface> ensemble_surface(const std::string&, const Object&, const std::string&, int) {
  return std::nullopt;
}
std::optional<VertexQuantity> ensemble_quantity(const std::string&, const Object&, const std::string&) {
  return std::nullopt;
}

#endif
}  // namespace espdiff::vmdplugin
