// SPDX-License-Identifier: MIT
// One progress line on a terminal, a line a minute elsewhere.
#pragma once

#include <chrono>
#include <cstdint>

namespace rootsoil {

struct ProgressState {
  double time_h;
  std::int64_t cells;
  double length_mm;
  double steps_per_s;
  double inertia_error;
  double left_s;
};

class Progress {
 public:
  Progress(bool quiet, double duration_h);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { end(); }  ///< also when an error leaves the run: its message starts on a new line
  void show(const ProgressState& state);
  /// Ends the line on a terminal.
  void end();

 private:
  bool quiet_, terminal_;
  double duration_h_;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace rootsoil
