// SPDX-License-Identifier: MIT
// The soil port with the real YADE. Every test starts it once or more (some seconds each).
#include <csignal>
#include <set>

#include "soil_coupling/penetrometer.hpp"
#include "soil_coupling/sample_cache.hpp"
#include "tests/soil_coupling/support.hpp"

namespace rootsoil {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double stone_radius_mm = 0.5, marker_radius_mm = 0.1;

class Yade : public testing::Test {
 protected:
  YadeSoil soil(const SoilRecipe& recipe, const SoilStart& start = test::start_of_root()) {
    return {recipe, start, options_};
  }

  /// A fixed stone at the origin, and a grain in a corner, far from everything.
  SoilRecipe stone() {
    SoilRecipe r = test::listed_grains({{{1.5, 1.5, 0}, 0.15}});
    r.obstacles.push_back({.name = "stone", .shape = SoilShape::stone, .radius_mm = stone_radius_mm});
    return r;
  }

  /// One marker that moves from a to b.
  SurfaceMotion move(Vec3 a, Vec3 b, double radius_mm = marker_radius_mm, std::int64_t id = 1) {
    SurfaceMotion m;
    m.interval = interval_++;
    m.duration_h = 1e-3;
    m.time_h = static_cast<double>(m.interval) * m.duration_h;
    m.id = {id};
    m.start_mm = {a};
    m.end_mm = {b};
    m.radius_mm = {radius_mm};
    return m;
  }

  /// A round rod of overlapping balls along x, tip at x, moved by dx. The port does not care that markers are large.
  SurfaceMotion push(double x, double dx) {
    SurfaceMotion m;
    m.interval = interval_++;
    m.duration_h = 2e-3;
    m.time_h = static_cast<double>(m.interval) * m.duration_h;
    for (int k = 0; k < 40; ++k) {
      const double at = x - 0.4 - 0.03 * k;
      m.id.push_back(k);
      m.start_mm.push_back({at, 0, 0});
      m.end_mm.push_back({at + dx, 0, 0});
      m.radius_mm.push_back(0.4);
    }
    return m;
  }

  test::Folder folder_;
  SoilProcessOptions options_;
  std::int64_t interval_ = 0;
};

TEST_F(Yade, ShakesHandsAndListensToNobody) {
  SoilProcess process(options_);
  EXPECT_EQ(process.engine_version(), "2023.02a");
  const std::string proc = "/proc/" + std::to_string(process.pid());
  std::set<std::string> sockets;
  for (const auto& entry : std::filesystem::directory_iterator(proc + "/fd")) {
    std::error_code gone;
    const std::string target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.starts_with("socket:[")) sockets.insert(target.substr(8, target.size() - 9));
  }
  EXPECT_EQ(sockets.size(), 1u) << "the one to this program";
  for (const char* table : {"tcp", "tcp6", "udp", "udp6"}) {
    std::ifstream file(proc + "/net/" + table);
    std::string word;
    while (file >> word) EXPECT_FALSE(sockets.contains(word)) << table << ": inode " << word;
  }
  std::ifstream environment(proc + "/environ");
  const std::string text((std::istreambuf_iterator<char>(environment)), {});
  EXPECT_THAT(text, AllOf(HasSubstr("OMP_NUM_THREADS=1"), HasSubstr("OMP_WAIT_POLICY=passive")));
}

TEST_F(Yade, MissingIsSaid) {
  setenv("ROOTSOIL_YADE_FOLDER", (folder_ / "nothing").c_str(), 1);
  const std::string text = test::message_of<SoilError>([&] { SoilProcess process(options_); });
  unsetenv("ROOTSOIL_YADE_FOLDER");
  EXPECT_THAT(text, AllOf(HasSubstr("can't be imported from"), HasSubstr("tools/setup.sh --soil")));
}

/// Validation keeps such damping out; whatever else keeps grains moving must end, too. Measured: 5 s.
TEST_F(Yade, APackingThatNeverRestsEnds) {
  SoilRecipe r = test::packed_grains();
  r.box_from_mm = {0, -0.5, 0};
  r.box_to_mm = {1, 0.5, 0};
  r.damping = 0.0;
  r.friction_deg = r.compaction_friction_deg = 0.0;
  EXPECT_THAT(test::message_of<InputError>([&] { soil(r); }),
              AllOf(HasSubstr("does not come to rest in 100000 steps"), HasSubstr("given:   damping 0,"),
                    HasSubstr("to do:   take more damping")));
}

