// SPDX-License-Identifier: MIT
// The rod's shape and the arithmetic of the penetrometer, in a soil that is a formula.
#include "soil_coupling/penetrometer.hpp"

#include "tests/soil_coupling/support.hpp"

namespace rootsoil {
namespace {

Penetrometer probe() {
  Penetrometer p;
  p.diameter_mm = 0.8;
  p.rate_mm_h = 0.5;
  p.depth_mm = 2.0;
  p.average_from_mm = 1.0;
  p.interval_h = 0.02;
  return p;
}

/// Radius of the rod's envelope at a distance behind its front.
double envelope_mm(const Rod& rod, double behind_mm) {
  double radius = 0.0;
  for (std::size_t k = 0; k < rod.radius_mm.size(); ++k) {
    const double d = behind_mm - rod.behind_mm[k], r = rod.radius_mm[k];
    if (std::abs(d) < r) radius = std::max(radius, std::sqrt(r * r - d * d));
  }
  return radius;
}

TEST(Rod, ARoundTipIsOneBall) {
  const Rod rod = make_rod(probe(), 2.0);
  EXPECT_EQ(rod.tip, 1u);
  EXPECT_DOUBLE_EQ(rod.behind_mm[0], 0.4);
  for (const double r : rod.radius_mm) EXPECT_DOUBLE_EQ(r, 0.4);
  EXPECT_GE(rod.behind_mm.back(), 2.0);
}

TEST(Rod, TheConeHasItsAngleAndIsSmooth) {
  Penetrometer p = probe();
  for (const double angle_deg : {30.0, 60.0, 120.0}) {
    p.cone_angle_deg = angle_deg;
    const Rod rod = make_rod(p, 2.0);
    const double tangent = std::tan(0.5 * angle_deg * M_PI / 180), sine = std::sin(0.5 * angle_deg * M_PI / 180);
    const double cut = 0.1 * 0.4 * (1 / sine - 1);  // by the rounded apex
    const double shoulder = rod.behind_mm[rod.tip - 1];
    // a ball that touches the cone's flank does so cos^2 of its distance from the apex: the flank ends there, at both
    // ends
    const double flank = 1 - sine * sine, last = flank * 0.4 / sine - cut, first = flank * 0.04 / sine - cut;
    for (double t = first + 0.01; t < last - 0.01; t += 0.005) {
      EXPECT_NEAR(envelope_mm(rod, t), (t + cut) * tangent, 0.01 * 0.4) << angle_deg << " at " << t;
    }
    for (double t = shoulder; t < 2.0; t += 0.01) EXPECT_NEAR(envelope_mm(rod, t), 0.4, 2e-4);
    EXPECT_NEAR(*std::min_element(rod.behind_mm.begin(), rod.behind_mm.end()), rod.radius_mm[0], 1e-12)
        << "its front is at 0";
  }
}

/// Every ball is pushed back by 0.001 N, and the first one by what the test wants.
class FormulaSoil : public SoilPort {
 public:
  explicit FormulaSoil(double tip_N) : tip_N_(tip_N) {}
  SurfaceForces advance(const SurfaceMotion& m) override {
    SurfaceForces f;
    f.mean_N.assign(m.id.size(), Vec3{-0.001, 0, 0});
    f.mean_N[0][0] = -tip_N_;
    front_mm = m.end_mm[0][0] + m.radius_mm[0];
    f.numbers = {{"soil_inertial_number", 0.01}, {"soil_overlap_max", 0.0}};
    return f;
  }
  void save(const std::filesystem::path&) override {}
  void load(const std::filesystem::path&) override {}
  static inline double front_mm = 0.0;

 private:
  double tip_N_;
};

TEST(Penetrometer, AveragesTheTipOverItsSectionAndTheSeeds) {
  for (const int dimension : {2, 3}) {
    SoilRecipe recipe = test::packed_grains();
    recipe.dimension = dimension;
    std::vector<std::int64_t> seeds;
    const SoilPortFactory factory = [&](const SoilRecipe& r, const SoilStart& start) {
      seeds.push_back(r.seed);
      EXPECT_EQ(start.root_speed_mm_h, 0.5);
      EXPECT_EQ(start.root_diameter_mm, 0.8);
      return std::make_unique<FormulaSoil>(0.1 * static_cast<double>(seeds.size()));
    };
    const PenetrometerResult result = penetrate(recipe, probe(), factory);
    const double area = dimension == 2 ? 0.8 : M_PI * 0.16;
    EXPECT_THAT(seeds, testing::ElementsAre(1, 2, 3));
    EXPECT_NEAR(result.Q_MPa, 0.2 / area, 1e-12);
    EXPECT_NEAR(result.Q_deviation_MPa, 0.1 / area, 1e-12);
    EXPECT_NEAR(result.Q_fluctuation_MPa, 0.0, 1e-12);
    EXPECT_NEAR(FormulaSoil::front_mm, recipe.box_from_mm[0] + 2.0, 1e-9) << "it stops at its depth";
    EXPECT_NEAR(result.readings.back().shaft_force_N, 0.001 * (make_rod(probe(), 2.0).radius_mm.size() - 1), 1e-12);
  }
}

TEST(Penetrometer, AnInterruptionKeepsWhatWasRead) {
  const SoilRecipe recipe = test::packed_grains();
  const SoilPortFactory factory = [](const SoilRecipe&, const SoilStart&) {
    return std::make_unique<FormulaSoil>(0.1);
  };
  int intervals = 0;
  const PenetrometerResult result = penetrate(recipe, probe(), factory, [&](const std::string&) {
    if (++intervals == 250) throw Interrupted();  // in the second seed: 200 intervals each
  });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.readings.size(), 250u);
  EXPECT_THAT(result.Q_of_seed_MPa, testing::ElementsAre(testing::DoubleNear(0.1 / 0.8, 1e-12)));
}

}  // namespace
}  // namespace rootsoil
