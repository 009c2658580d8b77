// SPDX-License-Identifier: MIT
// The scenes of the physics tests.
#pragma once

#include <string>

namespace rootsoil::physics {

/// The paper's Case 1, strains of a root that does not grow, started from rest without stress.
inline const std::string strain_case = R"(
[scene]
name = "strain"
duration_h = 8
[root]
length_mm = 2
radius_mm = 0.1
cell_size_mm = 0.01
[tissue]
E_axial_MPa = 1020
[pressure]
differential_MPa = 1
[non_affine_control]
[numerics]
start = "rest"
[output]
every_h = 8
)";

inline const std::string anisotropic = R"(
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0
s_e_per_mm = 0
c_e = 1
)";

inline const std::string balanced = R"(
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.6
s_e_per_mm = 5
c_e = 0
)";

/// Free growth, Arabidopsis-like.
inline const std::string growth_case = R"(
[scene]
name = "growth"
duration_h = 20
[root]
length_mm = 1
radius_mm = 0.06
cell_size_mm = 0.01
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.51
s_e_per_mm = 6
c_e = 0.2
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.37
c_g = -1
[non_affine_control]
[output]
every_h = 1
)";

inline const std::string division = R"(
[division]
l0_mm = 0.015
c_d = 1
s_d_per_mm2 = 5
x_d_mm = 0.12
constant_beyond_mm = 0.5
)";

/// Free growth above a tip that rests (quiescent centre and cap), as in the main job. Where the very tip grows, all
/// tissue descends within some 15 h from its first few cells, and a radius has their irregularities as its start.
inline const std::string resting_tip_case = R"(
[scene]
name = "resting_tip"
duration_h = 20
[root]
length_mm = 1
radius_mm = 0.063
cell_size_mm = 0.01
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.05
s_e_per_mm = 40
c_e = 0.2
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.34e5
x_g_mm = 0.10
s_g_mm = 0.40
c_g = -0.95
mature_at_mm = 1.2
mature_width_mm = 0.4
[division]
l0_mm = 0.015
c_d = 1
s_d_per_mm2 = 20
x_d_mm = 0.147
constant_beyond_mm = 0.66
[non_affine_control]
[output]
every_h = 1
)";

}  // namespace rootsoil::physics
