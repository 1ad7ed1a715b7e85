// terminal_progress.cpp: a progress bar on standard error, and cancellation by Ctrl-C.
#include "cli/terminal_progress.h"

#include <algorithm>
#include <cstdio>

#include "system/standard_streams.h"
#include "system/this_process.h"

namespace espdiff::cli {
namespace {

Progress* interruptible = nullptr;

/// Only sets a flag, which the stages check between their steps; nothing is left half written.
extern "C" void on_interrupt(int) {
  if (interruptible != nullptr) interruptible->request_cancel();
}

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{50};

}  // namespace

TerminalProgress::TerminalProgress()
    : is_terminal_(is_error_stream_terminal()),
      progress_([this](const std::string& stage, double fraction) { draw(stage, fraction); }),
      interruption_(on_interrupt) {
  interruptible = &progress_;
}

TerminalProgress::~TerminalProgress() {
  clear();
  interruptible = nullptr;
}

void TerminalProgress::draw(const std::string& stage, double fraction) {
  const bool is_new = stage != stage_;
  stage_ = stage;
  if (!is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!is_new && now - last_draw_ < kRedrawInterval) return;
  last_draw_ = now;
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
