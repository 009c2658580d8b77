// SPDX-License-Identifier: MIT
// Mature tissue that sleeps under the soil's forces: the root pushes as if it were awake, nothing is lost, and a force
// that changes wakes it.
#include <gtest/gtest.h>

#include <map>

#include "tests/soil/soil_scene.hpp"

namespace rootsoil::soil_test {
namespace {

using physics::expect_within_record;
using physics::record;

/// Its half next to the base is mature from the start.
const std::vector<std::string> long_root = {"root.length_mm=2.4", "numerics.step_h=1e-4", "numerics.window_steps=10"};

template <int Dim>
std::size_t at_rest(const SoilRun<Dim>& run) {
  return run.tissue.cells.total() - run.tissue.cells.size();
}

template <int Dim>
double number(const SoilRun<Dim>& run, const std::string& name) {
  for (const auto& effect : run.model->effects) {
    for (const auto& [column, value] : effect->history()) {
      if (column == name) return value;
    }
  }
  throw std::runtime_error("no column " + name);
}

template <int Dim>
double momentum_residual(const SoilRun<Dim>& run) {
  return relative_momentum_residual<Dim>(run.tissue, run.contact.contact_force_N());
}

/// Presses on every marker with a force that is a function of place and time.
class Presses final : public SoilPort {
 public:
  using Force = std::function<Vec3(const Vec3& position_mm, double time_h)>;
  explicit Presses(Force force_N) : force_N_(std::move(force_N)) {}
  SurfaceForces advance(const SurfaceMotion& motion) override {
    SurfaceForces forces;
    for (const Vec3& x : motion.start_mm) forces.mean_N.push_back(force_N_(x, motion.time_h));
    forces.contact_stiffness_N_mm.assign(motion.id.size(), 0.0);
    return forces;
  }
  void save(const std::filesystem::path&) override {}
  void load(const std::filesystem::path&) override {}

