// compare_json.h: the record of a comparison.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/types.h"

namespace espdiff {

struct CompareOptions;
struct CompareResult;
struct Provenance;

/// The content of OUT.json: every metric, the certificate, and what repeats the run.
/// What has no value (NaN, potentials without maps, what this version does not check) is null. Texts need not be UTF-8.
/// @param spelling of the options that messages name; files have their bare names
nlohmann::ordered_json compare_json(const Molecule& source, const Molecule& target, const CompareResult& result,
                                    const CompareOptions& options, const Provenance& provenance,
                                    const OptionSpelling& spelling = bare_name);

/// Settings as numbers, booleans and texts, by Setting::key(); without `thesis`, which stands for values of others.
/// @throws InputError as find_setting()
nlohmann::ordered_json options_json(const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace espdiff