TEST_F(Yade, AListedGrainInAnObstacleIsRefused) {
  SoilRecipe r = stone();
  r.grains.push_back({{0.6, 0, 0}, 0.15});  // a third of its radius lies in the stone
  EXPECT_EQ(soil(r).snapshot().id.size(), 2u);
  r.grains.push_back({{0, -0.55, 0}, 0.15});
  EXPECT_THAT(test::message_of<InputError>([&] { soil(r); }),
              AllOf(HasSubstr("1 of the listed grains lie in the obstacle 'stone'"), HasSubstr("(0, -0.55, 0)")));
}

TEST_F(Yade, KilledStoppedOrThrowingIsASoilError) {
  options_.patience.step_at_least_s = 2.0;
  options_.patience.long_task_s = 60.0;
  const auto after_one_interval = [&](auto spoil) {
    YadeSoil s = soil(stone());
    s.advance(move({-1, 0, 0}, {-1, 0, 0}));
    return test::message_of<SoilError>([&] { spoil(s); });
  };
  const auto signalled = [&](int signal) {
    return after_one_interval([&, signal](YadeSoil& s) {
      kill(s.process().pid(), signal);
      s.advance(move({-1, 0, 0}, {-1, 0, 0}));
    });
  };
  EXPECT_THAT(signalled(SIGKILL), HasSubstr("was killed by signal 9"));
  EXPECT_THAT(signalled(SIGSTOP), HasSubstr("(it is stopped)"));
  EXPECT_THAT(after_one_interval([&](YadeSoil& s) {
                s.advance(move({-1, 0, 0}, {NAN, 0, 0}));
              }),
              AllOf(HasSubstr("motion is not finite"), HasSubstr("--resume")));
}

/// F = 4/3 E* sqrt(R) d^1.5 with 1/E* = 2 (1 - nu^2)/E and 1/R = 1/r_marker + 1/r_grain (Hertz; Johnson, Contact
/// Mechanics, eq. 4.23); in a layer per its depth.
TEST_F(Yade, AGrainPressedOnTheRootFollowsTheLaw) {
  constexpr double grain_radius_mm = 0.15;
  for (const ContactLaw law : {ContactLaw::hertz_mindlin, ContactLaw::linear}) {
    SCOPED_TRACE(name_of(law));
    SoilRecipe r = stone();
    r.contact_law = law;
    r.density_N_h2_mm4 = 1e-6;  // light: it has come to rest when the force is read
    r.grains = {{{-0.65, 0, 0}, 0.15}};
    YadeSoil s = soil(r);
    double x = -0.65 - grain_radius_mm - marker_radius_mm - 0.001;
    s.advance(move({x, 0, 0}, {x, 0, 0}));
    for (const double step : {0.002, 0.003, 0.005}) {
      s.advance(move({x, 0, 0}, {x + step, 0, 0}));
      x += step;
      for (int rest = 0; rest < 5; ++rest) s.advance(move({x, 0, 0}, {x, 0, 0}));
      const double force_N_mm = s.advance(move({x, 0, 0}, {x, 0, 0})).mean_N[0][0];
      const double d = grain_radius_mm + marker_radius_mm - (s.snapshot().position_mm.at(0)[0] - x);
      const double R = grain_radius_mm * marker_radius_mm / (grain_radius_mm + marker_radius_mm);
      const double hertz = 4.0 / 3.0 * r.E_MPa / (2 * (1 - r.poisson * r.poisson)) * std::sqrt(R) * std::pow(d, 1.5);
      const double expected = (law == ContactLaw::linear ? 2 * r.E_MPa * R * d : hertz) / r.layer_mm();
      EXPECT_GT(d, 0.2 * step);
      EXPECT_NEAR(force_N_mm, -expected, 0.01 * expected) << "approach " << d;
    }
  }
}

