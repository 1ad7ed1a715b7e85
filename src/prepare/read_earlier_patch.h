// read_earlier_patch.h: a significant patch of an earlier ensemble, from its OUT.json and OUT.vtp.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "base/molecule/input_options.h"

namespace espdiff {

struct EarlierPatch;

/// What FILE.json:NUMBER names.
struct EarlierPatchName {
  std::string path;
  std::string number;  ///< digits
};

/// Whether a patch's selection names a patch of an earlier result: empty unless it ends with ".json:" and digits.
std::optional<EarlierPatchName> earlier_patch_name(const std::string& selection);

/// OUT.vtp beside OUT.json.
std::string surface_beside(const EarlierPatchName& name);

/// Reads OUT.json, and OUT.vtp beside it.
/// @throws FormatError (not the files of an ensemble; not of one run), InputError (no such patch), as read_input(),
///         read_vtp()
std::shared_ptr<const EarlierPatch> read_earlier_patch(const EarlierPatchName& name);

}  // namespace espdiff
