// SPDX-License-Identifier: MIT
// A root that grows onto a half-space through its surface markers, against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "root_sph/effects/obstacle/obstacle.hpp"
#include "root_sph/exchange/under_relaxation.hpp"
#include "soil_coupling/twins/spring_bed.hpp"
#include "tests/soil/soil_scene.hpp"

namespace rootsoil::soil_test {
namespace {

using physics::expect_within_record;
using physics::record;

// ---- formulas -------------------------------------------------------------------------------------

TEST(PredictedForce, FollowsTheStiffnessAlongTheForceAndNeverPulls) {
  const Vec<2> force(-2.0, 0.0);
  EXPECT_LT((predicted_force<2>(force, 100.0, {0.01, 5.0}) - Vec<2>(-3.0, 0.0)).norm(), 1e-14);
  EXPECT_LT((predicted_force<2>(force, 100.0, {-0.01, 0.0}) - Vec<2>(-1.0, 0.0)).norm(), 1e-14);
  EXPECT_EQ(predicted_force<2>(force, 100.0, {-1.0, 0.0}), Vec<2>(0.0, 0.0));
  EXPECT_LT((predicted_force<2>(force, 100.0, {1.0, 0.0}) - 4.0 * force).norm(), 1e-14);
  EXPECT_EQ(predicted_force<2>(Vec<2>::Zero(), 100.0, {1.0, 0.0}), Vec<2>(0.0, 0.0));
}

TEST(UnderRelaxation, FindsTheFixedPointOfALinearSoil) {
  // residual r(F) = a - b F: from any factor, Aitken's next one is 1/b
  const double a = 2.0, b = 3.0;
  double force = 0.1, factor = 0.3, before = a - b * force;
  force += factor * before;
  const double now = a - b * force, change = now - before;
  factor = aitken_factor(factor, before * change, change * change, now * now);
  EXPECT_NEAR(factor, 1.0 / b, 1e-14);
  EXPECT_NEAR(force + factor * now, a / b, 1e-14);
}

TEST(UnderRelaxation, KeepsItsFactorWhereNothingChangedAndStaysWithinBounds) {
  EXPECT_EQ(aitken_factor(0.4, 0.0, 0.0, 1.0), 0.4);
  EXPECT_EQ(aitken_factor(0.4, 0.0, 0.0, 0.0), 0.4);
  EXPECT_EQ(aitken_factor(0.4, -1.0, 0.01, 1.0), 1.0);
  EXPECT_EQ(aitken_factor(0.4, 1.0, 0.01, 1.0), 0.1);
}

// ---- the surface ----------------------------------------------------------------------------------

/// Depth of a marker below the surface of the tissue along its outward normal, from the ellipsoids of the cells.
double depth_mm(const ParticleStore<2>& cells, const Vec<2>& marker, const Vec<2>& normal) {
  const Vec<2> along(-normal[1], normal[0]);
  double depth = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Vec<2> r = cells.position[i] - marker;
    if (r.norm() > 0.5) continue;
    const Mat<2> extent = cells.shape[i].inverse();
    if (std::abs(r.dot(along)) > std::sqrt(along.dot(extent * along))) continue;
    depth = std::max(depth, r.dot(normal) + std::sqrt(normal.dot(extent * normal)));
  }
  return depth;
}

TEST(Markers, StayCloseKnitAndAtTheirDepthThroughTwentyHoursOfGrowthAndDivision) {
  SoilRun<2> run({"numerics.step_h=0.02"}, {}, [](const Scene& s) {
    return std::make_unique<twins::HalfSpace>(plate(s, 10.0, 100.0));  // out of reach
  });
  const MarkerSize size = run.contact.surface().size();
  const auto mean_depth = [&] {
    const auto& x = run.contact.surface().positions();
    const auto normals = run.contact.surface().normals();
    double sum = 0.0;
    for (std::size_t m = 0; m < x.size(); ++m) sum += depth_mm(run.tissue.cells, x[m], normals[m]);
    return sum / static_cast<double>(x.size());
  };
  const double depth_before = mean_depth(), length_before = run.solver.axis().length_mm();
  std::set<std::int64_t> ever, now;
  double largest_gap_now = 0.0;
  std::int64_t reused = 0;
  const std::size_t cells_before = run.tissue.cells.size(), markers_before = run.contact.surface().ids().size();
  run.advance_to(20.0, [&] {
    const auto& x = run.contact.surface().positions();
    for (std::size_t m = 1; m < x.size(); ++m) largest_gap_now = std::max(largest_gap_now, (x[m] - x[m - 1]).norm());
    std::set<std::int64_t> next(run.contact.surface().ids().begin(), run.contact.surface().ids().end());
    EXPECT_EQ(next.size(), x.size());
    for (const std::int64_t id : next) reused += !now.contains(id) && ever.contains(id);
    ever.insert(next.begin(), next.end());
    now.swap(next);
  });
  record("length/length before", run.solver.axis().length_mm() / length_before);
  record("cells before", static_cast<double>(cells_before));
  record("cells", static_cast<double>(run.tissue.cells.size()));
  record("markers before", static_cast<double>(markers_before));
  record("markers", static_cast<double>(now.size()));
  record("largest gap/radius", largest_gap_now / size.radius_mm);
  record("depth/radius before", depth_before / size.radius_mm);
  EXPECT_GT(run.tissue.cells.size(), 2 * cells_before);
  EXPECT_GT(run.solver.axis().length_mm(), 3.0 * length_before);
  EXPECT_LE(largest_gap_now, size.radius_mm);
  EXPECT_EQ(reused, 0);
  expect_within_record("change of depth/radius", (mean_depth() - depth_before) / size.radius_mm);
}

TEST(Markers, ASoilOutOfReachChangesNoBitOfTheRoot) {
  physics::SceneRun<2> alone(scene_text);
  SoilRun<2> with({}, {}, [](const Scene& s) { return std::make_unique<twins::HalfSpace>(plate(s, 10.0, 100.0)); });
  alone.advance_to(0.1);
  with.advance_to(0.1);
  EXPECT_EQ(alone.tissue.cells.position.values(), with.tissue.cells.position.values());
  EXPECT_EQ(alone.tissue.cells.stress.values(), with.tissue.cells.stress.values());
  EXPECT_EQ(alone.tissue.cells.find("soil force"), nullptr);
}

TEST(Markers, OnlyThoseNearTheSoilAreShownToItAndComeBackUnderNewIds) {
  /// Keeps the motion it was shown.
  struct Listener final : SoilPort {
    explicit Listener(std::vector<SurfaceMotion>& motions) : heard(motions) {}
    SurfaceForces advance(const SurfaceMotion& motion) override {
      heard.push_back(motion);
      return {std::vector<Vec3>(motion.id.size()), std::vector<double>(motion.id.size(), 0.0), {}, {}};
    }
    void save(const std::filesystem::path&) override {}
    void load(const std::filesystem::path&) override {}
    std::vector<SurfaceMotion>& heard;
  };
  std::vector<SurfaceMotion> heard;
  double from_mm = 1.0;
  SoilContactParameters parameters;
  parameters.near_soil = [&from_mm](const Vec3& x) { return x[0] > from_mm; };
  SoilRun<2> run({}, parameters, [&heard](const Scene&) { return std::make_unique<Listener>(heard); });
  run.advance_to(0.002);
  from_mm = 1.1;
  run.advance_to(0.004);
  from_mm = 1.0;
  run.advance_to(0.006);
  ASSERT_EQ(heard.size(), 6u);
  const auto shown = [&](int k) { return std::set<std::int64_t>(heard[k].id.begin(), heard[k].id.end()); };
  for (const Vec3& x : heard[0].start_mm) EXPECT_GT(x[0], 1.0);
  for (const Vec3& x : heard[2].start_mm) EXPECT_GT(x[0], 1.1);
  EXPECT_LT(shown(2).size(), shown(0).size());
  EXPECT_EQ(shown(5).size(), shown(0).size());
  for (const std::int64_t id : shown(5)) {
    if (!shown(2).contains(id)) {
      EXPECT_FALSE(shown(0).contains(id)) << id;
    }
  }
}

// ---- thrust ---------------------------------------------------------------------------------------

/// A plane on a spring: the thrust rises slowly, and at every thrust on the way the root grows as the closed form says:
/// a straight line that reaches 0 at p (1 - nu_A) W. Friction holds the root straight: on a smooth plate it bends aside
/// from 0.8 of that thrust on.
TEST(Thrust, GrowthFallsLinearlyAndStopsAtTheClosedForm) {
  SoilRun<2> run({}, predicting(), [](const Scene& s) {
    twins::HalfSpaceParameters p = plate(s, 2.0, 0.0);
    p.backing_N_mm = 1.5;
    p.friction = 0.5;
    return std::make_unique<twins::HalfSpace>(p);
  });
  const double free_speed =
      closed_form_flow<2>(run.scene, run.scene.root.length_mm, pressure_MPa(run.scene, 0.0)).tip_speed_mm_h;
  double from_mm = run.solver.axis().length_mm(), from_h = 0.0, impulse = 0.0, worst = 0.0;
  double n = 0.0, sf = 0.0, sv = 0.0, sff = 0.0, sfv = 0.0, slowest = 1.0, fastest = 0.0;
  run.advance_to(3.0, [&] {
    impulse += run.axial_force_N() * run.tissue.step_h;
    EXPECT_NEAR(-run.contact.tip_force_N(0.5)[0], run.axial_force_N(), 1e-12 * arrest_N(run));
    EXPECT_EQ(run.contact.tip_force_N(-1.0)[0], 0.0);
    const double hours = run.tissue.time_h - from_h;
    if (hours < 0.2 - 1e-9) return;
    const double v = (run.solver.axis().length_mm() - from_mm) / hours / free_speed;
    const double f = impulse / hours / arrest_N(run);
    n += 1.0, sf += f, sv += v, sff += f * f, sfv += f * v;
    worst = std::max(worst, std::abs(v - (1.0 - f)));
    slowest = std::min(slowest, v);
    fastest = std::max(fastest, v);
    from_mm = run.solver.axis().length_mm();
    from_h = run.tissue.time_h;
    impulse = 0.0;
  });
  const double slope = (n * sfv - sf * sv) / (n * sff - sf * sf), at_rest = (sv - slope * sf) / n;
  const double work = run.contact.root_work_Nmm() / run.contact.soil_work_Nmm();
  record("speed/free speed, fastest", fastest);
  record("speed/free speed, slowest", slowest);
  EXPECT_GT(fastest, 0.85);
  EXPECT_LT(slowest, 0.15);
  expect_within_record("speed: worst deviation/free speed", worst);
  expect_within_record("line's speed at no thrust/free speed - 1", at_rest - 1.0);
  expect_within_record("line's thrust at no speed/arrest force - 1", -at_rest / slope - 1.0);
  expect_within_record("work: root/soil - 1", work - 1.0);
}

struct PlateForce {
  double peak = 0.0, mean = 0.0, noise = 0.0, settled_peak = 0.0;
};

/// Force on a fixed plate over that which arrests the root: largest, and over [0.8, 1.1] h mean and noise.
PlateForce press(physics::SceneRun<2>& run) {
  PlateForce force;
  double n = 0.0, sum = 0.0, squares = 0.0;
  run.advance_to(1.1, [&] {
    double f = 0.0;
    for (const auto& effect : run.model->effects) f -= effect->contact_force_N()[0];
    f /= arrest_N(run);
    force.peak = std::max(force.peak, f);
    if (run.tissue.time_h < 0.8) return;
    force.settled_peak = std::max(force.settled_peak, f);
    n += 1.0;
    sum += f;
    squares += f * f;
  });
  force.mean = sum / n;
  force.noise = std::sqrt(std::max(0.0, squares / n - force.mean * force.mean)) / force.mean;
  return force;
}

void expect_that_of_arrest(const std::string& on, const PlateForce& force) {
  expect_within_record(on + ": peak/arrest force - 1", force.peak - 1.0);
  expect_within_record(on + ": mean/arrest force - 1", force.mean - 1.0);
  expect_within_record(on + ": largest once settled/arrest force - 1", force.settled_peak - 1.0);
  expect_within_record(on + ": noise (rms/mean)", force.noise);
}

std::unique_ptr<SoilPort> fixed_plate(const Scene& scene, double stiffness_N_mm) {
  return std::make_unique<twins::HalfSpace>(plate(scene, stiffness_N_mm));
}

const std::string plate_ahead = R"(
[[obstacle]]
name = "plate"
shape = "plane"
position_mm = [1.21, 0.0]
normal = [-1.0, 0.0]
friction = 0.0
)";