 private:
  Force force_N_;
};

/// A plane on a spring, as in Thrust.GrowthFallsLinearlyAndStopsAtTheClosedForm: the thrust rises from nothing to 0.7
/// of what arrests the root.
TEST(SoilSleep, ThrustAndGrowthAreThoseOfTheRootThatIsAwake) {
  std::vector<std::string> overrides = long_root;
  overrides.emplace_back("numerics.midline_damping_per_h=5");
  const auto make = [](const Scene& s) {
    twins::HalfSpaceParameters p = plate(s, 2.0, 0.0);
    p.backing_N_mm = 1.5;
    p.friction = 0.5;
    return std::make_unique<twins::HalfSpace>(p);
  };
  SoilRun<2> awake(overrides, predicting(), make, text_with_inertia),
      asleep(overrides, predicting(), make, text_with_inertia + "[sleep]\n");
  double share = 0.0, windows = 0.0, imbalance = 0.0;
  const auto watch = [&] {
    share += static_cast<double>(at_rest(asleep)) / static_cast<double>(asleep.tissue.cells.total());
    windows += 1.0;
    imbalance = std::max(imbalance, momentum_residual(asleep));
  };
  awake.advance_to(1.0);
  asleep.advance_to(1.0, watch);
  const double length_awake = awake.solver.axis().length_mm(), length_asleep = asleep.solver.axis().length_mm();
  awake.advance_to(1.5);
  asleep.advance_to(1.5, watch);
  const double speed_awake = awake.solver.axis().length_mm() - length_awake,
               speed_asleep = asleep.solver.axis().length_mm() - length_asleep;
  const double cell_mm = awake.scene.root.cell_size_mm;
  record("force/arrest force", awake.axial_force_N() / arrest_N(awake));
  record("work, root/soil, awake", awake.contact.root_work_Nmm() / awake.contact.soil_work_Nmm());
  record("share at rest, mean over time", share / windows);
  record("times woken", number(asleep, "times_woken"));
  record("largest imbalance of forces", imbalance);
  EXPECT_GT(awake.axial_force_N(), 0.5 * arrest_N(awake));
  expect_within_record("force asleep/awake - 1", asleep.axial_force_N() / awake.axial_force_N() - 1.0);
  expect_within_record("tip speed asleep/awake - 1", speed_asleep / speed_awake - 1.0);
  expect_within_record("difference of length (cells)",
                       (asleep.solver.axis().length_mm() - awake.solver.axis().length_mm()) / cell_mm);
  expect_within_record("work: root/soil - 1", asleep.contact.root_work_Nmm() / asleep.contact.soil_work_Nmm() - 1.0);
  EXPECT_GT(share / windows, 0.1);
  EXPECT_GE(number(asleep, "times_woken"), 3.0);
  EXPECT_LT(imbalance, physics::rounding_of_balance);
}

/// From 0.5 h on the force on the flanks near the base is other than before. The lower flank bears this share of it.
template <int Dim>
SoilRun<Dim> pressed(double before_N, double after_N, double lower_share, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = long_root;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return SoilRun<Dim>(
      overrides, {},
      [=](const Scene&) {
        return std::make_unique<Presses>([=](const Vec3& x, double time_h) {
          if (x[0] < 0.1 || x[0] > 0.4) return Vec3{};
          const double force_N = (time_h < 0.5 ? before_N : after_N) * (x[1] > 0.0 ? 1.0 : lower_share);
          const double radius_mm = std::hypot(x[1], x[2]);
          return Vec3{0.0, -force_N * x[1] / radius_mm, -force_N * x[2] / radius_mm};
        });
      },
      text_with_inertia + "[sleep]\n");
}

/// What acts on markers over cells at rest is part of the balance, and those markers stand where they are, with their
/// ids.
template <int Dim>
void expect_still_markers_and_balance(double force_N, double from_h, double to_h,
                                      const std::vector<std::string>& more = {}) {
  SoilRun<Dim> run = pressed<Dim>(force_N, force_N, 0.9, more);
  double imbalance = 0.0, lost = 0.0;
  run.advance_to(from_h);
  ASSERT_GT(at_rest(run), 100u);
  const auto still = [&run] {
    std::map<std::int64_t, Vec<Dim>> found;
    const auto& surface = run.contact.surface();
    for (std::size_t m = 0; m < surface.ids().size(); ++m) {
      if (surface.positions()[m][0] < 0.5) found[surface.ids()[m]] = surface.positions()[m];
    }
    return found;
  };
  const auto before = still();
  ASSERT_GT(before.size(), 40u);
  std::size_t pressed_at_rest = 0;
  run.advance_to(to_h, [&] {
    Vec<Dim> on_markers = Vec<Dim>::Zero();
    double load = 0.0;
    for (std::size_t m = 0; m < run.contact.surface().ids().size(); ++m) {
      on_markers += run.contact.marker_force_N(m);
      load += run.contact.marker_force_N(m).norm();
    }
    lost = std::max(lost, (on_markers - run.contact.contact_force_N()).norm() / load);
    imbalance = std::max(imbalance, momentum_residual(run));
    pressed_at_rest = 0;
    for (std::size_t i = run.tissue.cells.size(); i < run.tissue.cells.total(); ++i) {
      pressed_at_rest += !run.tissue.force[i].isZero(0.0);
    }
    EXPECT_GT(at_rest(run), 100u);
  });
  EXPECT_EQ(still(), before);
  EXPECT_GT(pressed_at_rest, 10u);
  record("forces lost from markers to cells/load", lost);
  record("imbalance", imbalance);
  EXPECT_LT(lost, physics::rounding_of_balance);
  EXPECT_LT(imbalance, physics::rounding_of_balance);
}

TEST(SoilSleep, MarkersOverCellsAtRestStandStillAndTheirForcesCount) {
  expect_still_markers_and_balance<2>(5e-4, 0.4, 0.6);
}

TEST(SoilSleep, In3D) {
  expect_still_markers_and_balance<3>(2e-5, 0.3, 0.35,
                                      {"scene.dimension=3", "root.cell_size_mm=0.06", "numerics.eta=1.3"});
}

/// A force that comes to tissue at rest wakes it when it is more than the tolerance; one that comes, and one that goes.
TEST(SoilSleep, AForceOnTissueAtRestWakesIt) {
  struct Case {
    double before_N, after_N;
    bool wakes;
  };
  for (const Case& c :
       {Case{0.0, 6e-3, true}, Case{6e-3, 0.0, true}, Case{0.0, 5e-4, false}, Case{6e-3, 6.5e-3, false}}) {
    SoilRun<2> run = pressed<2>(c.before_N, c.after_N, 1.0);
    run.advance_to(0.5);
    ASSERT_GT(at_rest(run), 50u) << c.before_N;
    const double woken = number(run, "times_woken");  // by the force that rose in the ramp
    run.advance_to(0.51);
    EXPECT_EQ(at_rest(run) == 0, c.wakes) << c.before_N << " to " << c.after_N;
    EXPECT_EQ(number(run, "times_woken") - woken, c.wakes ? 1.0 : 0.0) << c.before_N << " to " << c.after_N;
    std::size_t most = 0;
    run.advance_to(1.0, [&] { most = std::max(most, at_rest(run)); });
    EXPECT_GT(most, 50u);  // and it sleeps again
  }
}

/// Without [sleep] the column for it does not exist.
TEST(SoilSleep, ARootThatNeverSleepsHasNoColumnForIt) {
  const auto make = [](const Scene& s) { return std::make_unique<twins::HalfSpace>(plate(s, 10.0, 100.0)); };
  EXPECT_EQ(SoilRun<2>({}, {}, make).tissue.cells.find("soil force asleep"), nullptr);
  EXPECT_NE(SoilRun<2>({}, {}, make, text_with_inertia + "[sleep]\n").tissue.cells.find("soil force asleep"), nullptr);
}

}  // namespace
}  // namespace rootsoil::soil_test
