// SPDX-License-Identifier: MIT
// What a run says about how far it is.
#pragma once

#include <cstdint>
#include <string>

#include "root_sph/core/progress_line.hpp"

namespace rootsoil {

struct ProgressState {
  double time_h;
  std::int64_t cells;
  double length_mm;
  double steps_per_s;
  std::string error;  ///< which
  double error_so_far;
  double left_s;
};

class Progress {
 public:
  Progress(bool quiet, double duration_h) : line_(quiet), duration_h_(duration_h) {}
  void show(const ProgressState& state);
  void end() { line_.end(); }

 private:
  ProgressLine line_;
  double duration_h_;
};

}  // namespace rootsoil