/// The closed form is of a root all of whose section pushes. The soft cap of the tests below is pressed flat meanwhile,
/// and a root that gets shorter in front grows behind: it pushes less by the share of its growth that this takes.
TEST(Thrust, AFlatTipPushesAsTheClosedFormSays) {
  physics::SceneRun<2> obstacle(scene_text + plate_ahead, {"root.cap=false"});
  expect_that_of_arrest("obstacle", press(obstacle));
  SoilRun<2> soil({"root.cap=false"}, predicting(), [&](const Scene& s) { return fixed_plate(s, 200.0); });
  expect_that_of_arrest("soil of 200 N/mm", press(soil));
}

/// Three markers touch: 200 N/mm is as stiff as the root, E_A W/L, three times over.
TEST(Thrust, OnAFixedPlateTheForceIsSteadyAndThatOfAnObstacle) {
  physics::SceneRun<2> obstacle(scene_text + plate_ahead);
  const PlateForce by_obstacle = press(obstacle);
  expect_that_of_arrest("obstacle", by_obstacle);
  for (const double stiffness_N_mm : {50.0, 200.0, 1000.0}) {
    SoilRun<2> soil({}, predicting(), [&](const Scene& s) { return fixed_plate(s, stiffness_N_mm); });
    const PlateForce by_soil = press(soil);
    const std::string name = fmt::format("soil of {} N/mm", stiffness_N_mm);
    expect_that_of_arrest(name, by_soil);
    expect_within_record(name + ": mean less by obstacle/arrest force", by_soil.mean - by_obstacle.mean);
  }
}