/// Before it slips the tangential force is kt times the way, then mu times the normal force.
TEST_F(Yade, AMarkerSticksThenSlips) {
  SoilRecipe r = stone();
  r.root_friction_deg = 20.0;
  YadeSoil s = soil(r);
  const double d = 0.004, x = -(stone_radius_mm + marker_radius_mm - d);
  s.advance(move({x - 0.01, 0, 0}, {x - 0.01, 0, 0}));
  s.advance(move({x - 0.01, 0, 0}, {x, 0, 0}));
  const double mu = std::tan(20.0 * M_PI / 180.0);
  const double kn =
      2 * r.E_MPa * stone_radius_mm * marker_radius_mm / (stone_radius_mm + marker_radius_mm) / r.layer_mm();
  double y = 0.0;
  const auto slide = [&](double way) {
    s.advance(move({x, y, 0}, {x, y + way, 0}));
    y += way;
    const SurfaceForces held = s.advance(move({x, y, 0}, {x, y, 0}));
    EXPECT_NEAR(held.contact_stiffness_N_mm[0], kn, 1e-9 * kn);
    const Vec3 f = held.mean_N[0];
    const double length = std::hypot(x, y);  // the normal at the contact points from the stone to the marker
    const double normal = (f[0] * x + f[1] * y) / length, tangential = (f[1] * x - f[0] * y) / length;
    return std::pair(normal, tangential);
  };
  const double stick_way = mu * d / r.poisson;  // kt = poisson kn
  const auto [n1, t1] = slide(0.4 * stick_way);
  EXPECT_NEAR(n1, kn * d, 0.01 * kn * d);
  EXPECT_NEAR(t1, r.poisson * kn * 0.4 * stick_way, 0.03 * t1);
  EXPECT_LT(t1, 0.5 * mu * n1);
  slide(stick_way);
  for (int k = 0; k < 3; ++k) {
    const auto [n, t] = slide(0.2 * stick_way);
    EXPECT_NEAR(t, mu * n, 0.01 * mu * n);
  }
}

TEST_F(Yade, TheColliderSeesNewMarkersAndRadiiAtOnce) {
  YadeSoil s = soil(stone());
  const double apart = stone_radius_mm + marker_radius_mm + 0.05, touching = stone_radius_mm + marker_radius_mm - 0.002;
  s.advance(move({-apart, 0, 0}, {-apart, 0, 0}, 0.1, 7));
  SurfaceMotion two = move({-apart, 0, 0}, {-apart, 0, 0}, 0.1, 7);
  const auto add = [](SurfaceMotion& m, std::int64_t id, Vec3 at, double radius) {
    m.id.push_back(id);
    m.start_mm.push_back(at);
    m.end_mm.push_back(at);
    m.radius_mm.push_back(radius);
  };
  add(two, 8, {0, touching, 0}, 0.1);
  EXPECT_GT(s.advance(two).mean_N[1][1], 0.0) << "a new marker";
  const SurfaceForces gone = s.advance(move({-apart, 0, 0}, {-apart, 0, 0}, 0.1, 7));
  EXPECT_EQ(gone.mean_N, (std::vector<Vec3>{{0, 0, 0}}));
  SurfaceMotion again = move({-apart, 0, 0}, {-apart, 0, 0}, 0.1, 7);
  add(again, 9, {0, -touching, 0}, 0.1);
  EXPECT_LT(s.advance(again).mean_N[1][1], 0.0) << "a marker in a slot that was used before";
  EXPECT_LT(s.advance(move({-apart, 0, 0}, {-apart, 0, 0}, 0.16, 7)).mean_N[0][0], 0.0) << "a changed radius";
}

