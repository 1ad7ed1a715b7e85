// cause_settings.cpp: settings that say which causes of a difference are wanted.
#include "options/cause_settings.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "base/text/printable.h"
#include "causes/reading.h"
#include "options/options.h"
#include "options/settings.h"

namespace espdiff {
namespace {

using Rows = RowsOf<CompareOptions>;

/// A list of readings; setting it again adds to it.
Setting causes_row() {
  Setting row = Rows::parsed(
      "causes", kRegionGroup,
      [](CompareOptions& o, const std::string& text) {
        std::istringstream list(text);
        for (std::string reading; std::getline(list, reading, ',');) {
          parse_reading(reading);
          if (std::find(o.causes.begin(), o.causes.end(), reading) == o.causes.end()) o.causes.push_back(reading);
        }
      },
      [](const CompareOptions& o) {
        std::string text;
        for (const std::string& reading : o.causes) text += (text.empty() ? "" : ",") + reading;
        return text;
      },
      "Which charges make the difference: of region, patch NAME, residue CHAIN:NUMBER (the mean difference over "
      "its surface), or whole (the mean absolute difference). Writes OUT.causes.csv. Several may be given; of a "
      "pair whose potentials are computed by a linear equation");
  row.is_list = true;
  return row;
}

constexpr NumberRange kDraws{0, 1e6};

}  // namespace

void add_cause_settings(std::vector<Setting>& all) {
  all.push_back(causes_row());
  all.push_back(Rows::boolean(
      "scan", kRegionGroup, [](auto& o) -> auto& { return o.scan; },
      "For each of the causes' readings, how it would shift without each residue's charges, and with one elementary "
      "charge more or less at their centre; shape and protonation are kept. Writes OUT.scan.csv"));
  all.push_back(Rows::count(
      "side-chains", kRegionGroup, kDraws, [](auto& o) -> auto& { return o.side_chains; },
      "For each of the causes' readings, its interval over so many draws of other placements of surface side chains "
      "that are poorly known or turned (a grid of their angles; clashes are refused)"));
  all.push_back(Rows::count(
      "side-chain-seed", kRegionGroup, kDraws, [](auto& o) -> auto& { return o.side_chain_seed; },
      "Random seed of those draws; written into the result"));
}

void require_patch(const CompareOptions& options, const std::string& text, const std::string& name) {
  const auto is_it = [&](const PatchRequest& patch) { return patch.name == name; };
  if (std::any_of(options.input.patches.begin(), options.input.patches.end(), is_it)) return;
  throw InputError(option("causes", text) + ": there is no patch of that name; name a selection " + printable(name) +
                   " by " + option("patch"));
}

void check_readings(const CompareOptions& options) {
  for (const char* name : {"scan", "side-chains"}) {
    const bool is_asked = name == std::string("scan") ? options.scan : options.side_chains > 0;
    if (is_asked && options.causes.empty())
      throw InputError(option(name) + " is of a reading: give " + option("causes") + " as well, such as " +
                       option("causes", "whole"));
  }
  const auto is_whole = [](const std::string& text) { return parse_reading(text).of == ReadingOf::kWhole; };
  if (options.side_chains > 0 && std::all_of(options.causes.begin(), options.causes.end(), is_whole))
    throw InputError(option("side-chains") + " is of a mean difference: give " + option("causes", "region") +
                     ", a patch or a residue; the whole's reading is a mean of sizes, which is not linear");
  for (const std::string& text : options.causes) {
    const ReadingRequest request = parse_reading(text);
    if (request.of == ReadingOf::kRegion && !options.input.has_region())
      throw InputError(option("causes", "region") + " needs a region: give " + option("region") + " or " +
                       option("region-within") + " and " + option("of"));
    // A number may be that of a patch which an ensemble finds.
    const bool is_number = request.patch.find_first_not_of("0123456789") == std::string::npos;
    if (request.of == ReadingOf::kPatch && !is_number) require_patch(options, text, request.patch);
  }
}

void refuse_causes(const CompareOptions& options, const char* of_what) {
  if (options.causes.empty()) return;
  throw InputError(option("causes") + " is of one pair, not of " + of_what +
                   "; compare the two states in question with it");
}

}  // namespace espdiff
