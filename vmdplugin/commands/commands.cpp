// commands.cpp: creates the commands, checks their arguments' number, and turns exceptions into Tcl errors.
#include "commands.h"

#include "vmdplugin/bridge/boundary.h"
#include "vmdplugin/values/option_spelling.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

constexpr const char* kNamespace = "::espdiff::core";
constexpr const char* kHandlesKey = "espdiff";

/// Belongs to its Tcl command. Owns the text that the commands' names point into.
struct Bound {
  Command command;
  std::shared_ptr<Handles> handles;
};

int wrong_arguments(Tcl_Interp* interp, const Command& command) {
  const std::string name = std::string(kNamespace) + "::" + command.name;
  const std::string arguments = *command.usage != '\0' ? std::string(" ") + command.usage : std::string();
  Tcl_SetObjResult(interp, to_obj("wrong # args: should be \"" + name + arguments + "\""));
  Tcl_SetErrorCode(interp, "TCL", "WRONGARGS", static_cast<char*>(nullptr));
  return TCL_ERROR;
}

extern "C" int run_command(ClientData client, Tcl_Interp* interp, int n_words, Tcl_Obj* const words[]) {
  const Bound& bound = *static_cast<Bound*>(client);
  const int n = n_words - 1;
  if (n < bound.command.min_arguments || n > bound.command.max_arguments) return wrong_arguments(interp, bound.command);
  return boundary(
      [&] {
        // A command may delete itself (with its interpreter) while it runs.
        const std::shared_ptr<Handles> handles = bound.handles;
        Tcl_Obj* const result = bound.command.run({interp, *handles, {words + 1, words + n_words}});
        if (result != nullptr) Tcl_SetObjResult(interp, result);
        return TCL_OK;
      },
      [&](const Failure& failure) {
        Tcl_SetObjResult(interp, to_obj(spelled(interp, failure.message)));
        Tcl_SetErrorCode(interp, "ESPDIFF", failure.error_class, static_cast<char*>(nullptr));
        return TCL_ERROR;
      });
}

extern "C" void delete_bound(ClientData client) { delete static_cast<Bound*>(client); }

extern "C" void delete_handles(ClientData client, Tcl_Interp*) {
  delete static_cast<std::shared_ptr<Handles>*>(client);
}

std::vector<Command> all_commands() {
  std::vector<Command> all;
  for (const auto& group : {compute_commands(), result_commands(), array_commands(), matrix_commands(),
                            ensemble_commands(), potential_commands(), trajectory_commands(), drawing_commands(),
                            pick_commands(), plot_commands(), program_commands(), about_commands()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace

std::string Call::text(std::size_t i) const { return to_string(arguments.at(i)); }

void create_commands(Tcl_Interp* interp) {
  auto handles = std::make_shared<Handles>();
  // Freed with the interpreter, even if the commands were deleted before.
  Tcl_SetAssocData(interp, kHandlesKey, delete_handles, new std::shared_ptr<Handles>(handles));
  for (const Command& command : all_commands()) {
    const std::string name = std::string(kNamespace) + "::" + command.name;
    Tcl_CreateObjCommand(interp, name.c_str(), run_command, new Bound{command, handles}, delete_bound);
  }
}

void delete_commands(Tcl_Interp* interp) {
  for (const Command& command : all_commands())
    Tcl_DeleteCommand(interp, (std::string(kNamespace) + "::" + command.name).c_str());
  Tcl_DeleteAssocData(interp, kHandlesKey);
}

}  // namespace espdiff::vmdplugin
