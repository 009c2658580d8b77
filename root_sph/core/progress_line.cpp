// SPDX-License-Identifier: MIT
#include "root_sph/core/progress_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace rootsoil {
namespace {

/// A line that wraps can't be overwritten: each refresh would leave one behind.
void fit_terminal(std::string& line) {
  winsize window{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 && line.size() >= window.ws_col) {
    line.resize(window.ws_col - 1u);
  }
}

}  // namespace

std::string clock_text(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(std::chrono::steady_clock::now() + (terminal_ ? std::chrono::seconds(0) : std::chrono::seconds(60))) {}

bool ProgressLine::due() const { return !quiet_ && std::chrono::steady_clock::now() >= next_; }

void ProgressLine::show(std::string text) {
  if (!due()) return;
  next_ = std::chrono::steady_clock::now() +
          (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(60000));
  if (terminal_) {
    fit_terminal(text);
    fmt::print(stderr, "\r{}\033[K", text);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void ProgressLine::end() {
  if (line_open_) fmt::print(stderr, "\n");
  line_open_ = false;
}

}  // namespace rootsoil