/// Contacts that yield to the mean pace, as those of grains do, hold the root on a wall as well. With inertia such a
/// wall takes the predictor, or the force swings (below).
TEST(Thrust, ContactsThatYieldStopTheRootAtTheSameForce) {
  SoilContactParameters yields;
  yields.ramp_h = 0.0;
  SoilRun<2> soil({}, yields, [](const Scene& s) { return fixed_plate(s, 200.0); });
  expect_that_of_arrest("soil of 200 N/mm", press(soil));
}

/// Against the same plate with softer contacts the held force settles, and nothing is said (docs/decisions/0018).
TEST(Thrust, AHeldForcePumpsEnergyOnARigidPlateAndTheRunSaysSo) {
  SoilContactParameters no_ramp;
  no_ramp.ramp_h = 0.0;
  const auto press_until = [&](double stiffness_N_mm, double until_h, double& peak) {
    SoilRun<2> held(
        {}, no_ramp, [&](const Scene& s) { return fixed_plate(s, stiffness_N_mm); }, text_with_inertia);
    std::string notes;
    held.advance_to(until_h, [&] {
      for (const std::string& note : held.contact.take_notes()) notes += note;
      peak = std::max(peak, held.axial_force_N() / arrest_N(held));
    });
    return notes;
  };
  double stiff = 0.0, soft = 0.0;
  EXPECT_NE(press_until(100.0, 0.125, stiff).find("pumps energy"), std::string::npos);
  EXPECT_EQ(press_until(5.0, 0.25, soft), "");
  record("peak/arrest force, 100 N/mm", stiff);
  record("peak/arrest force, 5 N/mm", soft);
  EXPECT_GT(stiff, 1.5);
  EXPECT_LT(soft, 1.0);  // 0.93, and rising to 1
}

