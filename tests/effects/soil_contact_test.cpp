// SPDX-License-Identifier: MIT
// The pieces of soil contact, each alone: exchange, prediction, bookkeeping.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/core/vec3.hpp"
#include "root_sph/effects/soil_contact/bookkeeping.hpp"
#include "root_sph/effects/soil_contact/exchange.hpp"
#include "root_sph/effects/soil_contact/prediction.hpp"

namespace rootsoil {
namespace {

using Reals = std::vector<double>;

// ---- shared helpers -------------------------------------------------------------------------------

TEST(Components, InThePlaneTheThirdIsNothingAndComesBack) {
  EXPECT_EQ(three<2>({1.0, -2.0}), (Vec3{1.0, -2.0, 0.0}));
  EXPECT_EQ(three<3>({1.0, -2.0, 3.0}), (Vec3{1.0, -2.0, 3.0}));
  EXPECT_EQ(shortened<2>({1.0, -2.0, 9.0}), Vec<2>(1.0, -2.0));
  EXPECT_EQ(shortened<3>({1.0, -2.0, 9.0}), Vec<3>(1.0, -2.0, 9.0));
  EXPECT_EQ(flat(std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}), (Reals{1, 2, 3, 4, 5, 6}));
}

TEST(Components, ASpinInThePlaneTurnsAboutZ) {
  EXPECT_EQ(axial<2>(Spin<2>(0.5)), (Vec3{0.0, 0.0, 0.5}));
  EXPECT_EQ(spin_of<2>({7.0, 8.0, 0.5}), Spin<2>(0.5));
  EXPECT_EQ(spin_of<3>(axial<3>({1.0, 2.0, 3.0})), Spin<3>(1.0, 2.0, 3.0));
}

// ---- exchange -------------------------------------------------------------------------------------

SurfaceMotion motion_of_two() {
  SurfaceMotion motion;
  motion.time_h = 0.25;
  motion.id = {4, 7};
  motion.start_mm = motion.end_mm = {{1.0, 2.0, 0.0}, {3.0, 4.0, 0.0}};
  return motion;
}

std::string refusal(const SurfaceForces& answer) {
  try {
    checked_answer<2>(motion_of_two(), answer);
  } catch (const SoilError& error) {
    return error.what();
  }
  return "";
}

TEST(Answer, IsTakenMarkerByMarker) {
  const auto taken = checked_answer<2>(motion_of_two(), {{{1, 2, 0}, {3, 4, 0}}, {5, 6}, {{0, 0, 7}, {0, 0, 8}}, {}});
  ASSERT_EQ(taken.size(), 2u);
  EXPECT_EQ(taken[1].force_N, Vec<2>(3.0, 4.0));
  EXPECT_EQ(taken[1].torque_Nmm, Spin<2>(8.0));
  EXPECT_EQ(taken[1].stiffness_N_mm, 6.0);
  const auto no_torque = checked_answer<2>(motion_of_two(), {{{1, 2, 0}, {3, 4, 0}}, {5, 6}, {}, {}});
  EXPECT_EQ(no_torque[0].torque_Nmm, Spin<2>(0.0));
}

TEST(Answer, OfAnotherLengthOrNoNumberIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal({{{1, 2, 0}}, {5, 6}, {}, {}}).find("1 of 2 surface markers at 0.25 h"), std::string::npos);
  EXPECT_NE(refusal({{{1, 2, 0}, {3, 4, 0}}, {5}, {}, {}}), "");
  EXPECT_NE(refusal({{{1, 2, 0}, {3, 4, 0}}, {5, 6}, {{0, 0, 7}}, {}}), "");
  EXPECT_NE(refusal({{{1, 2, 0}, {3, nan, 0}}, {5, 6}, {}, {}}).find("marker 7 is not a number"), std::string::npos);
  EXPECT_NE(refusal({{{1, 2, 0}, {3, 4, 0}}, {nan, 6}, {}, {}}).find("marker 4 is not a number"), std::string::npos);
  EXPECT_NE(refusal({{{1, 2, 0}, {3, 4, 0}}, {5, 6}, {{0, 0, 7}, {0, 0, nan}}, {}}), "");
}

