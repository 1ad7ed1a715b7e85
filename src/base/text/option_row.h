// option_row.h: one option of a computation by name, once for the command line, Tcl, Python and their manuals; and how
// rows of each kind are made.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text/joined_words.h"

namespace espdiff {

enum class SettingKind { kNumber, kInteger, kBoolean, kChoice, kText };
/// "number", "integer", "boolean", "choice", "text"
const char* to_string(SettingKind kind);

/// One option of `Options`. Its name is `--grid-spacing` on the command line, `-grid-spacing` in Tcl, `grid_spacing` in
/// Python.
template <typename Options>
struct OptionRow {
  std::string name;
  std::string group;  ///< heading under which manuals list it
  SettingKind kind = SettingKind::kText;
  std::vector<std::string> choices;  ///< of a choice
  std::string help;                  ///< with the unit
  /// Sets the value from its text.
  /// @throws InputError naming the option, the text and the accepted values
  std::function<void(Options&, const std::string&)> set;
  /// The value as a text that set() accepts.
  std::function<std::string(const Options&)> get;
  bool is_file = false;         ///< the text names files, which are sought from the working folder
  std::string other_name = {};  ///< on the command line, besides: "colour" of "color"
  std::string accepts = {};     ///< its values, as messages call them; empty: the choices, or what `help` says

  /// The help with the accepted values.
  std::string full_help() const { return accepts.empty() ? help : help + "; " + accepts; }
};

/// The numbers that an option accepts. Its ends keep the work that follows within reason: beyond them nobody compares
/// surfaces, and a computation lasts for days or ends in a lack of memory. What a molecule makes of a value is asked
/// when the molecule is known (base/work.h).
struct NumberRange {
  double low, high = HUGE_VAL;  ///< included, but for `low` where `is_above`
  bool is_above = false;
};
constexpr NumberRange kNotNegative{0}, kShare{0, 1};
/// "a number from 0 to 1", "a whole number of 0 or more", "a number above 1"
std::string to_string(const NumberRange& range, SettingKind kind);

/// @throws InputError "--NAME: 'TEXT' is not ACCEPTED"
[[noreturn]] void refuse_value(const std::string& name, const std::string& text, const std::string& accepted);

/// Reads a number in the C locale, whatever locale the host program has set. @returns false for anything else
bool read_value(const std::string& text, double& value);
bool read_value(const std::string& text, long long& value);
/// The shortest text that reads back as the same value.
std::string written_value(double value);
bool is_within(const NumberRange& range, double value);

/// The rows of each kind. `at` finds the value in the options: `[](auto& o) -> auto& { return o.alpha; }`.
template <typename Options>
struct RowsOf {
  using Row = OptionRow<Options>;

  template <typename At>
  static Row number(const std::string& name, const std::string& group, NumberRange range, At at,
                    const std::string& help) {
    Row row{name, group, SettingKind::kNumber, {}, help, nullptr, nullptr};
    row.accepts = to_string(range, row.kind);
    row.set = [name, range, at, accepts = row.accepts](Options& o, const std::string& text) {
      double value = 0;
      if (!read_value(text, value) || !is_within(range, value)) refuse_value(name, text, accepts);
      at(o) = value;
    };
    row.get = [at](const Options& o) { return written_value(at(o)); };
    return row;
  }

  template <typename At>
  static Row count(const std::string& name, const std::string& group, NumberRange range, At at,
                   const std::string& help) {
    Row row{name, group, SettingKind::kInteger, {}, help, nullptr, nullptr};
    row.accepts = to_string(range, row.kind);
    row.set = [name, range, at, accepts = row.accepts](Options& o, const std::string& text) {
      long long value = 0;
      if (!read_value(text, value) || !is_within(range, static_cast<double>(value))) refuse_value(name, text, accepts);
      at(o) = static_cast<std::decay_t<decltype(at(o))>>(value);
    };
    row.get = [at](const Options& o) { return std::to_string(at(o)); };
    return row;
  }

