// SPDX-License-Identifier: MIT
// Pressure, growth, anisotropy, division and probes on their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/inertia_compensation/inertia_compensation.hpp"
#include "root_sph/effects/midline_damping/midline_damping.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/effects/probe/probe.hpp"
#include "root_sph/scene/value_table.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

TEST(PressureTable, IsLinearBetweenItsRowsAndConstantBeyond) {
  const Rows table{{1.0, 0.2}, {2.0, 1.0}, {4.0, 0.0}};
  EXPECT_EQ(value_at(table, 0.0), 0.2);
  EXPECT_EQ(value_at(table, 1.0), 0.2);
  EXPECT_NEAR(value_at(table, 1.25), 0.4, 1e-15);
  EXPECT_EQ(value_at(table, 2.0), 1.0);
  EXPECT_NEAR(value_at(table, 3.5), 0.25, 1e-15);
  EXPECT_EQ(value_at(table, 4.0), 0.0);
  EXPECT_EQ(value_at(table, 100.0), 0.0);
  EXPECT_EQ(value_at({{0.0, 0.7}}, 3.0), 0.7);
}

template <class Dimension>
class Effects : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;
  Random random{1};
  Solver<Dim> solver{SolverOptions{}};
  Tissue<Dim>& tissue = solver.tissue();

  void fill_root() {
    std::array<int, Dim> counts;
    counts.fill(4);
    counts[0] = 30;
    test::fill<Dim>(tissue, test::lattice<Dim>(counts, 0.01, random));
    solver.axis().start(tissue);
  }
  template <class Passes>
  void run(Passes& passes) {
    for (auto& [name, pass] : passes) pass(tissue);
  }
};
TYPED_TEST_SUITE(Effects, test::BothDimensions, test::DimensionName);

TYPED_TEST(Effects, ConstantPressureIsSetOnceWithoutAPass) {
  constexpr int dim = TypeParam::value;
  PressureEffect<dim> pressure(this->solver, {{0.0, 0.7}});
  EXPECT_EQ(this->tissue.pressure_MPa, 0.7);
  EXPECT_TRUE(this->solver.hooks().step_loads.empty());
  EXPECT_TRUE(this->solver.hooks().loads.empty());
}

TYPED_TEST(Effects, PressureFollowsItsTableInWindowsAndSteps) {
  constexpr int dim = TypeParam::value;
  PressureEffect<dim> pressure(this->solver, {{0.0, 0.0}, {2.0, 1.0}});
  EXPECT_EQ(this->tissue.pressure_MPa, 0.0);
  this->tissue.time_h = 0.5;
  this->run(this->solver.hooks().loads);
  EXPECT_NEAR(this->tissue.pressure_MPa, 0.25, 1e-15);
  this->tissue.time_h = 1.0;
  this->run(this->solver.hooks().step_loads);
  EXPECT_NEAR(this->tissue.pressure_MPa, 0.5, 1e-15);
}

/// A scene with one section, of which one key falls to 0 with the pressure: that shows which pressure was asked for.
template <class S>
Scene scene_with(const S& section, const std::string& name, const std::string& key, double value) {
  Scene scene;
  scene.tissue.E_axial_MPa = test::table_1().E_axial_MPa;
  scene.tissue.G_MPa = test::table_1().G_MPa;
  scene.all<S>() = {section};
  scene.responses = {{.section = name, .p_MPa = {1.0, 0.0}, .pairs = {{key, {value, 0.0}}}}};
  return scene;
}

TYPED_TEST(Effects, GrowthSetsTheSofteningOfFreeCellsAtThePressure) {
  constexpr int dim = TypeParam::value;
  const GrowthSection uniform{0.0, 0.05, 0.1, 1.0, {}};  // c_g = 1: the same everywhere
  GrowthEffect<dim> growth(this->solver, scene_with(uniform, "growth", "lambda0_ug_mm3_h", 4e5));
  this->fill_root();
  test::build_operators<dim>(this->tissue, 1.5, GradientMode::linear);
  this->tissue.pressure_MPa = 0.5;
  this->run(this->solver.hooks().operators);
  const auto& softening = *this->tissue.material.softening;
  for (std::size_t i = 0; i < this->tissue.cells.size(); ++i) EXPECT_NEAR(softening[i], 2e5, 1e-6);

  this->tissue.cells.clamped[5] = 1;
  this->run(this->solver.hooks().operators);
  EXPECT_EQ(softening[5], 0.0);
}

