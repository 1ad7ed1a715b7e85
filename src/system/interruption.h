// interruption.h: signals that ask a run to end.
#pragma once

namespace espdiff {

/// While it lives, SIGINT, SIGTERM and SIGHUP call a function instead of ending the process, unless they were ignored
/// before: a closed terminal ends a run as Ctrl-C does, and under nohup the signal stays ignored. SIGPIPE and SIGXFSZ
/// are ignored from then on: a reader that is gone and a file at its limit of size are errors of write(). One at a
/// time.
class Interruption {
 public:
  /// @param handler may only do what a signal handler may, such as set a flag
  explicit Interruption(void (*handler)(int signal));
  ~Interruption();
  /// Whether such a signal has come to the one that lives: for what waits and has no other way to know.
  static bool is_asked();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
};

}  // namespace espdiff
