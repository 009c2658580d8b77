// SPDX-License-Identifier: MIT
// A root bends like a beam: deflection of a cantilever, load at which a column buckles.
#include "bending.hpp"

namespace rootsoil::physics {
namespace {

TEST(Bending, Cantilever6Across) { EXPECT_NEAR(cantilever<2>(6).edge, 1.0, 0.12); }

TEST(Bending, Cantilever12Across) { EXPECT_NEAR(cantilever<2>(12).edge, 1.0, 0.03); }

TEST(Bending, CantileverOfIrregularCells) {
  const std::vector<std::string> irregular{"root.jitter=0.2", "root.size_variation=0.3"};
  EXPECT_NEAR(cantilever<2>(6, irregular).edge, 1.0, 0.12);
}

TEST(Bending, EulerLoad6Across) { EXPECT_NEAR(buckling_ratio<2>(6), 1.0, 0.12); }

}  // namespace
}  // namespace rootsoil::physics
