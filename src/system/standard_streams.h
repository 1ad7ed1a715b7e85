// standard_streams.h: standard input, output and error: whether they are open, a terminal, or kept quiet.
#pragma once

namespace espdiff {

/// Where a standard stream is closed, the next file that is opened gets its number, and what is printed its content:
/// opens such streams to nowhere. @returns false if that fails
bool open_closed_streams();

bool is_error_stream_terminal();

/// Whether standard output is a pipe that nobody reads any more.
bool is_output_unread();

/// While it lives, what the process prints on standard output and error is lost: VMD's plugins tell there what they
/// read or could not. Only one at a time, and none while another thread prints.
class QuietOutput {
 public:
  QuietOutput();
  ~QuietOutput();
  QuietOutput(const QuietOutput&) = delete;
  QuietOutput& operator=(const QuietOutput&) = delete;

 private:
  int kept_[2] = {-1, -1};  // standard output and error; -1 where it is closed
};

}  // namespace espdiff