TEST(Thrust, LongerIntervalsStopAtTheSameForce) {
  SoilContactParameters parameters = predicting();
  parameters.windows_per_interval = 2;
  SoilRun<2> run({"numerics.step_h=2e-3"}, parameters, [](const Scene& s) { return fixed_plate(s, 100.0); });
  expect_that_of_arrest("soil of 100 N/mm and 4e-3 h", press(run));
}

/// The same in 3D, by a shell of markers: p (1 - 2 nu_A) times the section.
/// At this radius six cells across have the section of the circle, and the lattice is left as it is.
TEST(Thrust, In3DGrowthFallsLinearlyAndStopsAtTheClosedForm) {
  SoilContactParameters parameters;
  parameters.ramp_h = 0.0;
  SoilRun<3> run({"scene.dimension=3", "root.length_mm=0.8", "root.radius_mm=0.1276", "root.cell_size_mm=0.04",
                  "numerics.step_h=4e-3", "growth.mature_at_mm=0.6", "growth.mature_width_mm=0.1"},
                 parameters, [](const Scene& s) {
                   twins::HalfSpaceParameters p = plate(s, 0.3, 0.0);
                   p.backing_N_mm = 0.5;
                   p.friction = 0.5;
                   return std::make_unique<twins::HalfSpace>(p);
                 });
  const auto arrest = [&] {
    const double radius = physics::radius_mm<3>(run.tissue, 0.2, 0.5);
    return pressure_MPa(run.scene, 0.0) * (1.0 - 2.0 * run.scene.tissue.nu_axial) * std::numbers::pi * radius * radius;
  };
  const double free_speed =
      closed_form_flow<3>(run.scene, run.scene.root.length_mm, pressure_MPa(run.scene, 0.0)).tip_speed_mm_h;
  run.advance_to(0.3);
  double worst = 0.0, from_mm = run.solver.axis().length_mm(), from_h = run.tissue.time_h, impulse = 0.0, slowest = 1.0;
  double largest_edge = 0.0;
  run.advance_to(3.0, [&] {
    const Shell& shell = run.contact.surface();
    for (const Shell::Triangle& t : shell.triangles()) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec<3> edge = shell.positions()[static_cast<std::size_t>(t[k])] -
                            shell.positions()[static_cast<std::size_t>(t[(k + 1) % 3])];
        largest_edge = std::max(largest_edge, edge.norm() / shell.size().radius_mm);
      }
    }
    impulse += run.axial_force_N() * run.tissue.step_h;
    const double hours = run.tissue.time_h - from_h;
    if (hours < 0.3 - 1e-9) return;
    const double speed = (run.solver.axis().length_mm() - from_mm) / hours / free_speed;
    worst = std::max(worst, std::abs(speed - 1.0 + impulse / hours / arrest()));
    slowest = std::min(slowest, speed);
    from_mm = run.solver.axis().length_mm();
    from_h = run.tissue.time_h;
    impulse = 0.0;
  });
  record("cells", static_cast<double>(run.tissue.cells.size()));
  record("markers", static_cast<double>(run.contact.surface().ids().size()));
  record("free speed, mm/h", free_speed);
  record("speed/free speed, slowest", slowest);
  record("longest edge/radius", largest_edge);
  record("shortest step (h)", run.solver.shortest_step_h());
  expect_within_record("speed: worst deviation/free speed", worst);
  expect_within_record("final force/arrest force - 1", run.axial_force_N() / arrest() - 1.0);
  expect_within_record("work: root/soil - 1", run.contact.root_work_Nmm() / run.contact.soil_work_Nmm() - 1.0);
  EXPECT_LE(largest_edge, 1.0);
}

