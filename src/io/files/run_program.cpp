// run_program.cpp: files in memory for input and outputs, and checks while the program runs.
#include "io/files/run_program.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "base/text/system_message.h"
#include "system/child_process.h"
#include "system/open_file.h"
#include "system/permissions.h"

namespace espdiff {
namespace {

/// Limit of a program's output, which is kept in memory.
constexpr std::size_t kMostOutput = std::size_t{64} << 20;

[[noreturn]] void cannot_start(const std::string& program, int error_number) {
  throw DeviceError(program + " cannot be started: " + system_message(error_number));
}

/// A file in memory that a program reads or writes.
OpenFile memory_file(const std::string& program, const std::string& content) {
  OpenFile file = OpenFile::in_memory();
  if (!file) cannot_start(program, file.error());
  const int error = file.write(content.data(), content.size());
  if (error != 0) cannot_start(program, error);
  file.rewind();
  return file;
}

/// What the program wrote into it.
std::string content_of(const std::string& program, const OpenFile& file) {
  std::string text(static_cast<std::size_t>(file.size()), '\0');
  const int error = file.read_at(0, text.data(), text.size());
  if (error != 0) throw DeviceError(program + ": its output cannot be read: " + system_message(error));
  return text;
}

ChildProcess start(const ProgramCall& call, const ChildFiles& files) {
  ChildProcess child;
  const int error = start_child(call.words, files, child);
  if (error == ENOENT && call.folder.empty()) throw DeviceError("there is no program '" + call.words.front() + "'");
  if (error != 0) cannot_start(call.words.front(), error);
  return child;
}

/// Waits, and kills the program with its children if it may not continue.
int wait_with_checks(const ProgramCall& call, const ChildProcess& child, const ChildFiles& files) {
  const auto begun = std::chrono::steady_clock::now();
  int status = 0;
  try {
    for (auto pause = std::chrono::milliseconds(1);; pause = std::min(2 * pause, std::chrono::milliseconds(20))) {
      const ChildState state = child_state(child.process, status);
      if (state == ChildState::kEnded) return status;
      if (state == ChildState::kUnknown) throw DeviceError(call.words.front() + ": it cannot be told how it ended");
      if (call.while_running) call.while_running();
      for (const OpenFile* file : {&files.output, &files.messages}) {
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
    kill_child(child);
    throw;
  }
}

}  // namespace

std::string find_program(const std::string& name) {
  // The program may be started in another folder.
  const auto absolute = [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::absolute(path, ignored).string();
  };
  if (name.find('/') != std::string::npos) return may_run(name) ? absolute(name) : std::string();
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/" + name;
    if (!folder.empty() && may_run(program)) return absolute(program);
  }
  return {};
}

ProgramResult run_program(const ProgramCall& call) {
  const std::string& program = call.words.front();
  const OpenFile input = memory_file(program, call.input), output = memory_file(program, {}),
                 messages = memory_file(program, {});
  const ChildFiles files{input, output, messages, call.folder};
  const int status = wait_with_checks(call, start(call, files), files);
  return {status, content_of(program, output), content_of(program, messages)};
}

}  // namespace espdiff
