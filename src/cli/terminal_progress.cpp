// terminal_progress.cpp: a progress bar on standard error, and cancellation by Ctrl-C.
#include "cli/terminal_progress.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace espdiff::cli {
namespace {

Progress* interruptible = nullptr;

/// Only sets a flag, which the stages check between their steps; nothing is left half written.
extern "C" void on_interrupt(int) {
  if (interruptible != nullptr) interruptible->request_cancel();
}

/// A closed terminal ends a run as Ctrl-C does; under nohup the signal is ignored, and stays so.
constexpr int kCancelling[] = {SIGINT, SIGTERM, SIGHUP};

/// @param before receives the action that is to come back
void set_handler(int signal, void (*handler)(int), struct sigaction& before) {
  struct sigaction action {};
  if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) return;
  action.sa_handler = handler;  // no SA_RESTART: a call that blocks returns
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{50};

}  // namespace

TerminalProgress::TerminalProgress()
    : is_terminal_(isatty(STDERR_FILENO) != 0),
      progress_([this](const std::string& stage, double fraction) { draw(stage, fraction); }) {
  interruptible = &progress_;
  for (const int signal : kCancelling) set_handler(signal, on_interrupt, before_[signal]);
  // A reader that is gone and a file at its limit of size are errors of write(), which are told and tidied up after.
  struct sigaction ignored {};
  for (const int signal : {SIGPIPE, SIGXFSZ}) set_handler(signal, SIG_IGN, ignored);
}

TerminalProgress::~TerminalProgress() {
  clear();
  for (const auto& [signal, action] : before_) sigaction(signal, &action, nullptr);
  interruptible = nullptr;
}

void TerminalProgress::draw(const std::string& stage, double fraction) {
  if (!is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (stage == stage_ && now - last_draw_ < kRedrawInterval) return;
  last_draw_ = now;
  stage_ = stage;
  const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kBarWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
  std::fprintf(stderr, "\r\033[K%-16s [%s] %3.0f %%", stage.c_str(), bar.c_str(), 100 * std::clamp(fraction, 0.0, 1.0));
  std::fflush(stderr);
  drawn_ = true;
}

void TerminalProgress::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace espdiff::cli
