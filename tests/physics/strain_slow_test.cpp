// SPDX-License-Identifier: MIT
// The paper's Case 1, 2 mm long, as in its Table 1.
#include "strain.hpp"

namespace rootsoil::physics {
namespace {

TEST(StrainCase1, Isotropic) { expect_theoretical_strain<2>(strain_case, {}, 0.1, 1.5); }

TEST(StrainCase1, IsotropicReference) {
  expect_theoretical_strain<2>(strain_case, {"numerics.accuracy=reference"}, 0.1, 1.5);
}

TEST(StrainCase1, Anisotropic) { expect_theoretical_strain<2>(strain_case + anisotropic, {}, 0.1, 1.5); }

TEST(StrainCase1, Balanced) { expect_theoretical_strain<2>(strain_case + balanced, {}, 0.3, 1.5); }

/// Radial strain of the balanced tissue at 6, 12 and 24 cells across: the difference shrinks when refined.
TEST(StrainCase1, BalancedConverges) {
  std::vector<std::vector<double>> radial;
  for (const char* size : {"0.016666666666666666", "0.008333333333333333", "0.004166666666666667"}) {
    SceneRun<2> run(strain_case + balanced,
                    {"root.length_mm=1", "root.radius_mm=0.05", std::string("root.cell_size_mm=") + size});
    run.advance_to(run.scene.scene.duration_h);
    std::vector<double> bins;
    for (int b = 2; b < 7; ++b) bins.push_back(measured_strain<2>(run, 0.1 * b, 0.1 * (b + 1)).radial);
    radial.push_back(bins);
  }
  double scale = 0.0, coarse = 0.0, middle = 0.0;
  for (std::size_t b = 0; b < radial[2].size(); ++b) {
    scale = std::max(scale, std::abs(radial[2][b]));
    coarse = std::max(coarse, std::abs(radial[0][b] - radial[2][b]));
    middle = std::max(middle, std::abs(radial[1][b] - radial[2][b]));
  }
  expect_within_record("6 against 24 across: share of the largest", coarse / scale);
  expect_within_record("12 against 24 across: share of the largest", middle / scale);
  record("order (differences to the finest)", std::log2(coarse / middle));
  EXPECT_LT(middle, coarse);
}

}  // namespace
}  // namespace rootsoil::physics
