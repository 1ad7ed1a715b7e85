// run_program.h: runs another program to its end: without a shell, with a time limit, and cancellable.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace espdiff {

struct ProgramCall {
  std::vector<std::string> words;  ///< the program (looked up on PATH without a slash) and its arguments
  std::string input;               ///< its standard input
  std::string folder;              ///< its working folder; empty: ours
  double time_limit_s = 0;         ///< 0 for none
  /// Called about 50 times a second while the program runs. What it throws ends the program and is thrown on.
  std::function<void()> while_running;
};

struct ProgramResult {
  int status = 0;                ///< exit status; 128 + the signal's number after a signal
  std::string output, messages;  ///< its standard output and standard error
};

/// The absolute path of a program: of the name itself if it has a slash, otherwise of the first executable file of that
/// name on PATH; empty if there is none.
std::string find_program(const std::string& name);

/// Runs a program and waits for it. It gets its own process group, default signals, and none of our files. It is
/// killed with all its children, also those that have left its group, if the time is over or `while_running` throws.
/// @throws DeviceError (not found, cannot be started, longer than the time limit, more than 64 MB printed)
ProgramResult run_program(const ProgramCall& call);

}  // namespace espdiff
