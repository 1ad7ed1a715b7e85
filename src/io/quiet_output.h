// quiet_output.h: keeps what foreign code prints away from our standard output.
#pragma once

namespace espdiff {

/// While it lives, what the process prints on standard output is lost: VMD's plugins tell there what they read.
/// Only one at a time, and none while another thread prints.
class QuietOutput {
 public:
  QuietOutput();
  ~QuietOutput();
  QuietOutput(const QuietOutput&) = delete;
  QuietOutput& operator=(const QuietOutput&) = delete;

 private:
  int kept_ = -1;  // the standard output; -1 where it is closed
};

}  // namespace espdiff
