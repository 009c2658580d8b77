// SPDX-License-Identifier: MIT
// A small valid scene, and ways to spoil it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/effects/table.hpp"

namespace rootsoil::testing {

inline const std::string minimal = R"([scene]
name = "small"
duration_h = 10

[root]
length_mm = 0.4
radius_mm = 0.05
cell_size_mm = 0.01

[tissue]
E_axial_MPa = 1020

[output]
every_h = 1
)";

inline const std::string anisotropy = R"(
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.51
s_e_per_mm = 6
c_e = 0.2
)";

inline const std::string pressure = "\n[pressure]\ndifferential_MPa = 1\n";

inline const std::string growth = R"(
[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.37
c_g = -1
)";

inline const std::string soil = R"(
[numerics]
stepper = "symplectic"
[soil]
box_from_mm = [0.1, -1]
box_to_mm = [2, 1]
confining_pressure_MPa = 0.05
d_range_mm = [0.08, 0.12]
E_MPa = 300
)";

inline const std::string stone = R"(
[[soil.obstacle]]
shape = "stone"
position_mm = [1, 0.3]
radius_mm = 0.2
)";

inline const std::string penetrometer = R"(
[penetrometer]
diameter_mm = 0.5
rate_mm_h = 0.5
depth_mm = 1.2
)";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the test's scene has no " + from);
  return text.replace(at, from.size(), to);
}

inline Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "a/test.toml", overrides);
}

/// What is wrong with a scene; fails the test where nothing is.
inline InputProblem problem_of(const std::string& text, const std::vector<std::string>& overrides = {},
                               const std::optional<std::string>& accuracy = std::nullopt) {
  try {
    parse_scene(text, "a/test.toml", overrides, accuracy);
  } catch (const InputError& e) {
    EXPECT_EQ(e.status(), ExitStatus::bad_input);
    return e.problem();
  }
  ADD_FAILURE() << "accepted:\n" << text;
  return {};
}

}  // namespace rootsoil::testing
