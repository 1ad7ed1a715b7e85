// interruption.cpp: signal handlers, and those that were there before.
#include "system/interruption.h"

#include <array>
#include <csignal>
#include <cstddef>

namespace espdiff {
namespace {

constexpr std::array<int, 3> kInterrupting = {SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, kInterrupting.size()> before;
volatile std::sig_atomic_t asked = 0;
void (*handler_of_run)(int signal) = nullptr;

extern "C" void note_and_pass_on(int signal) {
  asked = 1;
  handler_of_run(signal);
}

/// @param earlier receives the action that is to come back
void set_handler(int signal, void (*handler)(int), struct sigaction& earlier) {
  struct sigaction action {};
  if (sigaction(signal, nullptr, &earlier) == 0 && earlier.sa_handler == SIG_IGN) return;
  action.sa_handler = handler;  // no SA_RESTART: a call that blocks returns
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

Interruption::Interruption(void (*handler)(int signal)) {
  asked = 0;
  handler_of_run = handler;
  for (std::size_t i = 0; i < kInterrupting.size(); ++i) set_handler(kInterrupting[i], note_and_pass_on, before[i]);
  struct sigaction ignored {};
  for (const int signal : {SIGPIPE, SIGXFSZ}) set_handler(signal, SIG_IGN, ignored);
}

bool Interruption::is_asked() { return asked != 0; }

Interruption::~Interruption() {
  asked = 0;
  for (std::size_t i = 0; i < kInterrupting.size(); ++i) sigaction(kInterrupting[i], &before[i], nullptr);
}

}  // namespace espdiff
