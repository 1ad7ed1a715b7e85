// run_program.cpp: posix_spawn with files in memory for input and outputs.
#include "io/run_program.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "base/system_message.h"

extern "C" char** environ;  // NOLINT: POSIX declares no header for it

namespace espdiff {
namespace {

/// What a program may print: it is in memory.
constexpr std::size_t kMostOutput = std::size_t{64} << 20;

[[noreturn]] void cannot_start(const std::string& program, int error_number) {
  throw DeviceError(program + " cannot be started: " + system_message(error_number));
}

/// A file in memory, without a name: neither a full disk nor a missing folder for temporary files matters.
class MemoryFile {
 public:
  MemoryFile(const std::string& program, const std::string& content)
      : descriptor_(::memfd_create("espdiff", MFD_CLOEXEC)) {
    if (descriptor_ < 0) cannot_start(program, errno);
    for (std::size_t written = 0; written < content.size();) {
      const ssize_t n = ::write(descriptor_, content.data() + written, content.size() - written);
      if (n < 0) {
        const int error_number = errno;
        ::close(descriptor_);
        cannot_start(program, error_number);
      }
      written += static_cast<std::size_t>(n);
    }
    ::lseek(descriptor_, 0, SEEK_SET);
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }
  std::size_t size() const {
    struct stat status {};
    return ::fstat(descriptor_, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
  }
  std::string content() const {
    std::string text;
    std::array<char, 65536> block{};
    ::lseek(descriptor_, 0, SEEK_SET);
    for (ssize_t n = 0; (n = ::read(descriptor_, block.data(), block.size())) > 0;)
      text.append(block.data(), static_cast<std::size_t>(n));
    return text;
  }

 private:
  int descriptor_;
};

/// Starts the program as the leader of a process group of its own.
pid_t start(const ProgramCall& call, const MemoryFile& input, const MemoryFile& output, const MemoryFile& messages) {
  std::vector<char*> words;
  for (const std::string& word : call.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&files, input.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, messages.descriptor(), STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  if (!call.folder.empty()) posix_spawn_file_actions_addchdir_np(&files, call.folder.c_str());
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, words.front(), &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error == ENOENT && call.folder.empty()) throw DeviceError("there is no program '" + call.words.front() + "'");
  if (error != 0) cannot_start(call.words.front(), error);
  return pid;
}

void wait_for(pid_t pid, int& status) {
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
}

/// Waits, and kills the program's group if it may not go on.
int wait_with_checks(const ProgramCall& call, pid_t pid, const MemoryFile& output, const MemoryFile& messages) {
  const auto begun = std::chrono::steady_clock::now();
  int status = 0;
  try {
    for (auto pause = std::chrono::milliseconds(1);; pause = std::min(2 * pause, std::chrono::milliseconds(20))) {
      const pid_t ended = ::waitpid(pid, &status, WNOHANG);
      if (ended == pid) return status;
      if (ended < 0 && errno != EINTR) throw DeviceError(call.words.front() + ": " + system_message(errno));
      if (call.while_running) call.while_running();
      for (const MemoryFile* file : {&output, &messages}) {
        if (file->size() <= kMostOutput) continue;
        throw DeviceError(call.words.front() + " printed more than " + std::to_string(kMostOutput >> 20) +
                          " MB and was ended");
      }
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      if (call.time_limit_s > 0 && seconds > call.time_limit_s)
        throw DeviceError(call.words.front() + " ran for more than " +
                          std::to_string(static_cast<int>(call.time_limit_s)) + " s and was ended");
      std::this_thread::sleep_for(pause);
    }
  } catch (...) {
    ::kill(-pid, SIGKILL);
    wait_for(pid, status);
    throw;
  }
}

}  // namespace

std::string find_program(const std::string& name) {
  const auto is_program = [](const std::string& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) && access(path.c_str(), X_OK) == 0;
  };
  // The program may be started in another folder.
  const auto absolute = [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::absolute(path, ignored).string();
  };
  if (name.find('/') != std::string::npos) return is_program(name) ? absolute(name) : std::string();
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/" + name;
    if (!folder.empty() && is_program(program)) return absolute(program);
  }
  return {};
}

ProgramResult run_program(const ProgramCall& call) {
  const MemoryFile input(call.words.front(), call.input), output(call.words.front(), {}),
      messages(call.words.front(), {});
  const int status = wait_with_checks(call, start(call, input, output, messages), output, messages);
  constexpr int kSignalled = 128;
  return {WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status), output.content(),
          messages.content()};
}

}  // namespace espdiff
