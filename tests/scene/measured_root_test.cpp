// SPDX-License-Identifier: MIT
// From measured cells to a root: axis and tip, specks, hull.
#include "root_sph/model/measured_root.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <numbers>

#include "root_sph/core/errors.hpp"
#include "root_sph/model/initial_cells.hpp"
#include "tests/scene/scene_text.hpp"

namespace rootsoil {
namespace {

using testing::minimal;
using testing::parse;

MeasuredCell cell_at(std::int64_t label, const Vec<3>& position_um, const Vec<3>& semi_axes_um) {
  MeasuredCell cell;
  cell.label = label;
  cell.line = static_cast<int>(label) + 1;
  cell.position_mm = 1e-3 * position_um;
  cell.semi_axes_mm = 1e-3 * semi_axes_um;
  cell.volume_mm3 = ellipsoid_volume_mm3(cell);
  return cell;
}

/// Balls of 10 um, `along` layers of `across` by `across`, and those of the last layer smaller.
std::vector<MeasuredCell> block(int along, int across, double smaller = 1.0) {
  std::vector<MeasuredCell> cells;
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      for (int k = 0; k < across; ++k) {
        const double r = i < along / 2 ? 5.0 : 5.0 * smaller;
        cells.push_back(cell_at(std::ssize(cells) + 1, {10.0 * i, 10.0 * j, 10.0 * k}, Vec<3>::Constant(r)));
      }
    }
  }
  return cells;
}

std::vector<MeasuredCell> turned(std::vector<MeasuredCell> cells, double degrees, const Vec<3>& about) {
  const Mat<3> turn = Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, about.normalized()).toRotationMatrix();
  for (MeasuredCell& cell : cells) {
    cell.position_mm = turn * cell.position_mm;
    cell.axes = turn * cell.axes;
  }
  return cells;
}