TYPED_TEST(Effects, GrowthMeetsAProfileThatVariesOverManyCellsToSecondOrder) {
  constexpr int dim = TypeParam::value;
  const GrowthSection profile{4e5, -0.3, 0.4, -1.0, {}};
  Scene scene;
  scene.all<GrowthSection>() = {profile};
  GrowthEffect<dim> growth(this->solver, scene);
  this->fill_root();
  test::build_operators<dim>(this->tissue, 1.5, GradientMode::linear);
  this->run(this->solver.hooks().operators);
  for (std::size_t i = 0; i < this->tissue.cells.size(); ++i) {
    const double s = this->tissue.cells.distance_to_tip[i];
    EXPECT_NEAR((*this->tissue.material.softening)[i], softening_ug_mm3_h(profile, s), 0.02 * 4e5) << s;
  }
}

TYPED_TEST(Effects, AnisotropySetsTheStiffnessFromTheProfileAtThePressure) {
  constexpr int dim = TypeParam::value;
  const AnisotropySection section{0.0, 0.1, 20.0, 0.2};
  AnisotropyEffect<dim> anisotropy(this->solver, scene_with(section, "tissue.anisotropy", "E_radial_max_MPa", 15000.0));
  this->fill_root();
  this->tissue.pressure_MPa = 0.5;
  this->run(this->solver.hooks().parameters);
  std::vector<FrameColumn> columns;
  anisotropy.add_columns(this->tissue, columns);
  ASSERT_EQ(columns.size(), 1u);
  const auto& written = std::get<std::vector<double>>(columns[0].values);
  for (std::size_t i = 0; i < this->tissue.cells.size(); ++i) {
    const double modulus = radial_modulus_MPa({7500.0, 0.1, 20.0, 0.2}, 1020.0, this->tissue.cells.distance_to_tip[i]);
    EXPECT_EQ(this->tissue.material.stiffness_of(i), stiffness<dim>(test::table_1(modulus)));
    EXPECT_EQ(written[i], modulus);
  }
}

TYPED_TEST(Effects, InertiaCompensationGivesFreeCellsTheSteadyAcceleration) {
  constexpr int dim = TypeParam::value;
  InertiaCompensationEffect<dim> compensation(this->solver);
  this->fill_root();
  this->tissue.cells.clamped[5] = 1;
  for (double& strain : this->tissue.axial_strain.values()) strain = 0.3 * 0.02;
  this->solver.axis().measure_flow(this->tissue, this->tissue.cells.distance_to_tip.values(), 0.02);
  this->run(this->solver.hooks().acceleration);
  const double length = this->solver.axis().length_mm();
  for (std::size_t i = 0; i < this->tissue.cells.size(); ++i) {
    // uniform rate e: a = e^2 (L - s)
    const double expected = i == 5 ? 0.0 : 0.09 * (length - this->tissue.cells.distance_to_tip[i]);
    EXPECT_LT(((*this->tissue.body_acceleration)[i] - expected * Vec<dim>::UnitX()).norm(), 1e-12);
  }
}

TYPED_TEST(Effects, PrescribedAccelerationsStartAnewInEveryWindow) {
  this->fill_root();
  this->tissue.step_h = 1e-4;
  this->tissue.material.uniform = stiffness<TypeParam::value>(test::table_1());
  this->tissue.material.rho0_ug_mm3 = 1000.0;
  Field<TypeParam::value, Vec<TypeParam::value>>& acceleration = this->solver.need_body_acceleration();
  EXPECT_EQ(&acceleration, &this->solver.need_body_acceleration());
  this->solver.hooks().acceleration.emplace_back("one more", [&](auto& t) {
    for (std::size_t i = 0; i < t.cells.size(); ++i) acceleration[i] += Vec<TypeParam::value>::UnitX();
  });
  this->solver.prepare();
  for (int window = 0; window < 2; ++window) {
    this->solver.advance_window(1);
    EXPECT_EQ(acceleration[0], (Vec<TypeParam::value>(Vec<TypeParam::value>::UnitX())));
  }
}

