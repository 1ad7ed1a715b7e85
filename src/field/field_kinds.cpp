// field_kinds.cpp: fields by request.
#include "field/field_kinds.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "base/text/printable.h"
#include "field/field_files.h"

namespace espdiff {
namespace {

/// KIND and ARGUMENT.
std::pair<std::string, std::string> split(const std::string& what) {
  const std::size_t colon = what.find(':');
  if (colon == std::string::npos) return {what, ""};
  return {what.substr(0, colon), what.substr(colon + 1)};
}

/// Letters, digits and `_`, `-`, `.`: a name is part of columns, of arrays and of JSON's keys.
void check_name(const std::string& name, const std::string& text) {
  constexpr std::size_t kLongest = 40;
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto is_good = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  };
  if (name.empty() || !is_letter(name.front()) || name.size() > kLongest ||
      !std::all_of(name.begin(), name.end(), is_good))
    throw InputError(option("field") + ": the name '" + printable(name) + "' of '" + printable(text) +
                     "' is not a letter followed by letters, digits, _, - and . (at most " + std::to_string(kLongest) +
                     " in all)");
  if (name == "potential" || name == kRegionPart)
    throw InputError(option("field") + ": the name '" + name + "' is taken in results; take another one, such as my_" +
                     name);
}

const FieldKind& find_kind(const std::string& what, const std::string& text) {
  const auto [name, argument] = split(what);
  std::string list;
  for (const FieldKind& kind : field_kinds()) {
    list += (list.empty() ? "" : ", ") + kind.quantity.name;
    if (kind.quantity.name != name) continue;
    if (kind.argument.empty() && what.find(':') != std::string::npos)
      throw InputError(option("field") + ": '" + printable(text) + "': the field " + name +
                       " takes nothing behind a colon");
    if (!kind.argument.empty() && kind.argument.front() != '[' && argument.empty())
      throw InputError(option("field") + ": '" + printable(text) + "': the field " + name + " is written " + name +
                       ":" + kind.argument);
    return kind;
  }
  for (const char* const of_deform : {"density", "distance", "gvf", "gvf2"}) {
    if (what == of_deform)
      throw InputError(option("field") + ": '" + what + "' is a field of the method deform, which " +
                       option("deform-field", what) + " chooses");
  }
  throw InputError(option("field") + ": there is no field '" + printable(name) + "'; there are: " + list);
}

FieldRequest parse_field(const std::string& text) {
  const std::size_t sign = text.find('=');
  FieldRequest request;
  if (sign == std::string::npos) {
    request = {split(text).first, text};
  } else {
    request = {text.substr(0, sign), text.substr(sign + 1)};
    if (request.what.empty()) request.what = request.name;
  }
  find_kind(request.what, text);
  check_name(request.name, text);
  return request;
}

}  // namespace

std::vector<FieldRequest> parse_fields(const std::string& text) {
  std::vector<FieldRequest> requests;
  std::istringstream list(text);
  for (std::string entry; std::getline(list, entry, '|');) requests.push_back(parse_field(entry));
  if (requests.empty()) throw InputError(option("field") + ": '' names no field");
  return requests;
}

void check_fields(const std::vector<FieldRequest>& requests, const std::vector<std::string>& taken) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (std::find(taken.begin(), taken.end(), requests[i].name) != taken.end())
      throw InputError(option("field") + ": the patch '" + requests[i].name +
                       "' has that name, too, and columns would mix them up; name the field, as in " +
                       option("field", "other=" + requests[i].what));
    for (std::size_t j = 0; j < i; ++j) {
      if (requests[i].name != requests[j].name) continue;
      throw InputError(option("field") + ": two fields are called '" + requests[i].name +
                       "'; name one of them, as in " + option("field", "other=" + requests[i].what));
    }
  }
}

const FieldKind& kind_of(const FieldRequest& request) { return find_kind(request.what, request.what); }

std::vector<Field> make_fields(const std::vector<FieldRequest>& requests) {
  std::vector<Field> fields;
  for (const FieldRequest& request : requests) {
    const FieldKind& kind = kind_of(request);
    Field field = kind.field(kind, split(request.what).second);
    field.quantity.name = request.name;
    field.what = request.what;
    fields.push_back(std::move(field));
  }
  return fields;
}

std::vector<FieldDescription> describe(const std::vector<Field>& fields) {
  std::vector<FieldDescription> all;
  for (const Field& field : fields) all.push_back({field.quantity, field.what, field.reference, field.files});
  return all;
}

std::vector<std::string> files_of(const FieldRequest& request) {
  const auto [name, argument] = split(request.what);
  for (const FieldKind& kind : field_kinds()) {
    if (kind.quantity.name == name && kind.argument.find("FILE") != std::string::npos)
      return SideFiles(name, argument).all();
  }
  return {};
}

}  // namespace espdiff
