// patches_request.cpp: which fields' patches are asked for, and beyond which thresholds.
#include "field/patches_request.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/printable.h"
#include "field/field_patches.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

PatchesRequest parse_request(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(option("patches-of") + ": '" + printable(text) + "' " + why +
                     "; write FIELD>T for what lies above T, FIELD<T for what lies below, or FIELD>T<U");
  };
  PatchesRequest request;
  std::size_t at = text.find_first_of("<>");
  request.field = text.substr(0, at);
  if (request.field.empty()) refuse("names no field");
  if (at == std::string::npos) {
    if (request.field != "potential") refuse("has no threshold");
    request.above = 1;
    request.below = -1;
    return request;
  }
  while (at != std::string::npos) {
    const std::size_t next = text.find_first_of("<>", at + 1);
    const std::string number = text.substr(at + 1, next == std::string::npos ? next : next - at - 1);
    std::optional<double>& threshold = text[at] == '>' ? request.above : request.below;
    double value = 0;
    if (threshold) refuse(std::string("has two thresholds behind ") + text[at]);
    if (!parse_number(number, value) || !std::isfinite(value)) refuse("has no number behind " + text.substr(at, 1));
    threshold = value;
    at = next;
  }
  if (request.above && request.below && *request.below > *request.above) refuse("has thresholds that overlap");
  return request;
}

}  // namespace

std::vector<PatchesRequest> parse_patches_of(const std::string& text) {
  std::vector<PatchesRequest> requests;
  std::istringstream list(text);
  for (std::string entry; std::getline(list, entry, ',');) requests.push_back(parse_request(entry));
  return requests;
}

std::string to_string(const PatchesRequest& request) {
  std::string text = request.field;
  if (request.above) text += ">" + formatted("%.9g", *request.above);
  if (request.below) text += "<" + formatted("%.9g", *request.below);
  return text;
}

void check_patches_of(const std::vector<PatchesRequest>& requests, const std::vector<FieldRequest>& fields) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const std::string& name = requests[i].field;
    if (name != "potential" &&
        std::none_of(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; }))
      throw InputError(option("patches-of", to_string(requests[i])) + ": the field '" + printable(name) +
                       "' is not compared; give " + option("field", printable(name)) + " as well");
    for (std::size_t j = 0; j < i; ++j) {
      if (requests[j].field == name)
        throw InputError(option("patches-of") + ": the field '" + name + "' is there twice; give both thresholds at " +
                         "once, as in " + name + ">1<-1");
    }
  }
}

}  // namespace espdiff