/// A tie of 2 N/mm to where markers began, and 0.5 N mm against any spin.
struct Tie final : SoilPort {
  SurfaceForces advance(const SurfaceMotion& motion) override {
    heard.push_back(motion);
    SurfaceForces answer;
    for (std::size_t k = 0; k < motion.id.size(); ++k) {
      const Vec<2> moved = shortened<2>(motion.end_mm[k]) - shortened<2>(motion.start_mm[k]);
      answer.mean_N.push_back(three<2>(-2.0 * moved));
      answer.contact_stiffness_N_mm.push_back(2.0);
      answer.mean_torque_Nmm.push_back({0.0, 0.0, motion.spin_per_h[k][2] > 0.0 ? -0.5 : 0.0});
    }
    answer.numbers = {{"soil_told", static_cast<double>(heard.size())}, {"soil_unknown", 1.0}};
    return answer;
  }
  std::vector<std::string> number_names() const override { return {"soil_told"}; }
  void save(const std::filesystem::path&) override {}
  void load(const std::filesystem::path&) override {}
  std::vector<SurfaceMotion> heard;
};

/// Four markers in a row, 0.1 mm apart.
Outline row_of_markers() {
  Outline outline({0.1, 0.1});
  std::map<std::string, Reals> reals;
  reals["position_mm"] = {0.0, 0.0, 0.1, 0.0, 0.2, 0.0, 0.3, 0.0};
  reals["id"] = {0, 1, 2, 3};
  reals["next_id"] = {4};
  outline.restore("", reals);
  return outline;
}

TEST(Exchange, MarkersTellHowTheyMovedOverTheIntervalAndKeepTheAnswer) {
  auto port = std::make_unique<Tie>();
  const Tie& tie = *port;
  SoilExchange<2> exchange(row_of_markers(), std::move(port), {2, false, [](const Vec3& x) { return x[0] > 0.05; }});
  EXPECT_TRUE(std::isnan(exchange.numbers().at("soil_told")));
  EXPECT_TRUE(exchange.interval_begins());
  exchange.begin_interval(1.0);
  const std::vector<MarkerMotion<2>> window(4, {Vec<2>(0.01, 0.02), Spin<2>(0.1)});
  exchange.move(window);
  EXPECT_FALSE(exchange.interval_begins());
  EXPECT_FALSE(exchange.interval_ends());
  exchange.move(window);
  ASSERT_TRUE(exchange.interval_ends());
  const Reals received = exchange.advance(1.5);
  ASSERT_EQ(tie.heard.size(), 1u);
  ASSERT_EQ(tie.heard[0].id, (std::vector<std::int64_t>{1, 2, 3}));  // the first is not near
  EXPECT_DOUBLE_EQ(tie.heard[0].duration_h, 0.5);
  EXPECT_NEAR(tie.heard[0].end_mm[0][0] - tie.heard[0].start_mm[0][0], 0.02, 1e-15);
  EXPECT_NEAR(tie.heard[0].spin_per_h[0][2], 0.4, 1e-14);
  // 2 N/mm through (0.02, 0.04) mm, and 0.5 N mm through 0.2
  ASSERT_EQ(received.size(), 3u);
  EXPECT_NEAR(received[2], 2.0 * 0.002 + 0.5 * 0.2, 1e-14);
  EXPECT_NEAR((exchange.force_N(3) - Vec<2>(-0.04, -0.08)).norm(), 0.0, 1e-15);
  EXPECT_EQ(exchange.force_N(0), Vec<2>(0.0, 0.0));
  EXPECT_EQ(exchange.numbers(), (std::map<std::string, double>{{"soil_told", 1.0}}));
  exchange.begin_interval(1.5);
  EXPECT_NEAR((exchange.forces()[3].moved_mm - Vec<2>(0.01, 0.02)).norm(), 0.0, 1e-15);  // half the interval's path
  EXPECT_EQ(exchange.forces()[3].stiffness_N_mm, 2.0);
}

