// SPDX-License-Identifier: MIT
#include "root_sph/app/progress.hpp"

#include <fmt/format.h>

namespace rootsoil {

void Progress::show(const ProgressState& s) {
  if (!line_.due()) return;
  line_.show(fmt::format("{:.2f}/{:g} h  {} cells  root {:.3f} mm  {:.0f} steps/s  {} left  {} {:.2g}", s.time_h,
                         duration_h_, s.cells, s.length_mm, s.steps_per_s, clock_text(s.left_s), s.error,
                         s.error_so_far));
}

}  // namespace rootsoil
