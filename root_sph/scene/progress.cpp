// SPDX-License-Identifier: MIT
#include "root_sph/scene/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace rootsoil {
namespace {

std::string clock_text(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60) : fmt::format("{}:{:02}", s / 60, s % 60);
}

/// A line that wraps can't be overwritten: each refresh would leave one behind.
void fit_terminal(std::string& line) {
  winsize window{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 && line.size() >= window.ws_col) {
    line.resize(window.ws_col - 1u);
  }
}

}  // namespace

Progress::Progress(bool quiet, double duration_h)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      duration_h_(duration_h),
      next_(std::chrono::steady_clock::now() + (terminal_ ? std::chrono::seconds(0) : std::chrono::seconds(60))) {}

void Progress::show(const ProgressState& s) {
  const auto now = std::chrono::steady_clock::now();
  if (quiet_ || now < next_) return;
  next_ = now + (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(60000));
  std::string line =
      fmt::format("{:.2f}/{:g} h  {} cells  root {:.3f} mm  {:.0f} steps/s  {} left  inertia error {:.2g}", s.time_h,
                  duration_h_, s.cells, s.length_mm, s.steps_per_s, clock_text(s.left_s), s.inertia_error);
  if (terminal_) {
    fit_terminal(line);
    fmt::print(stderr, "\r{}\033[K", line);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

void Progress::end() {
  if (line_open_) fmt::print(stderr, "\n");
  line_open_ = false;
}

}  // namespace rootsoil