/// Steps without inertia may be cut: two halves are a window.
TEST(Exchange, PartsOfWindowsMakeAWhole) {
  auto port = std::make_unique<Tie>();
  const Tie& tie = *port;
  SoilExchange<2> exchange(row_of_markers(), std::move(port), {2, false, {}});
  exchange.begin_interval(1.0);
  const std::vector<MarkerMotion<2>> part(4, {Vec<2>(0.01, 0.0), Spin<2>(0.0)});
  for (const double share : {0.5, 0.25, 0.25, 0.5}) {
    exchange.move(part, share);
    EXPECT_FALSE(exchange.interval_ends());
    EXPECT_FALSE(exchange.interval_begins());
  }
  exchange.move(part, 0.5);
  ASSERT_TRUE(exchange.interval_ends());
  exchange.advance(1.5);
  EXPECT_NEAR(tie.heard.at(0).end_mm[0][0] - tie.heard.at(0).start_mm[0][0], 0.05, 1e-15);
}

/// The mean over the latest three intervals or so; where a marker should be by now, and by the end of a part of a
/// window.
TEST(Exchange, MarkersHaveAMeanPace) {
  SoilExchange<2> exchange(row_of_markers(), std::make_unique<Tie>(), {2, false, {}});
  double pace_mm = 0.0, time_h = 0.0;
  for (int interval = 0; interval < 30; ++interval) {
    const double path_mm = interval % 3 == 0 ? 0.04 : 0.01;
    pace_mm += (path_mm - pace_mm) / std::min(interval + 1, 3);
    exchange.begin_interval(time_h);
    for (int k = 0; k < 2; ++k) {
      exchange.move(std::vector<MarkerMotion<2>>(4, {Vec<2>(0.5 * path_mm, 0.0), Spin<2>(0.0)}));
    }
    exchange.advance(time_h += 0.1);
  }
  exchange.begin_interval(time_h);
  exchange.move(std::vector<MarkerMotion<2>>(4, {Vec<2>(0.007, 0.0), Spin<2>(0.0)}));
  const MarkerForce<2> force = exchange.forces()[2];
  EXPECT_NEAR(force.moved_mm[0], 0.5 * 0.01 + 0.007, 1e-14);
  EXPECT_NEAR(force.expected_mm[0], (0.5 + 0.5) * pace_mm, 1e-14);
  EXPECT_NEAR(force.pace_mm[0], 0.5 * pace_mm, 1e-14);
}

TEST(Exchange, SavedAndRestoredInsideAnIntervalItGoesOnAlike) {
  const auto window = [](double times) {
    return std::vector<MarkerMotion<2>>(4, {times * Vec<2>(0.01, 0.02), Spin<2>(0.1)});
  };
  SoilExchange<2> whole(row_of_markers(), std::make_unique<Tie>(), {2, true, {}});
  for (const double times : {1.0, 1.5, 1.2}) {  // Aitken's factor needs three to leave 1
    whole.begin_interval(times);
    for (int k = 0; k < 2; ++k) whole.move(window(times));
    whole.advance(times + 0.5);
  }
  whole.begin_interval(2.0);
  whole.move(window(0.7));
  std::map<std::string, Reals> saved;
  whole.save(saved);
  EXPECT_LT(saved.at("soil/interval").at(3), 0.99);
  auto port = std::make_unique<Tie>();
  const Tie& tie = *port;
  SoilExchange<2> taken_up(row_of_markers(), std::move(port), {2, true, {}});
  taken_up.restore(saved);
  std::map<std::string, Reals> after[2];
  int which = 0;
  for (SoilExchange<2>* exchange : {&whole, &taken_up}) {
    EXPECT_FALSE(exchange->interval_begins());
    exchange->move(window(0.4));
    ASSERT_TRUE(exchange->interval_ends());
    exchange->advance(2.5);
    exchange->begin_interval(2.5);
    exchange->save(after[which]);
    after[which++].erase("soil/numbers");  // the second soil counts anew
  }
  EXPECT_EQ(after[0], after[1]);
  EXPECT_EQ(tie.heard.at(0).interval, 3);
  EXPECT_EQ(tie.heard.at(0).time_h, 2.0);
}

// ---- prediction -----------------------------------------------------------------------------------

