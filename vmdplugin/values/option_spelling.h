// option_spelling.h: how Tcl writes the options that messages name.
#pragma once

#include <tcl.h>

#include <string>

#include "base/message.h"

namespace espdiff::vmdplugin {

/// "-align none", a switch as "-overwrite 1"; of maps, which are keys of an endpoint, "the source's `map`".
std::string spelled_option(const NamedOption& option);

/// The message as Tcl writes it, or as the command does that the variable ::espdiff::option_spelling names: called with
/// name, value, and 1 for a switch, it returns the text. The window uses it to name its fields.
std::string spelled(Tcl_Interp* interp, const Message& message);

}  // namespace espdiff::vmdplugin
