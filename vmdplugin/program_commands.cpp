// program_commands.cpp: start_program and program_state run another program. Tcl's exec is not used: it forks, which
// fails if VMD with a trajectory has reserved too much address space.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>

#include "base/error.h"
#include "base/system_message.h"
#include "commands.h"
#include "tcl_values.h"

extern "C" char** environ;  // NOLINT: POSIX declares no header for it

namespace espdiff::vmdplugin {
namespace {

/// Starts it in its own session, so that a key in VMD's terminal does not end it. Both outputs go to the file `log`.
pid_t start(const std::vector<std::string>& words, const std::string& log) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, arguments.front(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw DeviceError(words.front() + " cannot be started: " + system_message(error));
  return pid;
}

Tcl_Obj* start_program(const Call& call) {
  std::vector<std::string> words;
  for (Tcl_Obj* const word : to_vector(call.arguments[0], "program")) words.push_back(to_string(word));
  if (words.empty()) throw InputError("start_program: no program is named");
  return to_obj(static_cast<int>(start(words, call.text(1))));
}

/// "running", or the exit status (128 plus the signal's number after a signal); empty if it is unknown.
Tcl_Obj* program_state(const Call& call) {
  int status = 0;
  const pid_t ended = waitpid(to_int(call.arguments[0], "process"), &status, WNOHANG);
  if (ended == 0) return to_obj("running");
  if (ended < 0) return Tcl_NewObj();
  constexpr int kSignalled = 128;
  return to_obj(WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status));
}

}  // namespace

std::vector<Command> program_commands() {
  return {{"start_program", 2, 2, "words log", start_program}, {"program_state", 1, 1, "process", program_state}};
}

}  // namespace espdiff::vmdplugin
