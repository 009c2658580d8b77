// SPDX-License-Identifier: MIT
// One progress line on a terminal; elsewhere a line after ten seconds, to show that all is well, and then one a minute.
#pragma once

#include <chrono>
#include <string>

namespace rootsoil {

/// 75 s is "1:15".
std::string clock_text(double seconds);

class ProgressLine {
 public:
  /// \param between_lines where there is no terminal
  explicit ProgressLine(bool quiet, std::chrono::milliseconds between_lines = std::chrono::minutes(1));
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { end(); }  ///< also when an error ends the task: its message starts on a new line
  bool due() const;           ///< whether show() would show anything now
  void show(std::string text);
  /// Ends the line on a terminal.
  void end();

 private:
  bool quiet_, terminal_;
  std::chrono::milliseconds between_;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace rootsoil
