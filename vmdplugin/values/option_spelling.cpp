// option_spelling.cpp: how Tcl writes the options that messages name.
#include "option_spelling.h"

#include <vector>

#include "tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

constexpr const char* kVariable = "::espdiff::option_spelling";

/// Options of the command line that are keys of an endpoint in Tcl.
struct EndpointKey {
  const char *option, *words;
};
constexpr EndpointKey kEndpointKeys[] = {{"source-map", "the source's `map`"},
                                         {"target-map", "the target's `map`"},
                                         {"source-map-unit", "the source's `unit`"},
                                         {"target-map-unit", "the target's `unit`"}};

/// The result of the command in `prefix`; Tcl's spelling if it fails.
std::string by_command(Tcl_Interp* interp, Tcl_Obj* prefix, const NamedOption& option) {
  Tcl_Obj* const command = Tcl_DuplicateObj(prefix);
  Tcl_IncrRefCount(command);
  bool done = true;
  for (Tcl_Obj* const word : {to_obj(option.name), to_obj(option.value), to_obj(option.is_switch)})
    done = Tcl_ListObjAppendElement(nullptr, command, word) == TCL_OK && done;
  done = done && Tcl_EvalObjEx(interp, command, TCL_EVAL_DIRECT | TCL_EVAL_GLOBAL) == TCL_OK;
  const std::string words = done ? to_string(Tcl_GetObjResult(interp)) : spelled_option(option);
  Tcl_ResetResult(interp);
  Tcl_DecrRefCount(command);
  return words;
}

}  // namespace

std::string spelled_option(const NamedOption& option) {
  for (const EndpointKey& key : kEndpointKeys) {
    if (option.name == key.option) return key.words;
  }
  const std::string value = option.is_switch ? "1" : option.value;
  // The key of an endpoint, and `-map` of trajectories.
  if (option.name == "potential" && !value.empty()) return "map " + value;
  return "-" + option.name + (value.empty() ? "" : " " + value);
}

std::string spelled(Tcl_Interp* interp, const Message& message) {
  Tcl_Obj* const prefix = Tcl_GetVar2Ex(interp, kVariable, nullptr, TCL_GLOBAL_ONLY);
  if (prefix == nullptr || to_string(prefix).empty()) return message.spelled(spelled_option);
  return message.spelled([&](const NamedOption& option) { return by_command(interp, prefix, option); });
}

}  // namespace espdiff::vmdplugin
