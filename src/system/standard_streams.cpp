// standard_streams.cpp: descriptors 0 to 2.
#include "system/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <initializer_list>

namespace espdiff {

bool open_closed_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) != descriptor) return false;
  }
  return true;
}

bool is_error_stream_terminal() { return isatty(STDERR_FILENO) != 0; }

bool is_output_unread() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

QuietOutput::QuietOutput() {
  std::fflush(stdout);
  for (int i = 0; i < 2; ++i) {
    kept_[i] = fcntl(STDOUT_FILENO + i, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    const int nowhere = kept_[i] < 0 ? -1 : open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) continue;
    dup2(nowhere, STDOUT_FILENO + i);
    close(nowhere);
  }
}

QuietOutput::~QuietOutput() {
  std::fflush(stdout);
  for (int i = 0; i < 2; ++i) {
    if (kept_[i] < 0) continue;
    dup2(kept_[i], STDOUT_FILENO + i);
    close(kept_[i]);
  }
}

}  // namespace espdiff