InputProblem refusal(std::vector<MeasuredCell> cells, TipAxis asked) {
  MeasuredRootReport report;
  try {
    turn_to_x(cells, asked, "c.csv", report);
  } catch (const InputError& e) {
    return e.problem();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

TEST(MeasuredRoot, LeaningRootIsTurnedOntoItsAxis) {
  std::vector<MeasuredCell> straight = block(12, 3), leaning = turned(straight, 30.0, Vec<3>::UnitZ());
  straight.push_back(cell_at(999, {60.0, 31.0, 10.0}, {9.0, 6.0, 5.0}));  // one that is furthest from the axis
  leaning = turned(straight, 30.0, {0.2, 0.1, 1.0});
  MeasuredRootReport a, b;
  turn_to_x(straight, TipAxis::plus_x, "c.csv", a);
  turn_to_x(leaning, TipAxis::plus_x, "c.csv", b);
  EXPECT_LT(a.lean_deg, 3.0);
  EXPECT_NEAR(b.lean_deg, 30.0, 3.0);
  for (std::size_t i = 0; i < straight.size(); ++i) {
    const Vec<3> x = straight[i].position_mm - straight[0].position_mm;
    EXPECT_LT((leaning[i].position_mm - leaning[0].position_mm - x).norm(), 1e-12);
    EXPECT_LT((shape_matrix(leaning[i]) / shape_matrix(straight[i]).norm() -
               shape_matrix(straight[i]) / shape_matrix(straight[i]).norm())
                  .norm(),
              1e-12);
  }
}

TEST(MeasuredRoot, TipIsTheEndWithTheSmallerCells) {
  for (const double degrees : {0.0, 75.0, 180.0}) {
    std::vector<MeasuredCell> cells = turned(block(12, 3, 0.9), degrees, {0.0, 0.3, 1.0});
    MeasuredRootReport report;
    turn_to_x(cells, TipAxis::found, "c.csv", report);
    EXPECT_GT(cells.back().position_mm[0], cells.front().position_mm[0] + 0.1) << degrees;
    EXPECT_EQ(report.tip_found, "the end with the smaller cells");
  }
}

TEST(MeasuredRoot, TipIsElseTheNarrowerEndElseThatOfLargerCoordinates) {
  std::vector<MeasuredCell> cells = block(12, 3);
  MeasuredRootReport report;
  turn_to_x(cells, TipAxis::found, "c.csv", report);
  EXPECT_EQ(report.tip_axis, "+x");
  EXPECT_NE(report.tip_found.find("do not tell"), std::string::npos);
  std::vector<MeasuredCell> tapered = block(12, 3);
  std::erase_if(tapered, [](const MeasuredCell& c) { return c.position_mm[0] < 0.025 && c.position_mm[1] > 0.015; });
  turn_to_x(tapered, TipAxis::found, "c.csv", report);
  EXPECT_EQ(report.tip_axis, "-x");
  EXPECT_NE(report.tip_found.find("narrower"), std::string::npos);
}

TEST(MeasuredRoot, NoAxisOrAnotherOneIsRefused) {
  const InputProblem cube = refusal(block(4, 4), TipAxis::found);
  EXPECT_EQ(cube.key, "root.tip_axis");
  EXPECT_NE(cube.what.find("about as wide as long"), std::string::npos);
  EXPECT_NE(cube.remedy.find("give tip_axis"), std::string::npos);
  const InputProblem across = refusal(block(12, 3), TipAxis::minus_y);
  EXPECT_NE(across.given.find("90 degrees"), std::string::npos) << across.given;
  EXPECT_NE(across.remedy.find("x\" or its opposite"), std::string::npos) << across.remedy;
  std::vector<MeasuredCell> cells = block(4, 4);
  MeasuredRootReport report;
  EXPECT_NO_THROW(turn_to_x(cells, TipAxis::minus_z, "c.csv", report));
  EXPECT_NEAR(cells.back().position_mm[0] - cells.front().position_mm[0], -0.03, 1e-12);
}

TEST(MeasuredRoot, SpecksBecomePartOfTheCellThatTheyTouch) {
  std::vector<MeasuredCell> cells = block(12, 3);
  cells.push_back(cell_at(500, {60.0, 25.5, 10.0}, {1.0, 0.8, 0.5}));  // outside of cell 62, which lies at y = 20
  cells.push_back(cell_at(501, {60.0, 26.5, 10.0}, {0.6, 0.6, 0.6}));  // touches hardly more than the other speck
  const auto sums = [](const std::vector<MeasuredCell>& all) {
    double volume = 0.0;
    Vec<3> first = Vec<3>::Zero();
    Mat<3> second = Mat<3>::Zero();
    for (const MeasuredCell& c : all) {
      volume += c.volume_mm3;
      first += c.volume_mm3 * c.position_mm;
      second += c.volume_mm3 * (covariance(c) + c.position_mm * c.position_mm.transpose());
    }
    return std::tuple(volume, first, second);
  };
  const auto [volume, first, second] = sums(cells);
  const std::vector<Merged> merges = merge_specks(cells);
  const auto [volume_after, first_after, second_after] = sums(cells);
  EXPECT_EQ(cells.size(), 108u);
  ASSERT_EQ(merges.size(), 2u);
  EXPECT_EQ(merges[0].label, 501);
  EXPECT_EQ(merges[1].label, 500);
  EXPECT_EQ(merges[1].into, 62);
  EXPECT_NEAR(volume_after, volume, 1e-14 * volume);
  EXPECT_TRUE(first_after.isApprox(first, 1e-13));
  EXPECT_TRUE(second_after.isApprox(second, 1e-13));
}

TEST(MeasuredRoot, CellsOfTheirNeighboursSizeAreKept) {
  std::vector<MeasuredCell> cells = block(12, 3);
  cells.push_back(cell_at(500, {60.0, 28.0, 10.0}, Vec<3>::Constant(2.5)));  // an eighth of the one that it touches
  EXPECT_TRUE(merge_specks(cells).empty());
  cells.push_back(cell_at(501, {60.0, 200.0, 10.0}, {0.5, 0.5, 0.5}));  // touches nothing
  EXPECT_TRUE(merge_specks(cells).empty());
}

TEST(MeasuredRoot, HullOfTouchingBallsIsTheBlock) {
  // 15 by 4 by 4 balls: a box with rounded edges
  EXPECT_NEAR(hull_volume_mm3(block(15, 4)) / (0.15 * 0.04 * 0.04), 1.0, 0.04);
}

TEST(MeasuredRoot, HullFollowsABentRoot) {
  std::vector<MeasuredCell> cells = block(30, 4);
  const double straight = hull_volume_mm3(cells);
  const double radius = 0.4;  // 3/4 of a radian: a sagitta of 28 um, most of the root's width
  for (MeasuredCell& cell : cells) {
    const double angle = cell.position_mm[0] / radius - 0.375, r = radius + cell.position_mm[1] - 0.015;
    cell.position_mm = {r * std::sin(angle), r * std::cos(angle), cell.position_mm[2]};
  }
  EXPECT_NEAR(hull_volume_mm3(cells) / straight, 1.0, 0.1);
}

TEST(MeasuredRoot, TouchIsOneWhereEllipsoidsTouch) {
  const MeasuredCell a = cell_at(1, {0, 0, 0}, {20, 10, 5}), b = cell_at(2, {25, 0, 0}, {5, 3, 2});
  EXPECT_NEAR(touch(b.position_mm, shape_matrix(a), shape_matrix(b)), 1.0, 1e-12);
  EXPECT_EQ(touch(Vec<3>::Zero(), shape_matrix(a), shape_matrix(b)), 0.0);
}

TEST(MeasuredRoot, CellsInALongOneAreRefused) {
  const auto folder = std::filesystem::temp_directory_path() / "rootsoil_measured_root_test";
  std::filesystem::create_directories(folder);
  std::ofstream out(folder / "cells.csv");
  out << "Label,pos.X (um),pos.Y (um),pos.Z (um),e1.X,e1.Y,e1.Z,e2.X,e2.Y,e2.Z,r1 (um),r2 (um),r3 (um)\n";
  std::vector<MeasuredCell> cells = block(12, 3);
  cells.push_back(cell_at(500, {55.0, 10.0, 10.0}, {40.0, 5.0, 5.0}));  // over the whole row of cell 50
  for (const MeasuredCell& c : cells) {
    const Vec<3> x = 1e3 * c.position_mm, r = 1e3 * c.semi_axes_mm;
    out << c.label << ',' << x[0] << ',' << x[1] << ',' << x[2] << ",1,0,0,0,1,0," << r[0] << ',' << r[1] << ',' << r[2]
        << '\n';
  }
  out.close();
  std::ofstream(folder / "s.toml") << [&] {
    std::string text = minimal;
    const std::string lattice = "length_mm = 0.4\nradius_mm = 0.05\ncell_size_mm = 0.01";
    text.replace(text.find(lattice), lattice.size(), "cells_file = \"cells.csv\"");
    return text.replace(text.find("[scene]"), 7, "[scene]\ndimension = 3");
  }();
  const Scene scene = read_scene(folder / "s.toml");
  try {
    read_measured_root(scene);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.problem().line, 110);
    EXPECT_NE(e.problem().what.find("cells overlap: cell 50 (line 51) and cell 500 (line 110)"), std::string::npos)
        << e.problem().what;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace rootsoil
