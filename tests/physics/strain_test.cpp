// SPDX-License-Identifier: MIT
// The paper's Case 1 in small: strains at equilibrium against Eq. 8.
#include "strain.hpp"

namespace rootsoil::physics {
namespace {

const std::vector<std::string> small_2d{"root.length_mm=1", "root.radius_mm=0.05"};
const std::vector<std::string> small_3d{"scene.dimension=3", "root.length_mm=0.4", "root.radius_mm=0.03"};

TEST(Strain, IsotropicTissue2D) { expect_theoretical_strain<2>(strain_case, small_2d, 0.1, 0.7); }

TEST(Strain, BalancedTissue2D) {
  // Eq. 8 ignores compatibility where E_R varies, and the radial strain changes its sign at E_R = E_A/nu_A: errors
  // are measured against the largest radial strain in the root.
  expect_theoretical_strain<2>(strain_case + balanced, small_2d, 0.3, 0.7);
}

TEST(Strain, IsotropicTissue3D) { expect_theoretical_strain<3>(strain_case, small_3d, 0.1, 0.3); }

}  // namespace
}  // namespace rootsoil::physics
