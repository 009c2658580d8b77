// SPDX-License-Identifier: MIT
// Beams of many cells, and in 3D.
#include "bending.hpp"

namespace rootsoil::physics {
namespace {

const std::vector<std::string> unequal{"root.size_variation=0.3"};
const std::vector<std::string> irregular{"root.jitter=0.2", "root.size_variation=0.3"};

TEST(BendingFine, CantileverConverges) {
  const Ratio coarse = cantilever<2>(6), middle = cantilever<2>(12), fine = cantilever<2>(24);
  record("order, 6 to 12", std::log2(std::abs((coarse.beam - 1.0) / (middle.beam - 1.0))));
  record("order, 12 to 24", std::log2(std::abs((middle.beam - 1.0) / (fine.beam - 1.0))));
  record("order with the clamp, 6 to 12", std::log2(std::abs((coarse.first_layer - 1.0) / (middle.first_layer - 1.0))));
  record("order with the clamp, 12 to 24", std::log2(std::abs((middle.first_layer - 1.0) / (fine.first_layer - 1.0))));
  expect_within_record("6 across: beyond one depth", coarse.beam - 1.0);
  expect_within_record("12 across: beyond one depth", middle.beam - 1.0);
  expect_within_record("24 across: beyond one depth", fine.beam - 1.0);
  expect_within_record("12 across: at first layer", middle.first_layer - 1.0);
  expect_within_record("24 across: at first layer", fine.first_layer - 1.0);
  EXPECT_LT(std::abs(fine.beam - 1.0), std::abs(coarse.beam - 1.0));
  EXPECT_LT(std::abs(fine.first_layer - 1.0), std::abs(middle.first_layer - 1.0));
  EXPECT_LT(std::abs(middle.first_layer - 1.0), std::abs(coarse.first_layer - 1.0));
}

TEST(BendingFine, CantileverOfUnequalCellsConverges) {
  const Ratio coarse = cantilever<2>(6, unequal), middle = cantilever<2>(12, unequal),
              fine = cantilever<2>(24, unequal);
  expect_within_record("12 across: beyond one depth", middle.beam - 1.0);
  expect_within_record("24 across: beyond one depth", fine.beam - 1.0);
  EXPECT_LT(std::abs(middle.beam - 1.0), std::abs(coarse.beam - 1.0));
  EXPECT_LT(std::abs(fine.beam - 1.0), std::abs(middle.beam - 1.0));
}

// Centres off their places as well: softer still, because volumes then do not fit the room between neighbours.
TEST(BendingFine, CantileverOfIrregularCells) {
  expect_within_record("6 across: beyond one depth", cantilever<2>(6, irregular).beam - 1.0);
  expect_within_record("12 across: beyond one depth", cantilever<2>(12, irregular).beam - 1.0);
}

TEST(BendingFine, Cantilever3D8Across) {
  expect_within_record("deflection beyond one depth", cantilever<3>(8).beam - 1.0);
}

TEST(BendingFine, Cantilever3D8AcrossOfUnequalCells) {
  expect_within_record("deflection beyond one depth", cantilever<3>(8, unequal).beam - 1.0);
}

TEST(BendingFine, EulerLoad12Across) {
  const Ratio coarse = buckling<2>(6), middle = buckling<2>(12);
  expect_within_record("Euler load beyond one depth", middle.beam - 1.0);
  EXPECT_LT(std::abs(middle.beam - 1.0), std::abs(coarse.beam - 1.0));
}

}  // namespace
}  // namespace rootsoil::physics
