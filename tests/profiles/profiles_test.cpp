// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/scene/response.hpp"

namespace rootsoil {
namespace {

TEST(RadialModulus, HasTheValuesOfEquation6) {
  const auto e_r = [](double s) { return radial_modulus_MPa({15000.0, 0.5, 6.0, 0.2}, 1020.0, s); };
  // at x_e the sigmoid is 1/2: 1020 + 13980 (0.2 + 0.4)
  EXPECT_NEAR(e_r(0.5), 9408.0, 1e-9);
  // one 1/s_e beyond: 1/(1 + e^-1) = 0.7310585786300049
  EXPECT_NEAR(e_r(0.5 + 1.0 / 6.0), 1020.0 + 13980.0 * (0.2 + 0.8 * 0.7310585786300049), 1e-9);
  EXPECT_NEAR(e_r(20.0), 15000.0, 1e-9);
  EXPECT_NEAR(e_r(-20.0), 1020.0 + 13980.0 * 0.2, 1e-9);
}

TEST(RadialModulus, IsIsotropicWhereItsMaximumIsTheAxialModulus) {
  const auto e_r = [](double s) { return radial_modulus_MPa({1020.0, 0.5, 6.0, 0.2}, 1020.0, s); };
  for (const double s : {0.0, 0.4, 3.0}) EXPECT_EQ(e_r(s), 1020.0);
}

// Case 2 of Table 1
const GrowthSection case_2_growth{4e5, 0.32, 0.25, 0.1, {}};
double case_2(double s_mm) { return softening_ug_mm3_h(case_2_growth, s_mm); }

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
  EXPECT_NEAR(softening_ug_mm3_h({4e5, 0.32, 0.25, 0.9, {}}, 50.0), 0.95 * 4e5, 1e-6);
}

TEST(Softening, IsClippedAtZero) {
  const auto lambda = [](double s) { return softening_ug_mm3_h({4e5, 0.5, 0.25, -1.0, {}}, s); };
  for (double s = 0.0; s < 0.5; s += 0.01) EXPECT_EQ(lambda(s), 0.0);
  EXPECT_GT(lambda(0.51), 0.0);
  EXPECT_NEAR(lambda(0.75), 4e5, 1e-6);
}

TEST(Softening, FallsToZeroAcrossTheMatureCutOff) {
  GrowthSection growth = case_2_growth;
  growth.mature_at_mm = 2.0;
  growth.mature_width_mm = 0.4;
  const auto lambda = [&](double s) { return softening_ug_mm3_h(growth, s); };
  EXPECT_EQ(lambda(1.8), case_2(1.8));
  EXPECT_NEAR(lambda(2.0), 0.5 * case_2(2.0), 1e-9);
  // a quarter from the end: the cubic 3 t^2 - 2 t^3 at t = 1/4
  EXPECT_NEAR(lambda(2.1), 0.15625 * case_2(2.1), 1e-8);
  EXPECT_EQ(lambda(2.2), 0.0);
  EXPECT_EQ(lambda(9.0), 0.0);
  growth.mature_width_mm = 0.0;  // a step
  EXPECT_EQ(lambda(1.999), case_2(1.999));
  EXPECT_EQ(lambda(2.0), 0.0);
}

TEST(DivisionThreshold, HasTheValuesOfEquation6) {
  const auto l = [](double s) {
    return division_threshold_mm({.l0_mm = 0.01, .s_d_per_mm2 = 45.0, .x_d_mm = 0.12}, s);
  };
  EXPECT_NEAR(l(0.12), 0.01, 1e-16);
  EXPECT_NEAR(l(0.62), 0.01 * (1.0 + 45.0 * 0.25), 1e-15);
  EXPECT_NEAR(l(0.0), 0.01 * (1.0 + 45.0 * 0.0144), 1e-15);
}

TEST(DivisionThreshold, StaysConstantBeyondADistance) {
  const auto l = [](double s) {
    return division_threshold_mm({.l0_mm = 0.01, .s_d_per_mm2 = 45.0, .x_d_mm = 0.12, .constant_beyond_mm = 0.5}, s);
  };
  EXPECT_EQ(l(0.5), l(3.0));
  EXPECT_LT(l(0.49), l(0.5));
}

TEST(DivisionThreshold, EndsAtADistance) {
  const DivisionSection ending{.l0_mm = 0.01, .ends_at_mm = 0.5};
  EXPECT_EQ(division_threshold_mm(ending, 0.5), 0.01);
  EXPECT_EQ(division_threshold_mm(ending, 0.5001), std::numeric_limits<double>::infinity());
}

TEST(DivisionFactor, IsOneUnlessAskedForAndACellsOwn) {
  EXPECT_EQ(division_factor({}, 1, 17), 1.0);
  const DivisionSection scattered{.scatter = 0.1};
  EXPECT_EQ(division_factor(scattered, 1, 17), division_factor(scattered, 1, 17));
  EXPECT_NE(division_factor(scattered, 1, 17), division_factor(scattered, 1, 18));
  EXPECT_NE(division_factor(scattered, 1, 17), division_factor(scattered, 2, 17));
}

/// Mean, standard deviation and correlation of a cell with the next, of the logarithm, against four standard errors.
TEST(DivisionFactor, IsSpreadAsStated) {
  constexpr int cells = 40000;
  const auto moments = [](auto&& factor) {
    double sum = 0.0, square = 0.0, with_next = 0.0;
    for (int id = 0; id < cells; ++id) {
      const double x = std::log(factor(id));
      sum += x;
      square += x * x;
      with_next += x * std::log(factor(id + 1));
    }
    const double mean = sum / cells, variance = square / cells - mean * mean;
    return std::array{mean, std::sqrt(variance), (with_next / cells - mean * mean) / variance};
  };
  const double error = 4.0 / std::sqrt(double{cells});
  const auto scattered = moments([](std::int64_t id) { return division_factor({.scatter = 0.2}, 7, id); });
  EXPECT_NEAR(scattered[0], 0.0, 0.2 * error);
  EXPECT_NEAR(scattered[1], 0.2, 0.2 * error);
  EXPECT_NEAR(scattered[2], 0.0, error);
}

TEST(Response, InterpolatesBetweenItsTwoSets) {
  const std::array<double, 2> p_MPa{0.987, 0.625}, x_g{0.3, 0.1};
  EXPECT_EQ(responded(x_g, p_MPa, 0.987, true), 0.3);
  EXPECT_EQ(responded(x_g, p_MPa, 0.625, true), 0.1);
  EXPECT_NEAR(responded(x_g, p_MPa, 0.806, true), 0.2, 1e-15);
}

TEST(Response, GoesOnBeyondItsSetsOrStops) {
  const std::array<double, 2> p_MPa{1.0, 0.5}, pair{3.0, 1.0};
  EXPECT_NEAR(responded(pair, p_MPa, 0.25, true), 0.0, 1e-15);
  EXPECT_NEAR(responded(pair, p_MPa, 1.5, true), 5.0, 1e-15);
  EXPECT_EQ(responded(pair, p_MPa, 0.1, false), 1.0);
  EXPECT_EQ(responded(pair, p_MPa, 1.5, false), 3.0);
  EXPECT_EQ(responded(pair, p_MPa, 0.75, false), 2.0);
}

TEST(Profiles, ATableOfSofteningIsLinearBetweenItsRows) {
  GrowthSection growth;
  growth.table = {{0.1, 1e5}, {0.3, 3e5}, {0.5, 0.0}};
  for (const auto& [s, lambda] :
       {std::pair{0.0, 1e5}, {0.1, 1e5}, {0.2, 2e5}, {0.45, 0.75e5}, {0.5, 0.0}, {2.0, 0.0}}) {
    EXPECT_NEAR(softening_ug_mm3_h(growth, s), lambda, 1e-8);
  }
}

}  // namespace
}  // namespace rootsoil
