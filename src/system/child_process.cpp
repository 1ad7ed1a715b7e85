// child_process.cpp: posix_spawn, which does not copy our address space: that fails where a trajectory fills it.
#include "system/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

extern "C" char** environ;  // NOLINT: POSIX declares no header for it

namespace espdiff {
namespace {

/// What a program gets, until the end of the scope.
struct SpawnSettings {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;

  SpawnSettings() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  int start(const std::vector<std::string>& words, int& process) const {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, arguments.front(), &files, &attributes, arguments.data(), environ);
    process = static_cast<int>(pid);
    return error;
  }
};

}  // namespace

int start_child(const std::vector<std::string>& words, const ChildFiles& files, int& process) {
  SpawnSettings settings;
  posix_spawn_file_actions_adddup2(&settings.files, files.input.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&settings.files, files.output.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&settings.files, files.messages.descriptor(), STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&settings.files, STDERR_FILENO + 1);
  if (!files.folder.empty()) posix_spawn_file_actions_addchdir_np(&settings.files, files.folder.c_str());
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&settings.attributes, &none);
  posix_spawnattr_setsigdefault(&settings.attributes, &all);
  posix_spawnattr_setpgroup(&settings.attributes, 0);
  posix_spawnattr_setflags(&settings.attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  return settings.start(words, process);
}

int start_detached(const std::vector<std::string>& words, const std::string& log, int& process) {
  SpawnSettings settings;
  constexpr mode_t kForThisUser = 0600;
  posix_spawn_file_actions_addopen(&settings.files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&settings.files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   kForThisUser);
  posix_spawn_file_actions_adddup2(&settings.files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_setflags(&settings.attributes, POSIX_SPAWN_SETSID);
  return settings.start(words, process);
}

ChildState child_state(int process, int& status) {
  int ended_by = 0;
  const pid_t ended = ::waitpid(process, &ended_by, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return ChildState::kRunning;
  if (ended < 0) return ChildState::kUnknown;
  constexpr int kSignalled = 128;
  status = WIFSIGNALED(ended_by) ? kSignalled + WTERMSIG(ended_by) : WEXITSTATUS(ended_by);
  return ChildState::kEnded;
}

void kill_group(int process) {
  ::kill(-process, SIGKILL);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
}

}  // namespace espdiff
