// SPDX-License-Identifier: MIT
// What the root notices of the bodies that it meets, on its own: [response] with follows = "perceived".
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "root_sph/effects/force/force.hpp"
#include "root_sph/effects/response/response.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

ResponseSection at_once(std::optional<double> tip_length_mm = {}) {
  return {true, Follows::perceived, 0.0, tip_length_mm};
}
/// Against growth, on the last 0.02 mm.
ForceSection axial(double force_N) { return {force_N, {}, {}, {0.0, 0.02}}; }

TEST(LowPass, IsExactWhateverTheSteps) {
  double q = 0.0, time_h = 0.0;
  for (const double dt_h : {0.01, 0.4, 1e-6, 2.0, 0.03}) {
    q = low_pass(q, 0.3, dt_h, 0.7);
    time_h += dt_h;
    EXPECT_NEAR(q, 0.3 * (1.0 - std::exp(-time_h / 0.7)), 1e-16) << time_h;
  }
  EXPECT_EQ(low_pass(q, 0.3, 1e-9, 0.0), 0.3);
}

TEST(Perceived, IsBetweenNothingAndThePressure) {
  Tissue<2> tissue;
  const auto perceived = [&](double p_MPa, double thrust_MPa) {
    tissue.pressure_MPa = p_MPa;
    tissue.tip_thrust_MPa = thrust_MPa;
    return tissue.perceived_MPa();
  };
  EXPECT_EQ(perceived(0.7, 0.0), 0.7);
  EXPECT_EQ(perceived(0.7, 0.2), 0.7 - 0.2);
  EXPECT_EQ(perceived(0.7, -0.2), 0.7);  // a pull
  EXPECT_EQ(perceived(0.7, 0.8), 0.0);
  EXPECT_EQ(perceived(-0.1, 0.2), -0.1);
}

template <class Dimension>
class Perception : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;
  static constexpr double force_N = 0.01;
  Random random{1};
  Solver<Dim> solver{SolverOptions{}};
  Tissue<Dim>& tissue = solver.tissue();
  EffectList<Dim> effects;

  Perception() {
    std::array<int, Dim> counts;
    counts.fill(4);
    counts[0] = 40;
    test::fill<Dim>(tissue, test::lattice<Dim>(counts, 0.01, random));
    solver.axis().start(tissue);
  }
  double section() const { return mean_section<Dim>(tissue, solver.axis()); }
  PerceptionEffect<Dim>& perceive(const ResponseSection& response) {
    effects.push_back(std::make_unique<PerceptionEffect<Dim>>(solver, effects, response));
    return static_cast<PerceptionEffect<Dim>&>(*effects.back());
  }
  ForceEffect<Dim>& push(const ForceSection& force) {
    effects.push_back(std::make_unique<ForceEffect<Dim>>(solver, force));
    return static_cast<ForceEffect<Dim>&>(*effects.back());
  }
  /// The force takes hold, and acts; the window's end is due.
  void act() {
    for (auto& [name, pass] : solver.hooks().parameters) pass(tissue);
    for (auto& [name, pass] : solver.hooks().forces) pass(tissue, {0.0, 0.0});
    for (auto& [name, pass] : solver.hooks().perception) pass(tissue);
  }
};
TYPED_TEST_SUITE(Perception, test::BothDimensions, test::DimensionName);

TYPED_TEST(Perception, IsTheForceOnTheTipOverTheSection) {
  this->perceive(at_once());
  this->push(axial(this->force_N));
  this->act();
  EXPECT_NEAR(this->tissue.tip_thrust_MPa, this->force_N / this->section(), 1e-14);
  this->tissue.pressure_MPa = 20.0;
  EXPECT_NEAR(this->tissue.perceived_MPa(), 20.0 - this->force_N / this->section(), 1e-14);
}

TYPED_TEST(Perception, OfTwoForcesIsTheirSum) {
  this->push(axial(this->force_N));
  this->perceive(at_once());
  this->push(axial(-3.0 * this->force_N));
  this->act();
  EXPECT_NEAR(this->tissue.tip_thrust_MPa, -2.0 * this->force_N / this->section(), 1e-14);
}

/// What pushes across the root, or farther from the tip than a diameter, is not perceived.
TYPED_TEST(Perception, IsAlongTheAxisAndNearTheTip) {
  constexpr int dim = TypeParam::value;
  ForceEffect<dim>& force = this->push({{}, std::array{-0.03, 0.04, 0.0}, {}, {0.0, 0.3}});
  this->perceive(at_once(0.1));
  this->act();
  const auto& cells = this->tissue.cells;
  double volume = 0.0, near = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.distance_to_tip[i] <= 0.3) volume += cells.volume[i];
    if (cells.distance_to_tip[i] <= 0.1) near += cells.volume[i];
  }
  EXPECT_NEAR(near / volume, 1.0 / 3.0, 0.02);
  EXPECT_NEAR(force.tip_force_N(0.1)[0], -0.03 * near / volume, 1e-14);
  EXPECT_NEAR(this->tissue.tip_thrust_MPa, 0.03 * near / volume / this->section(), 1e-13);
  // by default the root's diameter
  const double diameter_mm = dim == 2 ? 0.04 : 0.04 * std::sqrt(4.0 / std::numbers::pi);
  this->perceive(at_once());
  this->act();
  EXPECT_NEAR(this->tissue.tip_thrust_MPa, -force.tip_force_N(diameter_mm)[0] / this->section(), 1e-14);
}

TYPED_TEST(Perception, IsSavedAndRestored) {
  PerceptionEffect<TypeParam::value>& perception = this->perceive(at_once());
  this->tissue.pressure_MPa = 1.0;
  this->tissue.tip_thrust_MPa = 0.3;
  NamedReals saved;
  perception.save(saved);
  this->tissue.tip_thrust_MPa = 0.0;
  perception.restore(saved);
  EXPECT_EQ(this->tissue.tip_thrust_MPa, 0.3);
  ASSERT_EQ(perception.history().size(), 1u);
  EXPECT_EQ(perception.history()[0].second, 0.7);
}

}  // namespace
}  // namespace rootsoil