TYPED_TEST(Effects, MidlineDampingResistsTheLateralMotionOfSlicesOnly) {
  constexpr int dim = TypeParam::value;
  MidlineDampingEffect<dim> damping(this->solver, 3.0);
  this->fill_root();
  auto& cells = this->tissue.cells;
  cells.clamped[5] = 1;
  const Vec<dim> sideways = 0.2 * Vec<dim>::Unit(1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // the root moves sideways and forwards, and widens
    Vec<dim> widening = 2.0 * cells.position[i];
    widening[0] = 0.7;
    cells.velocity[i] = sideways + widening;
  }
  this->run(this->solver.hooks().acceleration);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Vec<dim> expected = i == 5 ? Vec<dim>(Vec<dim>::Zero()) : Vec<dim>(-3.0 * sideways);
    EXPECT_LT(((*this->tissue.body_acceleration)[i] - expected).norm(), 1e-12);
  }
}

TYPED_TEST(Effects, LongestAxisIsThatOfTheEllipsoid) {
  constexpr int dim = TypeParam::value;
  for (int trial = 0; trial < 20; ++trial) {
    const Mat<dim> axes = this->random.template rotation<dim>();
    Vec<dim> lengths = Vec<dim>::Constant(0.01);
    lengths[1] = 0.03;
    const LongestAxis<dim> axis = longest_axis<dim>(test::ellipsoid<dim>(lengths, axes));
    EXPECT_NEAR(axis.length_mm, 0.03, 1e-14);
    EXPECT_NEAR(std::abs(axis.direction.dot(axes.col(1))), 1.0, 1e-12);
    // its largest component is positive, so that daughters keep their order
    Eigen::Index largest = 0;
    axis.direction.cwiseAbs().maxCoeff(&largest);
    EXPECT_GT(axis.direction[largest], 0.0);
  }
}

TYPED_TEST(Effects, LongestAxisOfASphereIsAnyUnitVector) {
  constexpr int dim = TypeParam::value;
  const LongestAxis<dim> axis = longest_axis<dim>(test::ellipsoid<dim>(Vec<dim>::Constant(0.02), Mat<dim>::Identity()));
  EXPECT_NEAR(axis.length_mm, 0.02, 1e-15);
  EXPECT_NEAR(axis.direction.norm(), 1.0, 1e-14);
}

TYPED_TEST(Effects, DivisionCutsFreeCellsLongerThanTheThresholdOnce) {
  constexpr int dim = TypeParam::value;
  this->fill_root();
  auto& cells = this->tissue.cells;
  DivisionEffect<dim> division(this->solver, {.l0_mm = 0.012}, 1);
  const auto lengthen = [&](std::size_t i, double length) {
    Vec<dim> lengths = Vec<dim>::Constant(0.01);
    lengths[dim - 1] = length;
    cells.shape[i] = test::ellipsoid<dim>(lengths, this->random.template rotation<dim>());
  };
  lengthen(3, 0.01201);
  lengthen(7, 0.01199);
  lengthen(8, 0.1);  // long enough to divide again, in a later window
  lengthen(9, 0.1);
  cells.clamped[9] = 1;
  const std::size_t before = cells.size();
  const std::int64_t next_id = this->tissue.next_cell_id;
  this->run(this->solver.hooks().division);
  EXPECT_EQ(cells.size(), before + 2);
  EXPECT_EQ(this->tissue.next_cell_id, next_id + 4);
  for (std::size_t i = 0; i < before; ++i) EXPECT_EQ(cells.generation[i], i == 3 || i == 8 ? 1 : 0) << i;
  EXPECT_NEAR(longest_axis<dim>(cells.shape[8]).length_mm, 0.05, 1e-12);
  std::vector<std::int64_t> ids = cells.cell_id.values();
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
  this->run(this->solver.hooks().division);
  EXPECT_EQ(cells.size(), before + 4);
}