/// 1,000 markers come and go beside one that sticks: its contact must not notice, and no force may be lost.
TEST_F(Yade, MarkersComeAndGo) {
  YadeSoil s = soil(stone());
  const double x = -(stone_radius_mm + marker_radius_mm - 0.004);
  s.advance(move({x - 0.01, 0, 0}, {x - 0.01, 0, 0}));
  s.advance(move({x - 0.01, 0, 0}, {x, 0.001, 0}));  // obliquely: it holds a shear force
  const Vec3 before = s.advance(move({x, 0.001, 0}, {x, 0.001, 0})).mean_N[0];
  EXPECT_GT(std::abs(before[1]), 0.01);
  std::int64_t id = 100;
  double slots = 0.0, balance = 0.0;
  for (int k = 0; k < 20; ++k) {
    SurfaceMotion m = move({x, 0.001, 0}, {x, 0.001, 0});
    for (int j = 0; j < 50; ++j) {
      const double angle = 0.8 + 4.6 * j / 50;  // around the rest of the stone, some of them touching
      const double at = stone_radius_mm + marker_radius_mm + 0.003 * ((j + k) % 3 - 1);
      m.id.push_back(id++);
      m.start_mm.push_back({at * std::cos(angle + M_PI), at * std::sin(angle + M_PI), 0});
      m.end_mm.push_back(m.start_mm.back());
      m.radius_mm.push_back(marker_radius_mm);
    }
    m.interval = 20 * (k + 1);  // forces are balanced every 20 intervals
    const SurfaceForces f = s.advance(m);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(f.mean_N[0][a], before[a], 1e-12 * std::abs(before[0]));
    slots = f.numbers.at("soil_slots");
    balance = std::max(balance, f.numbers.at("soil_force_balance"));
    const double whole = std::abs(test::total(f.mean_N)[0] + f.numbers.at("soil_obstacle_x_N"));
    EXPECT_LT(whole, 1e-12 * std::abs(before[0]) * 50);
  }
  EXPECT_LT(balance, 1e-12);
  EXPECT_LT(slots, 80) << "ids are used again";
}

TEST_F(Yade, AFreshProcessGoesOnBitForBit) {
  SoilRecipe r = test::packed_grains();
  std::vector<SurfaceForces> went_on, resumed;
  double x = 0.5;
  {
    YadeSoil s = soil(r);
    for (int k = 0; k < 5; ++k, x += 0.001) s.advance(push(x, 0.001));
    s.save(folder_ / "checkpoint.soil");
    for (int k = 0; k < 25; ++k) went_on.push_back(s.advance(push(x + 0.001 * k, 0.001)));
  }
  interval_ = 5;
  {
    YadeSoil s = soil(r);
    s.load(folder_ / "checkpoint.soil");
    for (int k = 0; k < 25; ++k) resumed.push_back(s.advance(push(x + 0.001 * k, 0.001)));
  }
  ASSERT_GT(std::abs(test::total(went_on.back().mean_N)[0]), 0.01) << "it touches grains";
  for (std::size_t k = 0; k < went_on.size(); ++k) {
    ASSERT_EQ(went_on[k].mean_N, resumed[k].mean_N) << k;
    ASSERT_EQ(went_on[k].mean_torque_Nmm, resumed[k].mean_torque_Nmm) << k;
    for (const auto& [name, value] : went_on[k].numbers) {
      if (name.ends_with("_s")) continue;  // the clock's
      ASSERT_EQ(value, resumed[k].numbers.at(name)) << name;
    }
  }
}

TEST_F(Yade, APackedSampleIsAtRestUnderItsPressureAndKept) {
  std::vector<std::string> said;
  options_.progress = [&](const std::string& text) { said.push_back(text); };
  SoilRecipe r = test::packed_grains();
  {
    YadeSoil s = soil(r);
    EXPECT_THAT(said.front(), HasSubstr("packing"));
    EXPECT_THAT(said.back(), AllOf(HasSubstr("packed "), HasSubstr("porosity")));
    SurfaceForces f;
    for (int k = 0; k < 3; ++k) f = s.advance(push(0.3, 0.0));
    const double side_mm = r.box_to_mm[0] - r.box_from_mm[0];
    EXPECT_NEAR(f.numbers.at("soil_wall_y_to_N"), r.confining_pressure_MPa * side_mm,
                0.05 * r.confining_pressure_MPa * side_mm);
    EXPECT_LT(f.numbers.at("soil_force_balance"), 1e-12);
    EXPECT_LT(f.numbers.at("soil_unbalanced"), 0.05);
    const SoilSnapshot snapshot = s.snapshot();
    double mean_stress = 0.0, volume = 0.0;
    for (std::size_t k = 0; k < snapshot.id.size(); ++k) {
      const double area = M_PI * snapshot.radius_mm[k] * snapshot.radius_mm[k];
      mean_stress += 0.5 * (snapshot.stress_MPa[k][0] + snapshot.stress_MPa[k][1]) * area;
      volume += area;
      EXPECT_GE(snapshot.radius_mm[k], 0.9 * r.d_min_mm / 2);
      EXPECT_LE(snapshot.radius_mm[k], 1.1 * r.d_max_mm / 2);
    }
    // of the grains; over the whole box it is the pressure
    EXPECT_NEAR(mean_stress / (side_mm * 4.0), -r.confining_pressure_MPa, 0.2 * r.confining_pressure_MPa);
    EXPECT_NEAR(volume / (side_mm * 4.0), f.numbers.at("soil_solid_fraction"), 0.02);
  }
  const std::size_t said_at_first = said.size();
  const std::filesystem::path sample = ensure_sample(r, options_);
  EXPECT_EQ(said.size() - said_at_first, 0u) << "the second time nothing is packed";
  SoilRecipe other = r;
  other.root_friction_deg = 5.0;
  EXPECT_EQ(ensure_sample(other, options_), sample) << "a sample does not know the root";

  std::filesystem::resize_file(sample, std::filesystem::file_size(sample) - 10);
  EXPECT_THAT(test::message_of<InputError>([&] { soil(r); }),
              AllOf(HasSubstr("is damaged"), HasSubstr("delete the file"), HasSubstr(sample.string())));
  test::write(
      sample,
      "rootsoil soil file\n{\"kind\":\"sample\",\"version\":0,\"engine\":\"2018.02b\",\"bytes\":0,\"sha256\":\"\"}\n");
  EXPECT_THAT(test::message_of<InputError>([&] { soil(r); }),
              AllOf(HasSubstr("not a soil sample of this version"), HasSubstr("2018.02b")));
}

