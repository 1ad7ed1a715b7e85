// tcl_values.h: converts between Tcl's values and C++ values.
#pragma once

#include <tcl.h>

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/text/option_row.h"

namespace espdiff::vmdplugin {

/// Each returns a new object with reference count 0.
Tcl_Obj* to_obj(const std::string& text);
Tcl_Obj* to_obj(const char* text);
Tcl_Obj* to_obj(int value);
Tcl_Obj* to_obj(std::size_t value);
Tcl_Obj* to_obj(bool value);
/// NaN, which Tcl cannot compute with, becomes the empty string.
Tcl_Obj* to_obj(double value);
Tcl_Obj* to_list(const std::vector<Tcl_Obj*>& elements);
Tcl_Obj* to_list(const std::vector<std::string>& elements);
Tcl_Obj* to_dict(std::initializer_list<std::pair<const char*, Tcl_Obj*>> entries);
/// Objects become dicts, arrays lists, null the empty string, true and false 1 and 0.
Tcl_Obj* to_obj(const nlohmann::ordered_json& json);

std::string to_string(Tcl_Obj* value);
/// Each throws InputError with `what` and the value if it has another type.
int to_int(Tcl_Obj* value, const std::string& what);
double to_double(Tcl_Obj* value, const std::string& what);
bool to_bool(Tcl_Obj* value, const std::string& what);
std::vector<Tcl_Obj*> to_vector(Tcl_Obj* value, const std::string& what);

/// An option's name as a key: `most_missing` of `most-missing`.
std::string key_of(std::string name);

/// Reads a dict key by key. finish() refuses keys that were not read.
class DictReader {
 public:
  /// @param what for messages: "source", "options"
  /// @throws InputError when the value is no dict
  DictReader(Tcl_Obj* dict, std::string what);

  /// The value, or null.
  Tcl_Obj* find(const char* key);
  /// @throws InputError when there is none
  Tcl_Obj* require(const char* key);
  std::string text(const char* key, const std::string& otherwise = "");
  int integer(const char* key, int otherwise);
  double number(const char* key, double otherwise);
  bool boolean(const char* key, bool otherwise);
  /// Sets what is there of a table's options: the key of `most-missing` is most_missing.
  template <typename Study>
  void take(const std::vector<OptionRow<Study>>& rows, Study& study) {
    for (const OptionRow<Study>& row : rows) {
      if (Tcl_Obj* const value = find(key_of(row.name).c_str())) row.set(study, to_string(value));
    }
  }
  /// The keys that were not read yet, with their values.
  std::vector<std::pair<std::string, std::string>> rest() const;
  /// @throws InputError that lists the keys there are, when an unread one is left
  void finish() const;

 private:
  std::string path_to(const char* key) const { return what_ + " " + key; }

  Tcl_Obj* dict_;
  std::string what_;
  std::vector<std::string> known_;
};

}  // namespace espdiff::vmdplugin
