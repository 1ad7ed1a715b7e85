// next_command.cpp: what was typed, with changes, in a shell's words.
#include "cli/words/next_command.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>

#include "cli/words/spelling.h"
#include "field/field_kinds.h"
#include "field/field_patches.h"
#include "field/patches_request.h"
#include "potential/potential_settings.h"
#include "report/records/metrics.h"

namespace espdiff::cli {

namespace {

/// Rewrites the values of an option, wherever it was typed; without a value the option goes.
TypedWords with_values(const TypedWords& words, const std::string& option,
                       const std::function<std::optional<std::string>(const std::string&)>& value_of) {
  const std::string name = "--" + option, start = name + "=";
  TypedWords kept;
  for (auto word = words.begin(); word != words.end(); ++word) {
    const bool is_joined = word->rfind(start, 0) == 0;
    if (!is_joined && (*word != name || word + 1 == words.end())) {
      if (*word != name) kept.push_back(*word);
      continue;
    }
    const std::optional<std::string> value = value_of(is_joined ? word->substr(start.size()) : *++word);
    if (value) kept.insert(kept.end(), {name, *value});
  }
  return kept;
}

/// "(SO4,GOL)" of "(SO4)" and "(GOL)"; nothing where one is not a list of names.
std::optional<std::string> joined_names(const std::string& a, const std::string& b) {
  const auto is_list = [](const std::string& text) {
    return text.size() > 2 && text.front() == '(' && text.find_first_of("()!", 1) == text.size() - 1;
  };
  if (!is_list(a) || !is_list(b)) return std::nullopt;
  return a.substr(0, a.size() - 1) + "," + b.substr(1);
}

/// An option that leaves out more than what was typed; nothing where one value cannot say both.
std::optional<NamedOption> with_typed(const TypedWords& words, NamedOption option) {
  if (option.name != "leave-out") return option;
  std::optional<std::string> joined = option.value;
  with_values(words, option.name, [&](const std::string& typed) {
    if (joined) joined = joined_names(typed, *joined);
    return std::optional(typed);
  });
  if (!joined) return std::nullopt;
  option.value = *joined;
  return option;
}

TypedWords without(const TypedWords& words, const NamedOption& option) {
  if (!option.is_switch) return with_values(words, option.name, [](const std::string&) { return std::nullopt; });
  TypedWords kept;
  for (const std::string& word : words) {
    if (word != "--" + option.name && word.rfind("--" + option.name + "=", 0) != 0) kept.push_back(word);
  }
  return kept;
}

/// The fields of a value of --field that need neither potential nor charges. @param dropped receives the others' names
std::optional<std::string> fields_of_shapes(const std::string& value, std::set<std::string>& dropped) {
  std::string kept;
  for (const FieldRequest& request : parse_fields(value)) {
    if (kind_of(request).needs_charges) {
      dropped.insert(request.name);
    } else {
      kept += (kept.empty() ? "" : "|") + (request.name == request.what ? "" : request.name + "=") + request.what;
    }
  }
  return kept.empty() ? std::nullopt : std::optional(kept);
}

std::optional<std::string> patches_of_others(const std::string& value, const std::set<std::string>& dropped) {
  std::string kept;
  for (const PatchesRequest& request : parse_patches_of(value)) {
    if (dropped.count(request.field) == 0) kept += (kept.empty() ? "" : ",") + to_string(request);
  }
  return kept.empty() ? std::nullopt : std::optional(kept);
}

/// Whether a metric, or a field's, is one of shapes.
bool is_of_shapes(const std::string& metric, const std::set<std::string>& dropped) {
  const Metric* const known = find_metric_or_null(metric);
  if (known != nullptr) return known->section != MetricSection::kPotential;
  return std::none_of(dropped.begin(), dropped.end(),
                      [&](const std::string& field) { return metric.rfind(field + "_", 0) == 0; });
}

}  // namespace

TypedWords with_options(TypedWords words, const std::vector<NamedOption>& options) {
  for (const NamedOption& option : options) {
    words = without(words, option);
    words.push_back("--" + option.name);
    if (!option.is_switch) words.push_back(option.value);
  }
  return words;
}

TypedWords without_potential(TypedWords words) {
  for (const PotentialSetting& setting : potential_settings())
    words = without(words, {setting.name, "", setting.kind == SettingKind::kBoolean});
  for (const char* const name : {"causes", "side-chains"}) words = without(words, {name, ""});
  words = without(words, {"scan", "", true});
  std::set<std::string> dropped = {"potential"};
  words = with_values(words, "field", [&](const std::string& value) { return fields_of_shapes(value, dropped); });
  words = with_values(words, "patches-of", [&](const std::string& value) { return patches_of_others(value, dropped); });
  for (const char* const name : {"residue-quantity", "cluster-by"}) {
    words = with_values(words, name, [&](const std::string& value) {
      return is_of_shapes(value, dropped) ? std::optional(value) : std::nullopt;
    });
  }
  return words;
}

TypedWords exchanged(TypedWords words, const std::string& a, const std::string& b) {
  const auto first = std::find(words.begin(), words.end(), a), second = std::find(words.begin(), words.end(), b);
  if (first == words.end() || second == words.end()) return words;
  std::iter_swap(first, second);
  const std::string source = "--source-", target = "--target-";
  for (std::string& word : words) {
    if (word.rfind(source, 0) == 0) {
      word.replace(0, source.size(), target);
    } else if (word.rfind(target, 0) == 0) {
      word.replace(0, target.size(), source);
    }
  }
  return words;
}

std::string as_typed(const TypedWords& words) {
  std::string line = "espdiff";
  for (const std::string& word : words) line += " " + shell_quoted(word);
  return line;
}

std::string next_command(const TypedWords& words, const NextCommand& next) {
  const bool gives_up = std::any_of(next.options.begin(), next.options.end(), [](const NamedOption& option) {
    return option.name == "potential" && option.value == "none";
  });
  std::vector<NamedOption> options;
  for (const NamedOption& option : next.options) {
    const std::optional<NamedOption> whole = with_typed(words, option);
    if (!whole) return {};
    options.push_back(*whole);
  }
  return next.before + as_typed(with_options(gives_up ? without_potential(words) : words, options));
}

}  // namespace espdiff::cli