/// Making room for the root takes nearly all of it away; walls keep it until the root is in, and only then stand still.
TEST_F(Yade, BetweenRigidWallsGrainsBeginUnderTheConfiningPressure) {
  SoilRecipe r = test::packed_grains();
  r.walls = SoilWalls::rigid;
  YadeSoil s = soil(r);
  const SurfaceForces f = s.advance(push(0.3, 0.0));
  const double whole_N = r.confining_pressure_MPa * (r.box_to_mm[0] - r.box_from_mm[0]);
  EXPECT_NEAR(f.numbers.at("soil_wall_y_to_N"), whole_N, 0.1 * whole_N);
  EXPECT_NEAR(f.numbers.at("soil_wall_y_from_N"), -whole_N, 0.1 * whole_N);
}

TEST_F(Yade, AMovableStoneKeepsItsSizeAndPlaceInPacking) {
  SoilRecipe r = test::packed_grains();
  r.obstacles = {
      {.name = "stone", .shape = SoilShape::stone, .position_mm = {3, 0, 0}, .radius_mm = 0.5, .movable = true}};
  YadeSoil s = soil(r);
  s.advance(push(0.3, 0.0));
  const SoilSnapshot snapshot = s.snapshot();
  const auto largest = std::max_element(snapshot.radius_mm.begin(), snapshot.radius_mm.end());
  const std::size_t stone = static_cast<std::size_t>(largest - snapshot.radius_mm.begin());
  EXPECT_NEAR(*largest, 0.5, 0.005);
  EXPECT_NEAR(snapshot.position_mm[stone][0], 3.0, 0.05);
  EXPECT_NEAR(snapshot.position_mm[stone][1], 0.0, 0.05);
}

TEST_F(Yade, TheDensityMakesTheSoilQuasiStatic) {
  SoilRecipe r = test::packed_grains();
  r.inertial_number_max = 0.02;
  const SoilStart start = test::start_of_root();
  YadeSoil s = soil(r);
  s.advance(push(0.3, 0.0));
  const double dx = start.root_speed_mm_h * 2e-3;  // as fast as expected
  EXPECT_NEAR(s.advance(push(0.3, dx)).numbers.at("soil_inertial_number"), 0.02, 1e-6);
}