  /// A number that may be missing: an empty text.
  template <typename At>
  static Row optional_number(const std::string& name, const std::string& group, NumberRange range, At at,
                             const std::string& help) {
    Row row{name, group, SettingKind::kText, {}, help, nullptr, nullptr};
    row.accepts = to_string(range, SettingKind::kNumber);
    row.set = [name, range, at, accepts = row.accepts](Options& o, const std::string& text) {
      double value = 0;
      if (!text.empty() && (!read_value(text, value) || !is_within(range, value))) refuse_value(name, text, accepts);
      at(o).reset();
      if (!text.empty()) at(o) = value;
    };
    row.get = [at](const Options& o) { return at(o) ? written_value(*at(o)) : std::string(); };
    return row;
  }

  template <typename At>
  static Row boolean(const std::string& name, const std::string& group, At at, const std::string& help) {
    Row row{name, group, SettingKind::kBoolean, {}, help, nullptr, nullptr};
    row.set = [name, at](Options& o, const std::string& text) {
      if (text != "0" && text != "1") refuse_value(name, text, "0 or 1");
      at(o) = text == "1";
    };
    row.get = [at](const Options& o) { return at(o) ? "1" : "0"; };
    return row;
  }

  template <typename At>
  static Row text(const std::string& name, const std::string& group, At at, const std::string& help) {
    return parsed(
        name, group, [at](Options& o, const std::string& text) { at(o) = text; },
        [at](const Options& o) { return at(o); }, help);
  }

  template <typename At>
  static Row file(const std::string& name, const std::string& group, At at, const std::string& help) {
    Row row = text(name, group, at, help);
    row.is_file = true;
    return row;
  }

  /// A text with a form of its own. @param set throws InputError for another one
  template <typename Set, typename Get>
  static Row parsed(const std::string& name, const std::string& group, Set set, Get get, const std::string& help) {
    return {name, group, SettingKind::kText, {}, help, set, get};
  }

  /// One of some words, which `set` takes.
  template <typename Set, typename Get>
  static Row choice(const std::string& name, const std::string& group, const std::vector<std::string>& choices, Set set,
                    Get get, const std::string& help) {
    Row row{name, group, SettingKind::kChoice, choices, help, nullptr, get};
    row.set = [name, choices, set](Options& o, const std::string& text) {
      for (const std::string& word : choices) {
        if (word == text) return set(o, text);
      }
      refuse_value(name, text, joined_words(choices));
    };
    return row;
  }

  /// One of some words, which is the value.
  template <typename At>
  static Row word(const std::string& name, const std::string& group, const std::vector<std::string>& choices, At at,
                  const std::string& help) {
    return choice(
        name, group, choices, [at](Options& o, const std::string& text) { at(o) = text; },
        [at](const Options& o) { return at(o); }, help);
  }

  /// One of some words, each of which stands for a value.
  template <typename Value, typename At>
  static Row choice_of(const std::string& name, const std::string& group,
                       const std::vector<std::pair<std::string, Value>>& values, At at, const std::string& help) {
    std::vector<std::string> words;
    for (const auto& [word, value] : values) words.push_back(word);
    return choice(
        name, group, words,
        [values, at](Options& o, const std::string& text) {
          for (const auto& [word, value] : values) {
            if (word == text) at(o) = value;
          }
        },
        [values, at](const Options& o) {
          for (const auto& [word, value] : values) {
            if (at(o) == value) return word;
          }
          return std::string();
        },
        help);
  }
};

/// Sets the option of this name. @returns false where there is none. @throws InputError as OptionRow::set
template <typename Options>
bool set_row(const std::vector<OptionRow<Options>>& rows, Options& options, const std::string& name,
             const std::string& text) {
  for (const OptionRow<Options>& row : rows) {
    if (row.name != name) continue;
    row.set(options, text);
    return true;
  }
  return false;
}

/// Sets what is given by name. @throws InputError as OptionRow::set
template <typename Options>
void set_rows(const std::vector<OptionRow<Options>>& rows, Options& options,
              const std::vector<std::pair<std::string, std::string>>& given) {
  for (const auto& [name, text] : given) set_row(rows, options, name, text);
}

}  // namespace espdiff