/// Cells that grow alike and divide at thresholds of their own, for twelve generations: their mean length is that of
/// the closed form. They begin evenly over the logarithm of their length, as they do not stay where thresholds differ.
TEST(Division, MeanLengthOfASteadyPopulationIsTheClosedForms) {
  for (const double scatter : {0.1, 0.3}) {
    const DivisionSection section{.l0_mm = 1.0, .scatter = scatter};
    std::vector<std::pair<double, double>> cells;  // length, threshold
    std::int64_t next_id = 0;
    const auto born = [&](double length) { cells.emplace_back(length, division_factor(section, 7, next_id++)); };
    constexpr int founders = 4000, steps_a_generation = 100, generations = 12;
    for (int k = 0; k < founders; ++k) born(std::exp2(-(k + 0.5) / founders));
    double mean = 0.0;
    for (int step = 1; step <= generations * steps_a_generation; ++step) {
      const std::size_t before = cells.size();
      for (std::size_t i = 0; i < before; ++i) {
        cells[i].first *= std::exp2(1.0 / steps_a_generation);
        if (cells[i].first < cells[i].second) continue;
        const double half = 0.5 * cells[i].first;
        cells[i] = {half, division_factor(section, 7, next_id++)};
        born(half);
      }
      if (step % steps_a_generation == 0) {  // every other cell, whichever it is: the others stay a sample of all
        std::size_t kept = 0;
        for (std::size_t i = 0; i < cells.size(); i += 2) cells[kept++] = cells[i];
        cells.resize(kept);
      }
      if (step <= (generations - 1) * steps_a_generation) continue;
      for (const auto& cell : cells) mean += cell.first / (static_cast<double>(cells.size()) * steps_a_generation);
    }
    // cells divide at the end of the step in which they pass their threshold, half of a step longer on average
    const double exact = mean_length_over_threshold(section) * std::exp2(0.5 / steps_a_generation);
    EXPECT_NEAR(mean / exact, 1.0, 0.01) << scatter;
  }
}

TEST(RunawayDivision, IsToldByTheCellsLengthOrTheirNumber) {
  EXPECT_EQ(runaway_division(20'000'000, 10.0), "");
  EXPECT_NE(runaway_division(20'000'001, 1.0).find("there would be 20000001 cells (at most 2e+07)"), std::string::npos);
  EXPECT_NE(runaway_division(100, 10.1).find("10.1 times shorter than those at the start"), std::string::npos);
}

TYPED_TEST(Effects, DivisionThresholdFollowsTheDistanceFromTheTip) {
  constexpr int dim = TypeParam::value;
  this->fill_root();
  // 0.009 at the tip, 0.009 (1 + 100 s^2) further up: cells of 0.01 divide for s < 0.0333
  DivisionEffect<dim> division(this->solver, {.l0_mm = 0.009, .s_d_per_mm2 = 100.0}, 1);
  const std::vector<double> s = this->tissue.cells.distance_to_tip.values();
  this->run(this->solver.hooks().division);
  for (std::size_t i = 0; i < s.size(); ++i) EXPECT_EQ(this->tissue.cells.generation[i], s[i] < 1.0 / 30.0 ? 1 : 0);
}

/// Tells the solver that the root stretches at 0.4 /h everywhere.
template <int Dim>
void stretch_uniformly(Solver<Dim>& solver) {
  std::vector<double> flow{0.0};
  while (flow.size() < 100) flow.push_back(flow.back() + 0.4 * solver.axis().bin_mm());
  solver.axis().set_flow(flow);
}

