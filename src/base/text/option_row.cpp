// option_row.cpp: numbers and words of options as texts.
#include "base/text/option_row.h"

#include <charconv>
#include <locale>
#include <sstream>

#include "base/error.h"
#include "base/message.h"

namespace espdiff {
namespace {

template <typename Number>
bool read_whole(const std::string& text, Number& value) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  return static_cast<bool>(in >> value) && (in >> std::ws).eof();
}

}  // namespace

const char* to_string(SettingKind kind) {
  switch (kind) {
    case SettingKind::kNumber: return "number";
    case SettingKind::kInteger: return "integer";
    case SettingKind::kBoolean: return "boolean";
    case SettingKind::kChoice: return "choice";
    case SettingKind::kText: break;
  }
  return "text";
}

void refuse_value(const std::string& name, const std::string& text, const std::string& accepted) {
  throw InputError(option(name) + ": '" + text + "' is not " + accepted);
}

bool read_value(const std::string& text, double& value) { return read_whole(text, value); }
bool read_value(const std::string& text, long long& value) { return read_whole(text, value); }

std::string written_value(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general).ptr};
}

bool is_within(const NumberRange& range, double value) {
  return std::isfinite(value) && (range.is_above ? value > range.low : value >= range.low) && value <= range.high;
}

std::string to_string(const NumberRange& range, SettingKind kind) {
  const bool is_whole = kind == SettingKind::kInteger;
  const auto written = [is_whole](double value) {
    return is_whole ? std::to_string(static_cast<long long>(value)) : written_value(value);
  };
  if (!std::isfinite(range.low)) return is_whole ? "a whole number" : "a number";
  const std::string text = is_whole ? "a whole number " : "a number ", low = written(range.low);
  const bool has_end = std::isfinite(range.high);
  if (range.is_above) return text + "above " + low + (has_end ? ", at most " + written(range.high) : "");
  return has_end ? text + "from " + low + " to " + written(range.high) : text + "of " + low + " or more";
}

}  // namespace espdiff