TEST(Ramp, RisesFromNothingToAll) {
  EXPECT_EQ(ramp(-0.1, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(ramp(0.05, 0.2), 0.25);
  EXPECT_EQ(ramp(0.3, 0.2), 1.0);
  EXPECT_EQ(ramp(0.0, 0.0), 1.0);
}

/// 6 x 6 round cells 0.1 mm apart and two markers among them.
struct Block {
  std::vector<Vec<2>> cells;
  std::vector<Mat<2>> shapes;
  std::vector<Vec<2>> markers{{0.23, 0.31}, {0.27, 0.18}};
  Block() {
    for (int i = 0; i < 36; ++i) {
      cells.emplace_back(0.1 * (i % 6), 0.1 * (i / 6));
      shapes.push_back(Mat<2>::Identity() * 4.0 / 0.01);
    }
  }
  WindowForces<2> forces(double share, std::vector<MarkerForce<2>> measured) const {
    return {SurfaceMapping<2>(markers, cells, shapes, 1.4), std::move(measured), share, cells};
  }
};

TEST(WindowForces, TheShareOfForceAndTorqueReachesTheCells) {
  const Block block;
  const WindowForces<2> window =
      block.forces(0.5, {{Vec<2>(2.0, -1.0), Spin<2>(0.02), 0.0, Vec<2>::Zero()}, MarkerForce<2>{}});
  std::vector<Vec<2>> force(36, Vec<2>(9.0, 9.0));
  const std::vector<std::size_t> loaded = window.spread(force);
  EXPECT_TRUE(std::is_sorted(loaded.begin(), loaded.end()));
  Vec<2> sum = Vec<2>::Zero();
  double torque = 0.0;
  for (std::size_t i = 0; i < 36; ++i) {
    sum += force[i];
    torque += cross<2>(block.cells[i], force[i])[0];
    EXPECT_EQ(std::binary_search(loaded.begin(), loaded.end(), i), !force[i].isZero(0.0)) << i;
  }
  EXPECT_LT((sum - Vec<2>(1.0, -0.5)).norm(), 1e-14);
  EXPECT_NEAR(torque, cross<2>(block.markers[0], Vec<2>(1.0, -0.5))[0] + 0.01, 1e-14);
}

/// The row sum bounds the stiffness that cells feel: each row of |phi_i| k |phi_j| holds, and its total is k (sum
/// |phi|)^2.
TEST(WindowForces, ContactStiffnessIsARowSum) {
  Block block;
  block.markers[1] = {-0.08, 0.18};  // outside, where some weights are negative
  const WindowForces<2> window =
      block.forces(0.5, {MarkerForce<2>{}, {Vec<2>::Zero(), Spin<2>::Zero(), 80.0, Vec<2>::Zero()}});
  double total = 0.0, magnitudes = 0.0;
  for (const auto& [i, k] : window.stiffness()) total += k;
  for (const auto& s : window.mapping().shares(1)) magnitudes += std::abs(s.weight);
  EXPECT_GT(magnitudes, 1.01);
  EXPECT_NEAR(total, 0.5 * 80.0 * magnitudes * magnitudes, 1e-12);
  EXPECT_TRUE(block.forces(1.0, std::vector<MarkerForce<2>>(2)).stiffness().empty());
}

TEST(WindowForces, HeldForcesDoTheirWorkThroughTheWholeMotion) {
  const Block block;
  const WindowForces<2> window =
      block.forces(0.5, {{Vec<2>(2.0, -1.0), Spin<2>(0.02), 10.0, Vec<2>::Zero()}, MarkerForce<2>{}});
  std::vector<Vec<2>> moved = block.cells;
  for (Vec<2>& x : moved) x += Vec<2>(0.01, 0.0) + turned<2>(Spin<2>(0.1), x);
  const auto motion = window.motion(moved, moved.size());
  const Vec<2> way = Vec<2>(0.01, 0.0) + turned<2>(Spin<2>(0.1), block.markers[0]);
  EXPECT_LT((motion[0].moved_mm - way).norm(), 1e-14);
  EXPECT_NEAR(motion[0].turned[0], 0.1, 1e-13);
  EXPECT_NEAR(window.work_Nmm(motion)[0], -(Vec<2>(1.0, -0.5).dot(way) + 0.01 * 0.1), 1e-14);
  // cells at rest do not carry it
  EXPECT_EQ(window.motion(moved, 0)[0].moved_mm, Vec<2>(0.0, 0.0));
}

TEST(WindowForces, FollowedForcesGrowWithTheWaySinceTheyWereMeasured) {
  const Block block;
  WindowForces<2> window =
      block.forces(0.5, {{Vec<2>(-2.0, 0.0), Spin<2>(0.0), 100.0, Vec<2>(0.01, 0.0)}, MarkerForce<2>{}});
  EXPECT_EQ(window.applied_N()[0], Vec<2>(-1.0, 0.0));
  std::vector<Vec<2>> moved = block.cells;
  for (Vec<2>& x : moved) x[0] += 0.005;
  const Reals work = window.follow(moved);
  ASSERT_EQ(work.size(), 1u);  // the other marker has no contact
  EXPECT_NEAR(work[0], 1.0 * 0.005, 1e-15);
  EXPECT_LT((window.applied_N()[0] - 0.5 * Vec<2>(-2.0 - 100.0 * 0.015, 0.0)).norm(), 1e-12);
  // told already: what is left of the window's work is nothing
  EXPECT_NEAR(window.work_Nmm(window.motion(moved, moved.size()))[0], 0.0, 1e-15);
}

MarkerForce<2> measured(const Vec<2>& force_N, double stiffness_N_mm) {
  MarkerForce<2> m;
  m.force_N = force_N;
  m.stiffness_N_mm = stiffness_N_mm;
  m.moved_mm = {0.004, 0.001};
  m.expected_mm = {0.003, 0.003};
  return m;
}

TEST(BalancedResponse, AlongTheForceAWallHasItsStiffnessAndGrainsYieldToTheMeanPace) {
  const MarkerForce<2> m = measured({-2.0, 0.0}, 100.0);
  const Vec<2> moved(0.006, 0.002), pace(0.002, 0.0);
  EXPECT_NEAR(balanced_response<2>(m, moved, pace, false).force_N[0], -(2.0 + 100.0 * 0.010), 1e-13);
  EXPECT_NEAR(balanced_response<2>(m, moved, pace, true).force_N[0], -(2.0 + 100.0 * 0.005), 1e-13);
  // across: 0.003 mm came, 0.003 were to come
  EXPECT_NEAR(balanced_response<2>(m, moved, pace, true).force_N[1], 0.0, 1e-13);
  EXPECT_NEAR(balanced_response<2>(m, {0.006, -0.003}, pace, true).force_N[1], 100.0 * 0.005, 1e-13);
  // it never pulls, holds with no more than its size, and where there is no force there is no contact
  EXPECT_EQ(balanced_response<2>(m, {-1.0, 0.002}, pace, true).force_N[0], 0.0);
  EXPECT_NEAR(balanced_response<2>(m, {0.006, -1.0}, pace, true).force_N[1], 2.0, 1e-13);
  EXPECT_EQ(balanced_response<2>(measured({0.0, 0.0}, 100.0), moved, pace, true).force_N, Vec<2>(0.0, 0.0));
}

TEST(BalancedResponse, StiffnessIsItsDerivative) {
  const MarkerForce<2> m = measured({-2.0, 1.0}, 100.0);
  constexpr double d = 1e-6;
  for (const Vec<2>& at : {Vec<2>(0.006, 0.002), Vec<2>(-1.0, -2.0), Vec<2>(-0.1, 0.0)}) {
    const ContactResponse<2> response = balanced_response<2>(m, at, Vec<2>(0.002, 0.0), true);
    for (int a = 0; a < 2; ++a) {
      const auto force = [&](double by) {
        return balanced_response<2>(m, at + by * Vec<2>::Unit(a), Vec<2>(0.002, 0.0), true).force_N;
      };
      const Vec<2> slope = (force(-d) - force(d)) / (2.0 * d);
      // a force that is held at its size still turns nothing: its stiffness is none
      EXPECT_LT((slope - response.stiffness_N_mm.col(a)).norm(), 1e-6) << at.transpose() << ", " << a;
    }
  }
}

/// What is only tried leaves no work behind; what is kept does the mean of its forces times the way.
TEST(WindowForces, ABalanceThatIsSoughtCountsOnceItIsFound) {
  const Block block;
  WindowForces<2> window = block.forces(0.5, {measured({-2.0, 0.0}, 100.0), MarkerForce<2>{}});
  const auto moved_by = [&](double dx) {
    std::vector<Vec<2>> moved = block.cells;
    for (Vec<2>& x : moved) x[0] += dx;
    return moved;
  };
  EXPECT_TRUE(window.balance(moved_by(0.3), 1.0, false).empty());
  EXPECT_TRUE(window.balance(moved_by(-0.3), 1.0, false).empty());
  EXPECT_EQ(window.applied_N()[0][0], 0.0);
  const Reals work = window.balance(moved_by(0.005), 1.0, true);
  const double before_N = 0.5 * (2.0 + 100.0 * 0.001), after_N = 0.5 * (2.0 + 100.0 * 0.006);
  ASSERT_EQ(work.size(), 1u);
  EXPECT_NEAR(window.applied_N()[0][0], -after_N, 1e-12);
  EXPECT_NEAR(work[0], 0.5 * (before_N + after_N) * 0.005, 1e-14);
  EXPECT_NEAR(window.work_Nmm(window.motion(moved_by(0.005), block.cells.size()))[0], 0.0, 1e-15);
}

/// A step that is cut takes a marker half as far: at that pace grains answer as before.
TEST(WindowForces, AtTheMeanPaceGrainsAnswerAsBeforeHoweverAStepIsCut) {
  const Block block;
  MarkerForce<2> m = measured({-2.0, 0.5}, 100.0);
  m.moved_mm = m.expected_mm;
  m.pace_mm = {0.006, -0.002};
  for (const double part : {1.0, 0.5, 0.25}) {
    WindowForces<2> window = block.forces(1.0, {m, MarkerForce<2>{}});
    std::vector<Vec<2>> moved = block.cells;
    for (Vec<2>& x : moved) x += part * m.pace_mm;
    window.balance(moved, part, true);
    EXPECT_LT((window.applied_N()[0] - m.force_N).norm(), 1e-12) << part;
  }
}

/// Spread by rows it is at least phi_i k phi_j: for the same motion of all cells it is the contact's own.
TEST(WindowForces, StiffnessWithoutInertiaBoundsTheContacts) {
  Block block;
  block.markers[1] = {-0.08, 0.18};  // outside, where some weights are negative
  const WindowForces<2> window = block.forces(0.5, {MarkerForce<2>{}, measured({-2.0, 1.0}, 80.0)});
  std::vector<Mat<2>> rows(36, Mat<2>::Zero());
  window.add_stiffness(block.cells, 1.0, rows);
  Mat<2> total = Mat<2>::Zero();
  for (const Mat<2>& k : rows) total += k;
  double magnitudes = 0.0;
  for (const auto& s : window.mapping().shares(1)) magnitudes += std::abs(s.weight);
  EXPECT_LT((total - 0.5 * 80.0 * magnitudes * magnitudes * Mat<2>::Identity()).norm(), 1e-11);
  std::vector<Mat<2>> first(3, Mat<2>::Zero());  // the other cells rest
  window.add_stiffness(block.cells, 1.0, first);
  EXPECT_EQ(first[2], rows[2]);
}

// ---- bookkeeping ----------------------------------------------------------------------------------

TEST(Books, ThrustIsSummedFromTheTip) {
  const std::vector<MarkerThrust> thrust{{0.1, 1.0}, {0.5, 2.0}, {0.9, 4.0}};
  EXPECT_EQ(thrust_within_N(thrust, 0.5), 3.0);
  EXPECT_EQ(thrust_within_N(thrust, std::numeric_limits<double>::infinity()), 7.0);
}

/// Rate 2 /h over 1 mm: freely 2 mm/h. Half of the arresting thrust at the tip halves it; at mid-length it slows the
/// half that it presses; beyond the arresting thrust nothing grows and nothing shrinks.
TEST(Books, ExpectedSpeedFallsWithTheThrustAlongTheRoot) {
  const auto rate = [](double) { return 2.0; };
  const RootSize root{1.0, 0.1, 4.0};
  const auto speed = [&](std::vector<MarkerThrust> thrust) { return expected_tip_speed_mm_h(thrust, root, rate); };
  EXPECT_NEAR(speed({}), 2.0, 1e-14);
  EXPECT_NEAR(speed({{-0.01, 2.0}}), 1.0, 1e-14);
  EXPECT_NEAR(speed({{0.501, 2.0}}), 1.5, 1e-14);
  EXPECT_EQ(speed({{0.0, 5.0}}), 0.0);
  EXPECT_EQ(expected_tip_speed_mm_h({}, {1.0, 0.1, 0.0}, rate), 0.0);
}

TEST(Books, CompareSpeedFromTheFirstExpectationOn) {
  SoilBooks books;
  EXPECT_EQ(books.closing_remark(1.0, 2.0), "");
  books.root_did(Reals{0.25, 0.5});
  books.soil_received(Reals{0.5});
  books.expect(0.3, 0.5, 1.0, 2.0);
  EXPECT_EQ(books.closing_remark(1.0, 2.0), "");  // no time has passed
  books.expect(0.5, 0.5, 1.5, 2.2);
  const std::string remark = books.closing_remark(2.0, 2.5);
  EXPECT_NE(remark.find("tip speed 0.5000 mm/h"), std::string::npos) << remark;
  EXPECT_NE(remark.find("should be 0.4000 mm/h"), std::string::npos) << remark;
  EXPECT_NE(remark.find("root 0.75 N mm, received by the soil 0.5 N mm, 50 % apart: "), std::string::npos) << remark;
  std::map<std::string, Reals> reals;
  books.save(reals);
  SoilBooks again;
  again.restore(reals);
  EXPECT_EQ(again.closing_remark(2.0, 2.5), remark);
}

TEST(Books, SayNothingOfWorkThatIsNearlyTheSame) {
  SoilBooks books;
  books.root_did(Reals{0.91});
  books.soil_received(Reals{1.0});
  books.expect(0.3, 0.5, 1.0, 2.0);
  EXPECT_EQ(books.closing_remark(2.0, 2.5).find("apart"), std::string::npos);
}

TEST(Books, HistoryAddsTheSoilsOwnNumbers) {
  MarkerTotals totals;
  totals.tip_thrust_N = 0.3;
  totals.section = 0.6;
  const auto row = soil_history(totals, SoilBooks(), {{"soil_told", 3.0}});
  EXPECT_EQ(row.back(), (std::pair<std::string, double>("soil_told", 3.0)));
  EXPECT_EQ(row[3], (std::pair<std::string, double>("soil_tip_resistance_MPa", 0.5)));
}

TEST(Books, FramesTakeStressInTheirOwnOrder) {
  EXPECT_TRUE(soil_tables({}).empty());
  SoilSnapshot soil;
  soil.id = {5};
  soil.position_mm = soil.velocity_mm_h = {{1, 2, 3}};
  soil.radius_mm = {0.1};
  soil.contacts = {2};
  soil.stress_MPa = {{1, 2, 3, 4, 5, 6}};  // xx yy zz yz xz xy
  const std::vector<FrameTable> tables = soil_tables(soil);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(std::get<Reals>(tables[0].columns[4].values), (Reals{1, 2, 3, 6, 4, 5}));  // xx yy zz xy yz xz
}

/// Growth could do 1 N mm/h. What the soil receives more than the root did is told above 0.05 of this, and again only
/// when it has doubled.
TEST(EnergyCheck, TellsWhenTheExchangeMakesEnergy) {
  EnergyCheck check;
  const auto over = [&check](double root_Nmm, double soil_Nmm) {
    std::string notes;
    for (int k = 0; k < EnergyCheck::intervals; ++k) {
      check.root_did(Reals{root_Nmm});
      if (auto note = check.soil_received(Reals{soil_Nmm}, 0.5, 0.01, 1.0, 1.0)) notes += *note;
    }
    return notes;
  };
  EXPECT_EQ(over(5e-3, 2.0 * (5e-3 + 0.049 * 0.01)), "");  // half of the soil's forces act
  const std::string note = over(5e-3, 2.0 * (5e-3 + 0.06 * 0.01));
  EXPECT_NE(note.find("pumps energy"), std::string::npos);
  EXPECT_NE(note.find("0.06 of the arresting force"), std::string::npos) << note;
  EXPECT_EQ(over(5e-3, 2.0 * (5e-3 + 0.11 * 0.01)), "");
  std::map<std::string, Reals> reals;
  check.save(reals);
  EnergyCheck again;
  again.restore(reals);
  std::swap(check, again);
  EXPECT_EQ(over(5e-3, 2.0 * (5e-3 + 0.11 * 0.01)), "");
  EXPECT_NE(over(5e-3, 2.0 * (5e-3 + 0.13 * 0.01)), "");
  EXPECT_EQ(over(5e-3, 0.0), "");  // losing energy is no swing
}

}  // namespace
}  // namespace rootsoil
