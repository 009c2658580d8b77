// SPDX-License-Identifier: MIT
// One progress line on a terminal, a line a minute elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace rootsoil {

/// 75 s is "1:15".
std::string clock_text(double seconds);

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { end(); }  ///< also when an error ends the task: its message starts on a new line
  bool due() const;           ///< whether show() would show anything now
  void show(std::string text);
  /// Ends the line on a terminal.
  void end();

 private:
  bool quiet_, terminal_;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace rootsoil
