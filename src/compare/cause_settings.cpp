// cause_settings.cpp: settings that say which causes of a difference are wanted.
#include <algorithm>
#include <charconv>
#include <sstream>

#include "causes/reading.h"
#include "compare/input_settings.h"
#include "compare/options.h"
#include "compare/settings.h"

namespace espdiff {
namespace {

/// A list of readings; setting it again adds to it.
Setting causes_row() {
  Setting row{
      "causes",
      kRegionGroup,
      SettingKind::kText,
      {},
      "Which charges make the difference: of region, patch NAME, residue CHAIN:NUMBER (the mean difference over "
      "its surface), or whole (the mean absolute difference). Writes OUT.causes.csv. Several may be given; of a "
      "pair whose potentials are computed by a linear equation",
      false,
      nullptr,
      nullptr};
  row.set = [](CompareOptions& o, const std::string& text) {
    std::istringstream list(text);
    for (std::string reading; std::getline(list, reading, ',');) {
      parse_reading(reading);
      if (std::find(o.causes.begin(), o.causes.end(), reading) == o.causes.end()) o.causes.push_back(reading);
    }
  };
  row.get = [](const CompareOptions& o) {
    std::string text;
    for (const std::string& reading : o.causes) text += (text.empty() ? "" : ",") + reading;
    return text;
  };
  row.is_list = true;
  return row;
}

Setting scan_row() {
  Setting row{"scan",
              kRegionGroup,
              SettingKind::kBoolean,
              {},
              "For each of the causes' readings, how it would shift without each residue's charges, and with one "
              "elementary charge more or less at their centre; shape and protonation are kept. Writes OUT.scan.csv",
              false,
              nullptr,
              nullptr};
  row.set = [](CompareOptions& o, const std::string& text) {
    if (text != "0" && text != "1") refuse_value("scan", text, "0 or 1");
    o.scan = text == "1";
  };
  row.get = [](const CompareOptions& o) { return o.scan ? "1" : "0"; };
  return row;
}

/// A whole number from 0 to a million, of draws.
Setting draws_row(const std::string& name, int CompareOptions::*at, const std::string& help) {
  Setting row{name, kRegionGroup, SettingKind::kInteger, {}, help, false, nullptr, nullptr};
  row.set = [name, at](CompareOptions& o, const std::string& text) {
    constexpr int kMost = 1000000;
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > kMost)
      refuse_value(name, text, "a whole number from 0 to 1000000");
    o.*at = value;
  };
  row.get = [at](const CompareOptions& o) { return std::to_string(o.*at); };
  return row;
}

}  // namespace

void add_cause_settings(std::vector<Setting>& all) {
  all.push_back(causes_row());
  all.push_back(scan_row());
  all.push_back(draws_row("side-chains", &CompareOptions::side_chains,
                          "For each of the causes' readings, its interval over so many draws of other placements of "
                          "surface side chains that are poorly known or turned (a grid of their angles; clashes are "
                          "refused)"));
  all.push_back(draws_row("side-chain-seed", &CompareOptions::side_chain_seed,
                          "Random seed of those draws; written into the result"));
}

}  // namespace espdiff
