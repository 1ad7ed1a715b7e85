// program_commands.cpp: start_program and program_state run another program, in a private_folder. Tcl's exec is not
// used: it forks, which fails if VMD with a trajectory has reserved too much address space.
#include "base/error.h"
#include "base/text/system_message.h"
#include "commands.h"
#include "system/child_process.h"
#include "system/permissions.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

Tcl_Obj* start_program(const Call& call) {
  std::vector<std::string> words;
  for (Tcl_Obj* const word : to_vector(call.arguments[0], "program")) words.push_back(to_string(word));
  if (words.empty()) throw InputError("start_program: no program is named");
  int process = 0;
  const int error = start_detached(words, call.text(1), process);
  if (error != 0) throw DeviceError(words.front() + " cannot be started: " + system_message(error));
  return to_obj(process);
}

/// "running", or the exit status (128 plus the signal's number after a signal); empty if it is unknown.
Tcl_Obj* program_state(const Call& call) {
  int status = 0;
  const ChildState state = child_state(to_int(call.arguments[0], "process"), status);
  if (state == ChildState::kRunning) return to_obj("running");
  return state == ChildState::kUnknown ? Tcl_NewObj() : to_obj(status);
}

/// A new folder of this user alone: its path is START and six letters.
Tcl_Obj* private_folder(const Call& call) {
  const std::string path = make_private_folder(call.text(0));
  if (path.empty())
    throw IoError(call.text(0), "a temporary folder cannot be made; name one that can be written to in TMPDIR");
  return to_obj(path);
}

}  // namespace

std::vector<Command> program_commands() {
  return {{"start_program", 2, 2, "words log", start_program},
          {"program_state", 1, 1, "process", program_state},
          {"private_folder", 1, 1, "start", private_folder}};
}

}  // namespace espdiff::vmdplugin
