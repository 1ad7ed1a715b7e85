// child_process.cpp: posix_spawn, which does not copy our address space: that fails where a trajectory fills it.
#include "system/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>

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

  int start(const std::vector<std::string>& words, int& process, char** environment = environ) const {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, arguments.front(), &files, &attributes, arguments.data(), environment);
    process = static_cast<int>(pid);
    return error;
  }
};

constexpr char kMarkName[] = "ESPDIFF_CHILD_OF=";

/// Our environment with a mark behind those that it has from programs that started us.
std::vector<std::string> marked_environment(const std::string& mark) {
  std::string marks = kMarkName;
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const bool is_marks = std::strncmp(*entry, kMarkName, sizeof kMarkName - 1) == 0;
    (is_marks ? marks : all.emplace_back()) = *entry;
  }
  all.push_back(marks + mark);
  return all;
}

/// Ends the processes whose environment contains a mark. @returns whether there were any
bool kill_marked(const std::string& mark) {
  namespace fs = std::filesystem;
  bool any = false;
  std::error_code error;
  for (fs::directory_iterator entry("/proc", error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry->path() / "environ", std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.find(mark) == std::string::npos) continue;
    any = ::kill(static_cast<pid_t>(std::stol(name)), SIGKILL) == 0 || any;
  }
  return any;
}

}  // namespace

int start_child(const std::vector<std::string>& words, const ChildFiles& files, ChildProcess& child) {
  static std::atomic<int> n_started{0};
  child.mark = "/" + std::to_string(::getpid()) + "." + std::to_string(++n_started) + "/";
  std::vector<std::string> environment = marked_environment(child.mark);
  std::vector<char*> entries;
  for (std::string& entry : environment) entries.push_back(entry.data());
  entries.push_back(nullptr);
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
  return settings.start(words, child.process, entries.data());
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

void kill_child(const ChildProcess& child) {
  ::kill(-child.process, SIGKILL);
  int status = 0;
  while (::waitpid(child.process, &status, 0) < 0 && errno == EINTR) continue;
  // Again until none is left: one may have started another meanwhile, and a killed one takes a moment to end.
  constexpr int kMostRounds = 200;
  for (int round = 0; round < kMostRounds && kill_marked(child.mark); ++round)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace espdiff
