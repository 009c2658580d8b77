// SPDX-License-Identifier: MIT
#include "root_sph/core/progress_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace rootsoil {
namespace {

constexpr std::chrono::seconds first_line(10);

/// A terminal of the kind "dumb" (an editor's, a build log's) shows the signs that renew a line as they are.
bool can_renew_lines() {
  const char* kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && !(kind && std::string_view(kind) == "dumb");
}

/// A line that wraps can't be overwritten: each refresh would leave one behind.
void fit_terminal(std::string& line) {
  winsize window{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 && line.size() >= window.ws_col) {
    line.resize(window.ws_col - 1u);
  }
}

}  // namespace

std::string clock_text(double seconds) {
  const auto s = std::lround(seconds);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

ProgressLine::ProgressLine(bool quiet, std::chrono::milliseconds between_lines)
    : quiet_(quiet),
      terminal_(can_renew_lines()),
      between_(terminal_ ? std::chrono::milliseconds(200) : between_lines),
      next_(std::chrono::steady_clock::now() +
            (terminal_ ? std::chrono::milliseconds(0) : std::min<std::chrono::milliseconds>(first_line, between_))) {}

bool ProgressLine::due() const { return !quiet_ && std::chrono::steady_clock::now() >= next_; }

void ProgressLine::show(std::string text) {
  if (!due()) return;
  next_ = std::chrono::steady_clock::now() + between_;
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
