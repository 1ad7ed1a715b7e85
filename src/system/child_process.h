// child_process.h: starts another program, without a shell, and tells how it ended.
#pragma once

#include <string>
#include <vector>

#include "system/open_file.h"

namespace espdiff {

/// Who waits for a program to its end gives it these files, and a working folder if it shall have another one.
struct ChildFiles {
  const OpenFile& input;
  const OpenFile& output;
  const OpenFile& messages;
  std::string folder;
};

/// A program that was started, and what its environment and that of all its children contain and no other's: they may
/// leave its group, and outlive it.
struct ChildProcess {
  int process = 0;
  std::string mark;
};

/// Starts a program (looked up on PATH without a slash) as the leader of a process group of its own, with default
/// signals and no other files of ours. @returns 0 or the error's number
int start_child(const std::vector<std::string>& words, const ChildFiles& files, ChildProcess& child);

/// Starts a program in a session of its own, so that a key in the terminal does not end it. It reads nothing; both
/// outputs go to the file `log`. @returns 0 or the error's number
int start_detached(const std::vector<std::string>& words, const std::string& log, int& process);

enum class ChildState { kRunning, kEnded, kUnknown };

/// Does not wait. @param status of one that has ended: its exit status, or 128 + the number of the signal that ended it
ChildState child_state(int process, int& status);

/// Ends the program and all of its group at once, waits for it, and ends what it has started outside of the group,
/// unless that has emptied its environment.
void kill_child(const ChildProcess& child);

}  // namespace espdiff
