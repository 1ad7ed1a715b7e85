// ensemble_views.h: what is told and drawn of an ensemble. Each function returns nothing for other kinds of objects.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drawn_part.h"
#include "handles.h"
#include "vertex_quantity.h"

namespace espdiff::vmdplugin {

/// How much the colours of surface without significance fade, of a limit of 1.
constexpr float kFaded = 0.92F;

/// JSON of the result, as OUT.json has it, and how the run went. @throws the failure of the object's job
std::optional<nlohmann::ordered_json> ensemble_result(const std::string& handle, const Object& object);

/// The printed answer. @throws the same; InputError (a part)
std::optional<std::string> ensemble_table(const std::string& handle, const Object& object);

/// The template. Parts that were not tested are unmatched; uncertainty is 0 where the difference is significant, and
/// kFaded elsewhere.
/// @param field that is drawn; empty for the potential  @param patch 0, or the number of the only patch that counts as
/// significant
std::optional<DrawnSurface> ensemble_surface(const std::string& handle, const Object& object, const std::string& field,
                                             int patch);

/// @param name difference, source (the first group's mean), target (the second's), or t; of a field FIELD:difference
/// and so on
/// @throws the same; InputError (another name; one group has no difference)
std::optional<VertexQuantity> ensemble_quantity(const std::string& handle, const Object& object,
                                                const std::string& name);

/// Merges the parts of an ensemble; nothing where the first path is no file of HDF5, or of a matrix.
/// @returns OUT.h5. @throws as merge_ensemble()
std::optional<std::string> merged_ensemble(const std::vector<std::string>& paths, const std::string& output,
                                           bool overwrite);

}  // namespace espdiff::vmdplugin