TYPED_TEST(Effects, DivisionEvensOutSpacingAlongTheRootOnly) {
  constexpr int dim = TypeParam::value;
  SolverOptions options;
  options.step_h = 1e-3;
  Solver<dim> running(options);
  DivisionEffect<dim> division(running, {.l0_mm = 1.0}, 1);  // nothing is long enough to divide
  std::array<int, dim> counts;
  counts.fill(4);
  counts[0] = 40;
  test::fill<dim>(running.tissue(), test::lattice<dim>(counts, 0.01, this->random));
  auto& cells = running.tissue().cells;
  // in mid-root a layer of cells has slipped towards the tip, 0.002 mm; it has no stress and nothing else moves
  constexpr double slipped = 0.002;
  std::vector<double> layer_x;
  for (Vec<dim>& x : cells.position.values()) {
    layer_x.push_back(x[0]);
    if (std::abs(x[0] + 0.005) < 1e-6) x[0] += slipped;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) cells.clamped[i] = layer_x[i] < -0.17;
  const std::vector<Vec<dim>> before = cells.position.values();
  running.axis().start(running.tissue());
  stretch_uniformly(running);
  running.prepare();
  running.advance_window(5);
  // both sides of a pair share its gap at 25 times the strain rate: 0.05 in a window of 0.005 h. The layer has a gap
  // behind it and an overlap before it, its neighbours have one of them
  double sum = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto id = static_cast<std::size_t>(cells.cell_id[i]);
    const Vec<dim> moved = cells.position[i] - before[id];
    const double from_layer = std::abs(layer_x[id] + 0.005);
    const double expected = from_layer < 0.001 ? -0.05 * slipped : from_layer < 0.011 ? 0.025 * slipped : 0.0;
    EXPECT_LT((moved - expected * Vec<dim>::UnitX()).norm(), 1e-15);
    sum += moved[0];
  }
  EXPECT_NEAR(sum, 0.0, 1e-15 * static_cast<double>(cells.size()));
}

TYPED_TEST(Effects, DivisionEvensOutSpacingOfFreeCellsOnly) {
  constexpr int dim = TypeParam::value;
  SolverOptions options;
  options.step_h = 1e-3;
  Solver<dim> running(options);
  DivisionEffect<dim> division(running, {.l0_mm = 1.0}, 1);
  std::array<int, dim> counts;
  counts.fill(4);
  counts[0] = 40;
  // irregular cells: gaps and overlaps everywhere
  test::fill<dim>(running.tissue(), test::lattice<dim>(counts, 0.01, this->random, 0.2, 0.2));
  auto& cells = running.tissue().cells;
  for (std::size_t i = 0; i < cells.size(); ++i) cells.clamped[i] = cells.position[i][0] < 0.0;
  const std::vector<Vec<dim>> before = cells.position.values();
  running.axis().start(running.tissue());
  running.prepare();
  running.advance_window(5);
  // nothing stretches: nothing is moved
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(cells.position[i], before[static_cast<std::size_t>(cells.cell_id[i])]);
  }
  stretch_uniformly(running);
  running.advance_window(5);
  double most = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Vec<dim> moved = cells.position[i] - before[static_cast<std::size_t>(cells.cell_id[i])];
    if (cells.clamped[i]) {
      EXPECT_EQ(moved, Vec<dim>(Vec<dim>::Zero()));
    }
    EXPECT_LT(moved.template tail<dim - 1>().norm(), 1e-15);
    most = std::max(most, std::abs(moved[0]));
  }
  EXPECT_GT(most, 1e-6);
  EXPECT_LT(most, 0.1 * 0.01);
}

