// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "root_sph/profiles/root_profiles.hpp"
#include "root_sph/profiles/soil_response.hpp"

namespace rootsoil {
namespace {

TEST(RadialModulus, HasTheValuesOfEquation6) {
  const RadialModulusProfile e_r{1020.0, 15000.0, 0.5, 6.0, 0.2};
  // at x_e the sigmoid is 1/2: 1020 + 13980 (0.2 + 0.4)
  EXPECT_NEAR(e_r(0.5), 9408.0, 1e-9);
  // one 1/s_e beyond: 1/(1 + e^-1) = 0.7310585786300049
  EXPECT_NEAR(e_r(0.5 + 1.0 / 6.0), 1020.0 + 13980.0 * (0.2 + 0.8 * 0.7310585786300049), 1e-9);
  EXPECT_NEAR(e_r(20.0), 15000.0, 1e-9);
  EXPECT_NEAR(e_r(-20.0), 1020.0 + 13980.0 * 0.2, 1e-9);
}

TEST(RadialModulus, IsIsotropicWhereItsMaximumIsTheAxialModulus) {
  const RadialModulusProfile e_r{1020.0, 1020.0, 0.5, 6.0, 0.2};
  for (const double s : {0.0, 0.4, 3.0}) EXPECT_EQ(e_r(s), 1020.0);
}

// Case 2 of Table 1
constexpr SofteningProfile case_2{4e5, 0.32, 0.25, 0.1};

TEST(Softening, HasTheValuesOfEquation6) {
  // z = 0: only the constant part; z = 2: 0.55 + 0.45 2 exp(1/2 - 2)
  EXPECT_NEAR(case_2(0.32), 0.55 * 4e5, 1e-6);
  EXPECT_NEAR(case_2(0.82), 4e5 * (0.55 + 0.45 * 2.0 * 0.22313016014842982), 1e-6);
}

TEST(Softening, PeaksAtXgPlusSg) {
  EXPECT_NEAR(case_2(0.57), 4e5, 1e-6);
  for (double s = 0.0; s < 3.0; s += 0.01) EXPECT_LE(case_2(s), case_2(0.57));
  EXPECT_LT(case_2(0.56), case_2(0.57));
  EXPECT_LT(case_2(0.58), case_2(0.57));
}

TEST(Softening, TendsToHalfOfOnePlusCgFarFromTheTip) {
  EXPECT_NEAR(case_2(50.0), 0.55 * 4e5, 1e-6);
  EXPECT_NEAR((SofteningProfile{4e5, 0.32, 0.25, 0.9}(50.0)), 0.95 * 4e5, 1e-6);
}

TEST(Softening, IsClippedAtZero) {
  const SofteningProfile lambda{4e5, 0.5, 0.25, -1.0};
  for (double s = 0.0; s < 0.5; s += 0.01) EXPECT_EQ(lambda(s), 0.0);
  EXPECT_GT(lambda(0.51), 0.0);
  EXPECT_NEAR(lambda(0.75), 4e5, 1e-6);
}

TEST(Softening, FallsToZeroAcrossTheMatureCutOff) {
  SofteningProfile lambda = case_2;
  lambda.mature_at_mm = 2.0;
  lambda.mature_width_mm = 0.4;
  EXPECT_EQ(lambda(1.8), case_2(1.8));
  EXPECT_NEAR(lambda(2.0), 0.5 * case_2(2.0), 1e-9);
  // a quarter from the end: the cubic 3 t^2 - 2 t^3 at t = 1/4
  EXPECT_NEAR(lambda(2.1), 0.15625 * case_2(2.1), 1e-8);
  EXPECT_EQ(lambda(2.2), 0.0);
  EXPECT_EQ(lambda(9.0), 0.0);
  lambda.mature_width_mm = 0.0;  // a step
  EXPECT_EQ(lambda(1.999), case_2(1.999));
  EXPECT_EQ(lambda(2.0), 0.0);
}

TEST(DivisionThreshold, HasTheValuesOfEquation6) {
  const DivisionThresholdProfile l{0.01, 1.0, 45.0, 0.12};
  EXPECT_NEAR(l(0.12), 0.01, 1e-16);
  EXPECT_NEAR(l(0.62), 0.01 * (1.0 + 45.0 * 0.25), 1e-15);
  EXPECT_NEAR(l(0.0), 0.01 * (1.0 + 45.0 * 0.0144), 1e-15);
}

TEST(DivisionThreshold, StaysConstantBeyondADistance) {
  const DivisionThresholdProfile l{0.01, 1.0, 45.0, 0.12, 0.5};
  EXPECT_EQ(l(0.5), l(3.0));
  EXPECT_LT(l(0.49), l(0.5));
}

TEST(SoilResponse, InterpolatesBetweenItsTwoSets) {
  const SoilResponse response{{0.987, 0.625}, true};
  const std::array<double, 2> x_g{0.3, 0.1};
  EXPECT_EQ(response.theta(0.987), 1.0);
  EXPECT_EQ(response.theta(0.625), 0.0);
  EXPECT_NEAR(response.interpolate(x_g, 0.987), 0.3, 1e-15);
  EXPECT_NEAR(response.interpolate(x_g, 0.625), 0.1, 1e-15);
  EXPECT_NEAR(response.interpolate(x_g, 0.806), 0.2, 1e-15);
}

TEST(SoilResponse, GoesOnBeyondItsSetsOrStops) {
  SoilResponse response{{1.0, 0.5}, true};
  EXPECT_NEAR(response.theta(0.25), -0.5, 1e-15);
  EXPECT_NEAR(response.theta(1.5), 2.0, 1e-15);
  EXPECT_NEAR(response.interpolate({3.0, 1.0}, 0.25), 0.0, 1e-15);
  response.extrapolate = false;
  EXPECT_EQ(response.theta(0.25), 0.0);
  EXPECT_EQ(response.theta(1.5), 1.0);
  EXPECT_EQ(response.theta(0.75), 0.5);
  EXPECT_EQ(response.interpolate({3.0, 1.0}, 0.1), 1.0);
}

}  // namespace
}  // namespace rootsoil