/// A row of markers, closer than half their radius, slides along a plate under constant approach.
TEST_F(Yade, MarkersSlideSmoothlyOnAPlate) {
  SoilRecipe r = stone();
  r.obstacles = {{.name = "plate", .shape = SoilShape::plate, .position_mm = {0, -0.5, 0}, .length_mm = 3.0}};
  YadeSoil s = soil(r);
  const int markers = 40;
  const double y = -0.5 + 0.05 + marker_radius_mm - 0.0005;
  const auto row = [&](double x, double dx, double dy) {
    SurfaceMotion m = move({0, 0, 0}, {0, 0, 0});
    m.id.clear(), m.start_mm.clear(), m.end_mm.clear(), m.radius_mm.clear();
    for (int k = 0; k < markers; ++k) {
      m.id.push_back(k);
      m.start_mm.push_back({x + 0.05 * k - 1, y - dy, 0});
      m.end_mm.push_back({x + dx + 0.05 * k - 1, y, 0});
      m.radius_mm.push_back(marker_radius_mm);
    }
    return m;
  };
  s.advance(row(0, 0, -0.002));  // from above: at the start nothing may overlap
  double x = 0.0, low = 1e9, high = 0.0, normal = 0.0;
  for (int k = 0; k < 30; ++k, x += 0.0037) {
    const Vec3 f = test::total(s.advance(row(x, 0.0037, 0)).mean_N);
    normal = f[1];
    if (k < 5) continue;  // until all of them slip
    low = std::min(low, -f[0]);
    high = std::max(high, -f[0]);
  }
  EXPECT_GT(normal, 0.1);
  EXPECT_LT(high - low, 0.01 * normal);
  EXPECT_NEAR(high, std::tan(20.0 * M_PI / 180) * normal, 0.01 * normal);
}

TEST_F(Yade, BallsInThreeDimensions) {
  SoilRecipe r = test::packed_grains();
  r.dimension = 3;
  r.box_from_mm = {0, -0.8, -0.8};
  r.box_to_mm = {1.8, 0.8, 0.8};
  r.contact_law = ContactLaw::hertz_mindlin;
  YadeSoil s = soil(r);
  SurfaceForces f;
  for (int k = 0; k < 3; ++k) f = s.advance(push(0.3 + 0.001 * k, 0.001));
  EXPECT_NEAR(f.numbers.at("soil_wall_z_to_N"), 0.1 * 1.8 * 1.6, 0.1 * 0.1 * 1.8 * 1.6);
  EXPECT_NEAR(f.numbers.at("soil_wall_y_from_N"), -0.1 * 1.8 * 1.6, 0.1 * 0.1 * 1.8 * 1.6);
  EXPECT_LT(f.numbers.at("soil_force_balance"), 1e-12);
  EXPECT_GT(f.numbers.at("soil_coordination"), 4.0);
  EXPECT_LT(test::total(f.mean_N)[0], 0.0);
}

/// One seed of a small sample at I = 0.03, where three larger ones gave 6.2 to 6.9 (docs/soil.md).
TEST_F(Yade, ThePenetrometerMeetsSeveralTimesThePressure) {
  SoilRecipe r = test::packed_grains();
  r.inertial_number_max = 0.03;
  r.E_MPa = 250.0;
  Penetrometer probe;
  probe.diameter_mm = 0.8;
  probe.rate_mm_h = 0.5;
  probe.depth_mm = 2.0;
  probe.average_from_mm = 1.0;
  probe.interval_h = 0.016;
  probe.seeds = 1;
  const SoilPortFactory factory = [&](const SoilRecipe& recipe, const SoilStart& start) {
    return std::make_unique<YadeSoil>(recipe, start, options_);
  };
  const PenetrometerResult result = penetrate(r, probe, factory);
  EXPECT_GT(result.Q_MPa / r.confining_pressure_MPa, 4.0);
  EXPECT_LT(result.Q_MPa / r.confining_pressure_MPa, 9.0);
  EXPECT_NEAR(result.inertial_number, 0.03, 1e-6);
  RecordProperty("Q_over_P", std::to_string(result.Q_MPa / r.confining_pressure_MPa));
  std::printf("Q/P = %.3f\n", result.Q_MPa / r.confining_pressure_MPa);
}

TEST_F(Yade, AnAbsurdMotionIsAnError) {
  YadeSoil s = soil(stone());
  s.advance(move({-1, 0, 0}, {-1, 0, 0}));
  interval_ = 50;  // looked at closely
  EXPECT_THAT(test::message_of<SoilError>([&] { s.advance(move({-1, 0, 0}, {-0.2, 0, 0})); }), HasSubstr("overlap by"));
}

TEST_F(Yade, ThereMustBeRoomForTheRoot) {
  YadeSoil s = soil(stone());
  EXPECT_THAT(test::message_of<InputError>([&] {
                s.advance(move({-0.4, 0, 0}, {-0.4, 0, 0}));
              }),
              HasSubstr("overlaps the obstacle 'stone'"));
}

}  // namespace
}  // namespace rootsoil