TYPED_TEST(Effects, ProbeAtAPointFollowsTheNearestCellAndItsDescendants) {
  constexpr int dim = TypeParam::value;
  this->fill_root();
  auto& cells = this->tissue.cells;
  const std::size_t target = 37;
  const Vec<dim> point = cells.position[target] + Vec<dim>::Constant(0.002);
  std::array<double, 3> at{};
  std::copy(point.data(), point.data() + dim, at.begin());
  ProbeEffect<dim> probe(this->solver, {"p", at, {}});
  const Vec<dim> centre = cells.position[target];
  cells.stress[target].setConstant(0.4);
  for (const int divisions : {0, 1, 2}) {
    if (divisions > 0) {
      const std::size_t mother = divisions == 1 ? target : cells.size() - 1;
      const LongestAxis<dim> axis = longest_axis<dim>(cells.shape[mother]);
      cells.divide(mother, axis.direction, axis.length_mm, 5000 + 2 * divisions, 5001 + 2 * divisions);
    }
    const ProbeReading reading = probe.read();
    EXPECT_EQ(reading.cells, divisions + 1.0);
    EXPECT_NEAR(reading.volume, std::pow(0.01, dim), 1e-16);
    // the centroid of the descendants is where the cell was
    EXPECT_NEAR(reading.x_mm, centre[0], 1e-14);
    EXPECT_NEAR(reading.y_mm, centre[1], 1e-14);
    EXPECT_NEAR(reading.z_mm, dim == 3 ? centre[dim - 1] : 0.0, 1e-14);
    EXPECT_NEAR(reading.axial_stress_MPa, 0.4, 1e-14);
    EXPECT_NEAR(reading.density_ug_mm3, 1000.0, 1e-9);
  }
  // sorting the store does not lose it
  cells.permute(this->random.permutation(cells.size()));
  EXPECT_NEAR(probe.read().x_mm, centre[0], 1e-14);
}

TYPED_TEST(Effects, ProbeOfABinReadsMeansWeightedByVolume) {
  constexpr int dim = TypeParam::value;
  this->fill_root();
  auto& cells = this->tissue.cells;
  double volume = 0.0, stress = 0.0, radial = 0.0, mass = 0.0, s = 0.0, count = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells.volume[i] = this->random.uniform(0.5, 1.5);
    cells.mass[i] = this->random.uniform(0.5, 1.5);
    cells.stress[i] = this->random.template matrix<Voigt<dim>>();
    const double at = cells.distance_to_tip[i];
    if (!(at >= 0.1 && at < 0.15)) continue;
    count += 1.0;
    volume += cells.volume[i];
    mass += cells.mass[i];
    s += cells.volume[i] * at;
    stress += cells.volume[i] * cells.stress[i][0];
    radial += cells.volume[i] * (dim == 2 ? cells.stress[i][1] : 0.5 * (cells.stress[i][1] + cells.stress[i][2]));
  }
  const std::size_t fields = cells.fields().size();
  ProbeEffect<dim> probe(this->solver, {"bin", {}, std::array{0.1, 0.15}});
  EXPECT_EQ(cells.fields().size(), fields);  // a bin follows no cell: no column
  const ProbeReading reading = probe.read();
  EXPECT_EQ(reading.cells, count);
  EXPECT_GT(count, 0.0);
  EXPECT_NEAR(reading.volume, volume, 1e-12);
  EXPECT_NEAR(reading.axial_stress_MPa, stress / volume, 1e-12);
  EXPECT_NEAR(reading.radial_stress_MPa, radial / volume, 1e-12);
  EXPECT_NEAR(reading.density_ug_mm3, mass / volume, 1e-12);
  EXPECT_NEAR(reading.distance_to_tip_mm, s / volume, 1e-12);
  EXPECT_NEAR(reading.cell_length_mm, 0.01, 1e-12);
}

TYPED_TEST(Effects, ProbeOfAnEmptyBinReadsNoNumbers) {
  constexpr int dim = TypeParam::value;
  this->fill_root();
  ProbeEffect<dim> probe(this->solver, {"bin", {}, std::array{5.0, 6.0}});
  const ProbeReading reading = probe.read();
  EXPECT_EQ(reading.cells, 0.0);
  EXPECT_EQ(reading.volume, 0.0);
  const std::vector<double> values = reading.values();
  EXPECT_TRUE(std::all_of(values.begin() + 2, values.end(), [](double mean) { return std::isnan(mean); }));
}

TYPED_TEST(Effects, ProbeNamesAColumnForEveryNumberOfAReading) {
  ProbeEffect<TypeParam::value> probe(this->solver, {"bin", {}, std::array{0.1, 0.15}});
  EXPECT_EQ(probe.side_table()->columns.size() * sizeof(double), sizeof(ProbeReading));
}

}  // namespace
}  // namespace rootsoil
