// SPDX-License-Identifier: MIT
// Beams of many cells, and in 3D.
#include "bending.hpp"

namespace rootsoil::physics {
namespace {

TEST(BendingFine, CantileverConverges) {
  const double coarse = cantilever<2>(6).edge, middle = cantilever<2>(12).edge, fine = cantilever<2>(24).edge;
  record("order from 6 to 12, error to theory", std::log2(std::abs((coarse - 1.0) / (middle - 1.0))));
  EXPECT_NEAR(middle, 1.0, 0.03);
  EXPECT_NEAR(fine, 1.0, 0.03);
  EXPECT_LT(std::abs(fine - 1.0), std::abs(coarse - 1.0));
  // differences between resolutions shrink, whatever the position of the clamp does to the theory
  EXPECT_LT(std::abs(fine - middle), std::abs(middle - coarse));
}

TEST(BendingFine, CantileverOfIrregularCells) {
  const std::vector<std::string> irregular{"root.jitter=0.2", "root.size_variation=0.3"};
  EXPECT_NEAR(cantilever<2>(12, irregular).edge, 1.0, 0.03);
}

TEST(BendingFine, Cantilever3D8Across) { EXPECT_NEAR(cantilever<3>(8).edge, 1.0, 0.05); }

TEST(BendingFine, Cantilever3D8AcrossOfIrregularCells) {
  const std::vector<std::string> irregular{"root.jitter=0.2", "root.size_variation=0.3"};
  EXPECT_NEAR(cantilever<3>(8, irregular).edge, 1.0, 0.05);
}

TEST(BendingFine, EulerLoad12Across) {
  const double coarse = buckling_ratio<2>(6), middle = buckling_ratio<2>(12);
  EXPECT_NEAR(middle, 1.0, 0.03);
  EXPECT_LT(std::abs(middle - 1.0), std::abs(coarse - 1.0));
}

}  // namespace
}  // namespace rootsoil::physics