/// Springs all along the shaft: what holds the root is the sum over its surface, and every history column says so.
TEST(Springs, TheHistoryAddsUp) {
  SoilRun<2> run({}, {}, [](const Scene&) {
    return std::make_unique<twins::SpringBed>(twins::SpringBedParameters{{0.0, 0, 0}, {1, 0, 0}, 0.02, 0.02, 0.0});
  });
  run.advance_to(0.5);
  std::map<std::string, double> row;
  for (const auto& [name, value] : run.contact.history()) row[name] = value;
  Vec<2> on_markers = Vec<2>::Zero();
  double load = 0.0;
  for (std::size_t m = 0; m < run.contact.surface().ids().size(); ++m) load += run.contact.marker_force_N(m).norm();
  for (std::size_t m = 0; m < run.contact.surface().ids().size(); ++m) on_markers += run.contact.marker_force_N(m);
  record("axial force, N/mm", row.at("soil_axial_force_N"));
  EXPECT_GT(row.at("soil_axial_force_N"), 1e-3);
  // forces of the next interval are a step further than those that acted
  expect_within_record("load: history/markers - 1", row.at("soil_load_N") / load - 1.0);
  expect_within_record("axial force: cells less markers/load", (run.axial_force_N() + on_markers[0]) / load);
  expect_within_record("axial force: history less cells/load",
                       (row.at("soil_axial_force_N") - run.axial_force_N()) / load);
  EXPECT_GT(row.at("soil_tied"), 50.0);
  const double free_speed = closed_form_flow<2>(run.scene, 1.2, pressure_MPa(run.scene, 0.0)).tip_speed_mm_h;
  EXPECT_LT(row.at("soil_expected_tip_speed_mm_h"), free_speed);
  EXPECT_GT(row.at("soil_expected_tip_speed_mm_h"), 0.5 * free_speed);
}

}  // namespace
}  // namespace rootsoil::soil_test
