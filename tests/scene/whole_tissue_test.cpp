// SPDX-License-Identifier: MIT
// Cells at time 0 that are no tissue are refused, and the message says which.
#include "root_sph/model/whole_tissue.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "root_sph/model/initial_cells.hpp"
#include "tests/scene/scene_text.hpp"

namespace rootsoil {
namespace {

using testing::minimal;
using testing::parse;

InputProblem refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& e) {
    return e.problem();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

MeasuredCell ball(std::int64_t label, const Vec<3>& position_um, double radius_um = 5.0) {
  MeasuredCell cell;
  cell.label = label;
  cell.line = static_cast<int>(label) + 1;
  cell.position_mm = 1e-3 * position_um;
  cell.semi_axes_mm = Vec<3>::Constant(1e-3 * radius_um);
  return cell;
}

/// Labels 1 to 100: two rows of 50, 10 um apart.
std::vector<MeasuredCell> two_rows() {
  std::vector<MeasuredCell> cells;
  for (int k = 0; k < 100; ++k) cells.push_back(ball(k + 1, {10.0 * (k / 2), 10.0 * (k % 2), 0.0}));
  return cells;
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

TEST(WholeTissue, IsAccepted) {
  EXPECT_NO_THROW(refuse_parts("c.csv", two_rows()));
  EXPECT_NO_THROW(refuse_overlap("c.csv", 0.9));
}

TEST(WholeTissue, GapsOfLessThanACellAreAccepted) {
  std::vector<MeasuredCell> cells = two_rows();
  cells.push_back(ball(101, {509.0, 0.0, 0.0}));  // 19 um from the last: 1.9 cell lengths
  EXPECT_NO_THROW(refuse_parts("c.csv", cells));
  cells.back().position_mm[0] = 0.511;
  expect_part(refusal([&] { refuse_parts("c.csv", cells); }).given, "cell 101 (line 102) is 0.021 mm from the next");
}

TEST(WholeTissue, StrayCellIsNamedWithItsLineAndDistance) {
  for (const Vec<3>& place : {Vec<3>(5000.0, 0.0, 0.0), Vec<3>(0.0, -1e7, 0.0), Vec<3>(250.0, 40.0, 20.0)}) {
    std::vector<MeasuredCell> cells = two_rows();
    cells.insert(cells.begin() + 30, ball(777, place));
    const InputProblem problem = refusal([&] { refuse_parts("c.csv", cells); });
    EXPECT_EQ(problem.file, "c.csv");
    EXPECT_EQ(problem.line, 778);
    expect_part(problem.what, "1 of 101 cells lies apart from the others: cell 777 (line 778)");
    expect_part(problem.given, "mm from the next, cell ");
    expect_part(problem.remedy, "stray cells");
  }
}

TEST(WholeTissue, PartsOfManyCellsNameTheFirst) {
  std::vector<MeasuredCell> cells = two_rows();
  for (std::size_t k = 60; k < 100; ++k) cells[k].position_mm[0] += 0.03;
  const InputProblem problem = refusal([&] { refuse_parts("c.csv", cells); });
  expect_part(problem.what, "40 of 100 cells lie apart from the others: cell 61 (line 62), cell 62 (line 63),");
  expect_part(problem.what, "cell 65 (line 66), ...");
  expect_part(problem.given, "cell 61 (line 62) is 0.04 mm from the next, cell 59 (line 60)");
}

TEST(WholeTissue, CellsGivenTwiceAreNamed) {
  for (const double shift_um : {0.0, 1.0}) {
    std::vector<MeasuredCell> cells = two_rows();
    cells.push_back(ball(101, 1e3 * cells[20].position_mm + Vec<3>(0.0, shift_um, 0.0)));
    const InputProblem problem = refusal([&] { refuse_parts("c.csv", cells); });
    expect_part(problem.what, "cells lie in one place: cell 21 (line 22) and cell 101 (line 102)");
    EXPECT_EQ(problem.line, 102);
    expect_part(problem.remedy, "cells given twice");
  }
}

TEST(WholeTissue, SpeckBetweenCellsIsNamed) {
  std::vector<MeasuredCell> cells = two_rows();
  cells.push_back(ball(101, {255.0, 5.0, 0.0}, 0.5));
  expect_part(refusal([&] { refuse_parts("c.csv", cells); }).what,
              "1 of 101 cells lies apart from the others: cell 101");
}

TEST(WholeTissue, CellsOfNearlyNoSizeLieApart) {
  std::vector<MeasuredCell> cells = two_rows();
  for (MeasuredCell& cell : cells) cell.semi_axes_mm *= 1e-4;
  expect_part(refusal([&] { refuse_parts("c.csv", cells); }).given, "they are 1e-06 and 1e-06 mm large");
}

TEST(WholeTissue, DiametersInPlaceOfSemiAxesOverlap) {
  expect_part(refusal([] { refuse_overlap("c.csv", 0.125); }).remedy, "semi-axes, not diameters");
}

template <int Dim>
InputProblem lattice_refusal(std::vector<std::string> overrides, const std::string& text = minimal) {
  overrides.push_back("scene.dimension=" + std::to_string(Dim));
  const Scene scene = parse(text, overrides);
  Tissue<Dim> tissue;
  return refusal([&] { make_initial_cells<Dim>(scene, tissue, 1.5); });
}

TEST(WholeTissue, TornLatticeNamesItsKey) {
  EXPECT_EQ(lattice_refusal<2>({"root.jitter=0.5"}).key, "root.jitter");
  EXPECT_EQ(lattice_refusal<2>({"root.size_variation=0.95", "root.jitter=0.3"}).key, "root.size_variation");
  // the inner side is pressed to 0.15 of its length
  const InputProblem bent = lattice_refusal<2>({"root.curvature_per_mm=19", "root.length_mm=0.3"});
  EXPECT_EQ(bent.key, "root.curvature_per_mm");
  expect_part(bent.what, "cells lie in one place: the cell at (");
}

TEST(WholeTissue, IrregularLatticesOfTheTestsAndScenesHold) {
  for (const auto& irregular : std::vector<std::vector<std::string>>{{"root.jitter=0.3", "root.size_variation=0.82"},
                                                                     {"root.jitter=0.2", "root.size_variation=0.3"}}) {
    const Scene scene = parse(minimal, irregular);
    Tissue<2> tissue;
    EXPECT_NO_THROW(make_initial_cells<2>(scene, tissue, 1.5));
  }
}

TEST(WholeTissue, ThreadIsRefused) {
  expect_part(lattice_refusal<2>({"root.length_mm=1000", "root.radius_mm=1e-3", "root.cell_size_mm=2e-3"}).what,
              "thread");
}

TEST(HastyDivision, ThresholdInMetresIsRefused) {
  for (const char* l0 : {"division.l0_mm=1.0e-5", "division.l0_mm=4e-3"}) {
    const InputProblem problem = lattice_refusal<2>({l0});
    EXPECT_EQ(problem.key, "division.l0_mm");
    expect_part(problem.what, "would divide into some");
    expect_part(problem.given, "times longer than the threshold at its place");
  }
  expect_part(lattice_refusal<3>({"division.l0_mm=4e-3"}).remedy, "is the threshold in mm?");
}

TEST(HastyDivision, OneDivisionAlongEachAxisIsAllowed) {
  const Scene scene = parse(minimal, {"division.l0_mm=6e-3"});
  Tissue<2> tissue;
  EXPECT_NO_THROW(make_initial_cells<2>(scene, tissue, 1.5));
}

}  // namespace
}  // namespace rootsoil
