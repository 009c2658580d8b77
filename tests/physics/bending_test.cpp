// SPDX-License-Identifier: MIT
// A root bends like a beam: deflection of a cantilever, load at which a column buckles.
#include "bending.hpp"

namespace rootsoil::physics {
namespace {

TEST(Bending, Cantilever6Across) { EXPECT_NEAR(cantilever<2>(6).beam, 1.0, 0.12); }

TEST(Bending, Cantilever12Across) { EXPECT_NEAR(cantilever<2>(12).beam, 1.0, 0.03); }

TEST(Bending, CantileverOfUnequalCells) {
  EXPECT_NEAR(cantilever<2>(6, {"root.size_variation=0.3"}).beam, 1.0, 0.12);
}

TEST(Bending, EulerLoad6Across) { EXPECT_NEAR(buckling<2>(6).beam, 1.0, 0.12); }

}  // namespace
}  // namespace rootsoil::physics
