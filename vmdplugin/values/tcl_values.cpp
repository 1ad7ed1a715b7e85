// tcl_values.cpp: converts between Tcl's values and C++ values.
#include "tcl_values.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace espdiff::vmdplugin {

Tcl_Obj* to_obj(const std::string& text) { return Tcl_NewStringObj(text.data(), static_cast<int>(text.size())); }
Tcl_Obj* to_obj(const char* text) { return Tcl_NewStringObj(text, -1); }
Tcl_Obj* to_obj(int value) { return Tcl_NewIntObj(value); }
Tcl_Obj* to_obj(std::size_t value) { return Tcl_NewWideIntObj(static_cast<Tcl_WideInt>(value)); }
Tcl_Obj* to_obj(bool value) { return Tcl_NewIntObj(value ? 1 : 0); }
Tcl_Obj* to_obj(double value) { return std::isnan(value) ? Tcl_NewObj() : Tcl_NewDoubleObj(value); }

Tcl_Obj* to_list(const std::vector<Tcl_Obj*>& elements) {
  return Tcl_NewListObj(static_cast<int>(elements.size()), elements.data());
}

Tcl_Obj* to_list(const std::vector<std::string>& elements) {
  Tcl_Obj* const list = Tcl_NewListObj(0, nullptr);
  for (const std::string& element : elements) Tcl_ListObjAppendElement(nullptr, list, to_obj(element));
  return list;
}

Tcl_Obj* to_dict(std::initializer_list<std::pair<const char*, Tcl_Obj*>> entries) {
  Tcl_Obj* const dict = Tcl_NewDictObj();
  for (const auto& [key, value] : entries) Tcl_DictObjPut(nullptr, dict, to_obj(key), value);
  return dict;
}

Tcl_Obj* to_obj(const nlohmann::ordered_json& json) {
  if (json.is_object()) {
    Tcl_Obj* const dict = Tcl_NewDictObj();
    for (const auto& [key, value] : json.items()) Tcl_DictObjPut(nullptr, dict, to_obj(key), to_obj(value));
    return dict;
  }
  if (json.is_array()) {
    Tcl_Obj* const list = Tcl_NewListObj(0, nullptr);
    for (const auto& element : json) Tcl_ListObjAppendElement(nullptr, list, to_obj(element));
    return list;
  }
  if (json.is_boolean()) return to_obj(json.get<bool>());
  if (json.is_number_integer()) return Tcl_NewWideIntObj(json.get<Tcl_WideInt>());
  if (json.is_number()) return to_obj(json.get<double>());
  if (json.is_string()) return to_obj(json.get<std::string>());
  return Tcl_NewObj();
}

std::string to_string(Tcl_Obj* value) {
  int length = 0;
  const char* const text = Tcl_GetStringFromObj(value, &length);
  return {text, static_cast<std::size_t>(length)};
}

namespace {

[[noreturn]] void refuse(Tcl_Obj* value, const std::string& what, const char* accepted) {
  throw InputError(what + ": '" + to_string(value) + "' is not " + accepted);
}

}  // namespace

int to_int(Tcl_Obj* value, const std::string& what) {
  int result = 0;
  if (Tcl_GetIntFromObj(nullptr, value, &result) != TCL_OK) refuse(value, what, "a whole number");
  return result;
}

double to_double(Tcl_Obj* value, const std::string& what) {
  double result = 0;
  if (Tcl_GetDoubleFromObj(nullptr, value, &result) != TCL_OK || !std::isfinite(result))
    refuse(value, what, "a number");
  return result;
}

bool to_bool(Tcl_Obj* value, const std::string& what) {
  int result = 0;
  if (Tcl_GetBooleanFromObj(nullptr, value, &result) != TCL_OK) refuse(value, what, "0 or 1");
  return result != 0;
}

std::vector<Tcl_Obj*> to_vector(Tcl_Obj* value, const std::string& what) {
  int n = 0;
  Tcl_Obj** elements = nullptr;
  if (Tcl_ListObjGetElements(nullptr, value, &n, &elements) != TCL_OK) refuse(value, what, "a list");
  return {elements, elements + n};
}

std::string key_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

DictReader::DictReader(Tcl_Obj* dict, std::string what) : dict_(dict), what_(std::move(what)) {
  int size = 0;
  if (Tcl_DictObjSize(nullptr, dict_, &size) != TCL_OK)
    refuse(dict_, what_, "a list of keys and values, such as {file a.pqr map a.dx}");
}

Tcl_Obj* DictReader::find(const char* key) {
  known_.emplace_back(key);
  Tcl_Obj* const key_obj = to_obj(key);
  Tcl_IncrRefCount(key_obj);
  Tcl_Obj* value = nullptr;
  Tcl_DictObjGet(nullptr, dict_, key_obj, &value);
  Tcl_DecrRefCount(key_obj);
  return value;
}

Tcl_Obj* DictReader::require(const char* key) {
  Tcl_Obj* const value = find(key);
  if (value == nullptr) throw InputError(what_ + ": the key '" + key + "' is missing");
  return value;
}

std::string DictReader::text(const char* key, const std::string& otherwise) {
  Tcl_Obj* const value = find(key);
  return value != nullptr ? to_string(value) : otherwise;
}
int DictReader::integer(const char* key, int otherwise) {
  Tcl_Obj* const value = find(key);
  return value != nullptr ? to_int(value, path_to(key)) : otherwise;
}
double DictReader::number(const char* key, double otherwise) {
  Tcl_Obj* const value = find(key);
  return value != nullptr ? to_double(value, path_to(key)) : otherwise;
}
bool DictReader::boolean(const char* key, bool otherwise) {
  Tcl_Obj* const value = find(key);
  return value != nullptr ? to_bool(value, path_to(key)) : otherwise;
}

std::vector<std::pair<std::string, std::string>> DictReader::rest() const {
  std::vector<std::pair<std::string, std::string>> entries;
  Tcl_DictSearch search;
  Tcl_Obj *key = nullptr, *value = nullptr;
  int done = 0;
  if (Tcl_DictObjFirst(nullptr, dict_, &search, &key, &value, &done) != TCL_OK) return entries;
  for (; done == 0; Tcl_DictObjNext(&search, &key, &value, &done)) {
    const std::string name = to_string(key);
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) entries.emplace_back(name, to_string(value));
  }
  Tcl_DictObjDone(&search);
  return entries;
}

void DictReader::finish() const {
  const auto unknown = rest();
  if (unknown.empty()) return;
  std::string list;
  for (const std::string& key : known_) list += (list.empty() ? "" : ", ") + key;
  throw InputError(what_ + ": there is no key '" + unknown.front().first + "'; there are " + list);
}

}  // namespace espdiff::vmdplugin
