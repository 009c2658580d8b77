// SPDX-License-Identifier: MIT
// A root bends like a beam: deflection of a cantilever, load at which a column buckles.
#include "bending.hpp"

namespace rootsoil::physics {
namespace {

TEST(Bending, Cantilever6Across) { expect_within_record("deflection beyond one depth", cantilever<2>(6).beam - 1.0); }

TEST(Bending, Cantilever12Across) { expect_within_record("deflection beyond one depth", cantilever<2>(12).beam - 1.0); }

TEST(Bending, CantileverOfUnequalCells) {
  expect_within_record("deflection beyond one depth", cantilever<2>(6, {"root.size_variation=0.3"}).beam - 1.0);
}

TEST(Bending, EulerLoad6Across) { expect_within_record("Euler load beyond one depth", buckling<2>(6).beam - 1.0); }

}  // namespace
}  // namespace rootsoil::physics
